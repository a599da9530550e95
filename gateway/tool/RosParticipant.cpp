#include "RosParticipant.h"

#include <rabit/idl/CdrReader.h>

#include <array>
#include <stdexcept>
#include <string_view>
#include <typeindex>
#include <typeinfo>

namespace Rabit::Tool
{
namespace
{

constexpr std::size_t EncapsulationSize = 4;
// Zeros at the end of a sample, up to a multiple of 4 bytes.
constexpr std::size_t MostPadding = 3;
constexpr std::size_t PrefixSize = 12;
// Of a GUID in the samples: since ROS 2 Iron, and in Humble.
constexpr std::array<std::size_t, 2> GidSizes{16, 24};
// Of a namespace, and of a name.
constexpr std::size_t LongestName = 256;
// Two empty strings with their gaps, and the lengths of two lists.
constexpr std::size_t LeastNode = 24;

std::string HexOf(std::span<const std::uint8_t> bytes)
{
    constexpr std::string_view Digits = "0123456789abcdef";
    std::string text;
    for (const std::uint8_t byte : bytes)
    {
        text += Digits[byte >> 4];
        text += Digits[byte & 15];
    }
    return text;
}

bool SkipGids(Idl::CdrReader &reader, std::size_t gidSize)
{
    std::size_t count = 0;
    return reader.GetLength(0, gidSize, count) && reader.Skip(1, count * gidSize);
}

class ParticipantType final : public MessageType
{
public:
    const std::string &Name() const override { return _name; }
    const std::string &IdlText() const override { return _text; }
    std::unique_ptr<RabitMessage> Create() const override { return std::make_unique<RosParticipant>(); }
    std::shared_ptr<RabitMessage> CreateShared() const override { return std::make_shared<RosParticipant>(); }
    std::type_index CppType() const override { return typeid(RosParticipant); }
    bool IsTypeOf(const RabitMessage &message) const override
    {
        return dynamic_cast<const RosParticipant *>(&message) != nullptr;
    }
    std::size_t SerializedSize(const RabitMessage & /*message*/) const override { return 0; }
    std::size_t Serialize(const RabitMessage & /*message*/, std::span<std::uint8_t> /*buffer*/) const override
    {
        return 0;
    }
    bool Deserialize(std::span<const std::uint8_t> bytes, RabitMessage &message) const override
    {
        auto *const participant = dynamic_cast<RosParticipant *>(&message);
        if (participant == nullptr)
        {
            throw std::invalid_argument("the message is no RosParticipant");
        }
        return participant->Read(bytes);
    }
    bool HasKey() const override { return false; }
    bool KeyHashOf(std::span<const std::uint8_t> /*bytes*/,
                   std::array<std::uint8_t, 16> & /*hash*/) const override
    {
        return false;
    }

private:
    const std::string _name = RosParticipant::TypeName;
    const std::string _text =
        "module rmw_dds_common { module msg { module dds_ {\n"
        "@nested @final struct Gid_ { octet data[16]; };\n"
        "@nested @final struct NodeEntitiesInfo_ { string<256> node_namespace; string<256> node_name; "
        "sequence<Gid_> reader_gid_seq; sequence<Gid_> writer_gid_seq; };\n"
        "@final struct ParticipantEntitiesInfo_ { Gid_ gid; sequence<NodeEntitiesInfo_> "
        "node_entities_info_seq; };\n"
        "}; }; };\n";
};

}  // namespace

const Rabit::MessageType &RosParticipant::IdlType()
{
    static const ParticipantType type{};
    return type;
}

bool RosParticipant::Read(std::span<const std::uint8_t> sample)
{
    Prefix.clear();
    Nodes.clear();
    const bool isCdr = sample.size() >= EncapsulationSize && sample[0] == 0 && sample[1] <= 1;
    if (!isCdr || sample.size() > LargestSample)
    {
        return false;
    }
    // Only one of the sizes ends at the end of the sample: GUIDs of 24 bytes end with 8 zeros, which would be
    // an empty list of nodes.
    for (const std::size_t gidSize : GidSizes)
    {
        if (ReadBody(sample.subspan(EncapsulationSize), sample[1] == 1, gidSize))
        {
            return true;
        }
        Prefix.clear();
        Nodes.clear();
    }
    return false;
}

bool RosParticipant::ReadBody(std::span<const std::uint8_t> body, bool littleEndian, std::size_t gidSize)
{
    Idl::CdrReader reader(body, littleEndian);
    std::span<const std::uint8_t> gid;
    std::size_t count = 0;
    if (!reader.GetBytes(gidSize, gid) || !reader.GetLength(0, LeastNode, count))
    {
        return false;
    }
    for (std::size_t i = 0; i < count; ++i)
    {
        std::string_view space;
        std::string_view name;
        if (!reader.GetString(LongestName, space) || !reader.GetString(LongestName, name) ||
            !SkipGids(reader, gidSize) || !SkipGids(reader, gidSize))
        {
            return false;
        }
        if (Nodes.size() < MostNodes)
        {
            Nodes.push_back(std::string(space) + (space.ends_with('/') ? "" : "/") + std::string(name));
        }
    }
    Prefix = HexOf(gid.first(PrefixSize));
    return reader.Left() <= MostPadding;
}

std::unique_ptr<RabitMessage> RosParticipant::Clone() const
{
    return std::make_unique<RosParticipant>(*this);
}

bool RosParticipant::CopyMessage(RabitMessage *msg)
{
    const auto *const other = dynamic_cast<const RosParticipant *>(msg);
    if (other == nullptr || !RabitMessage::CopyMessage(msg))
    {
        return false;
    }
    Prefix = other->Prefix;
    Nodes = other->Nodes;
    return true;
}

void RosParticipant::Clear()
{
    RabitMessage::Clear();
    Prefix.clear();
    Nodes.clear();
}

}  // namespace Rabit::Tool
