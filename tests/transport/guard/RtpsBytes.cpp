#include "guard/RtpsBytes.h"

#include <cstring>

#include "guard/DeliveryCheck.h"

namespace RtpsBytes
{

using Rabit::Rtps::ParticipantEntity;
using Rabit::Rtps::ParticipantWriter;
using Rabit::Rtps::PublicationsWriter;

namespace
{

constexpr std::uint8_t HasData = 5;

}  // namespace

Bytes Join(std::initializer_list<Bytes> parts)
{
    Bytes all;
    for (const auto &part : parts)
    {
        all.insert(all.end(), part.begin(), part.end());
    }
    return all;
}

Bytes U16(std::uint16_t value)
{
    return {static_cast<std::uint8_t>(value), static_cast<std::uint8_t>(value >> 8)};
}

Bytes U32(std::uint32_t value)
{
    return Join({U16(static_cast<std::uint16_t>(value)), U16(static_cast<std::uint16_t>(value >> 16))});
}

Bytes Entity(EntityId entity)
{
    return {static_cast<std::uint8_t>(entity >> 24), static_cast<std::uint8_t>(entity >> 16),
            static_cast<std::uint8_t>(entity >> 8), static_cast<std::uint8_t>(entity)};
}

Bytes Sequence(std::int64_t number)
{
    return Join({U32(static_cast<std::uint32_t>(number >> 32)), U32(static_cast<std::uint32_t>(number))});
}

Bytes Bits(std::uint32_t count)
{
    return Join({U32(count), Bytes(4 * ((count + 31) / 32))});
}

Bytes Guid(const GuidPrefix &prefix, EntityId entity)
{
    return Join({Bytes(prefix.begin(), prefix.end()), Entity(entity)});
}

Bytes Header(const GuidPrefix &sender)
{
    return Join({{'R', 'T', 'P', 'S', 2, 3, 1, 15}, Bytes(sender.begin(), sender.end())});
}

Bytes Submessage(std::uint8_t kind, const Bytes &body, std::uint8_t flags)
{
    return Join({{kind, flags}, U16(static_cast<std::uint16_t>(body.size())), body});
}

Bytes Source(const GuidPrefix &sender)
{
    return Submessage(InfoSource, Join({Bytes(4), {2, 3, 1, 15}, Bytes(sender.begin(), sender.end())}));
}

Bytes Message(std::uint8_t kind, const Bytes &body, std::uint8_t flags)
{
    return Join({Header(), Submessage(kind, body, flags)});
}

Bytes Ids(EntityId reader, EntityId writer)
{
    return Join({Entity(reader), Entity(writer)});
}

Bytes DataBody(std::int64_t sequence, const Bytes &rest, EntityId writer, EntityId reader)
{
    return Join({{0, 0, 16, 0}, Ids(reader, writer), Sequence(sequence), rest});
}

Bytes FragmentBody(std::uint32_t first, std::uint16_t count, std::uint16_t size, std::uint32_t whole,
                   std::size_t bytes, EntityId writer)
{
    return Join({{0, 0, 28, 0},
                 Ids(0, writer),
                 Sequence(1),
                 U32(first),
                 U16(count),
                 U16(size),
                 U32(whole),
                 Bytes(bytes)});
}

Bytes HeartbeatBody(std::int64_t first, std::int64_t last, std::uint32_t count, EntityId writer)
{
    return Join({Ids(0, writer), Sequence(first), Sequence(last), U32(count)});
}

Bytes GapBody(std::int64_t start, std::int64_t base, std::uint32_t bits, EntityId writer)
{
    return Join({Ids(0, writer), Sequence(start), Sequence(base), Bits(bits)});
}

Bytes AckNackBody(std::int64_t base, std::uint32_t bits, std::uint32_t count, EntityId writer)
{
    return Join({Ids(UserReader, writer), Sequence(base), Bits(bits), U32(count)});
}

Bytes NackFragBody(std::int64_t sequence, std::uint32_t base, std::uint32_t bits, std::uint32_t count)
{
    return Join({Ids(UserReader), Sequence(sequence), U32(base), Bits(bits), U32(count)});
}

Bytes Parameter(std::uint16_t id, const Bytes &value)
{
    return Join({U16(id), U16(static_cast<std::uint16_t>(value.size())), value});
}

Bytes Text(const char *text)
{
    const std::size_t size = std::strlen(text) + 1;
    Bytes bytes = Join({U32(static_cast<std::uint32_t>(size)), Bytes(text, text + size)});
    bytes.resize((bytes.size() + 3) / 4 * 4);
    return bytes;
}

Bytes List(std::initializer_list<Bytes> parameters)
{
    return Join({{0, 3, 0, 0}, Join(parameters), {1, 0, 0, 0}});
}

Bytes ParticipantData(const GuidPrefix &of, std::uint32_t port)
{
    return List({Parameter(0x0015, {2, 3, 0, 0}), Parameter(0x0016, {1, 15, 0, 0}),
                 Parameter(0x0050, Guid(of, ParticipantEntity)), Parameter(0x0002, Join({U32(3), U32(0)})),
                 Parameter(0x0032, Join({U32(1), U32(port), Bytes(12), {127, 0, 0, 1}})),
                 Parameter(0x0062, Text("uav1"))});
}

Bytes WriterData(EntityId writer, const GuidPrefix &of)
{
    return List({Parameter(0x005a, Guid(of, writer)), Parameter(0x0005, Text("Pose")),
                 Parameter(0x0007, Text("Uav::Pose")),
                 Parameter(0x0029, Join({U32(2), Text(""), Text("uav1")}))});
}

Bytes ParticipantMessage(const GuidPrefix &sender, std::uint32_t port)
{
    return Join({Header(sender),
                 Submessage(Data, DataBody(1, ParticipantData(sender, port), ParticipantWriter), HasData)});
}

Bytes WriterMessage(EntityId writer, std::int64_t sequence, const GuidPrefix &sender)
{
    return Join(
        {Header(sender),
         Submessage(Data, DataBody(sequence, WriterData(writer, sender), PublicationsWriter), HasData)});
}

}  // namespace RtpsBytes
