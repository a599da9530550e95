#include "doctor/RtpsCall.h"

#include <algorithm>
#include <string_view>

#include "Table.h"
#include "common/ParticipantIdentity.h"
#include "common/RtpsReader.h"
#include "common/RtpsWriter.h"
#include "envelope/Outer.h"
#include "guard/RtpsMessage.h"

namespace Rabit::Tool::Doctor
{
namespace
{

using namespace Rabit::Rtps;

std::string Printable(std::span<const std::uint8_t> bytes)
{
    constexpr std::size_t longest = 64;
    std::string text;
    for (const std::uint8_t byte : bytes.first(std::min(bytes.size(), longest)))
    {
        if (byte == 0)
        {
            break;
        }
        text += byte >= ' ' && byte <= '~' ? static_cast<char>(byte) : '?';
    }
    return text;
}

constexpr std::uint32_t UdpOverIpv4 = 1;

// Reads the parameters of an announcement, which follow its encapsulation.
void ReadParameters(RtpsReader list, bool littleEndian, HeardCall &heard)
{
    while (const auto parameter = TakeParameter(list))
    {
        if (parameter->Id == Parameters::MetatrafficUnicastLocator && heard.Port == 0)
        {
            RtpsReader locator(parameter->Value, littleEndian);
            const bool isUdp = locator.U32() == UdpOverIpv4;
            const std::uint32_t port = locator.U32();
            heard.Port =
                isUdp && locator.IsGood() && port <= 65535 ? static_cast<std::uint16_t>(port) : heard.Port;
        }
        const bool isName = parameter->Id == Parameters::EntityName;
        const bool isUserData = parameter->Id == Parameters::UserData;
        if (isName || isUserData)
        {
            RtpsReader value(parameter->Value, littleEndian);
            const auto bytes = value.Bytes(value.U32());
            heard.Name = isName ? Printable(bytes) : heard.Name;
            heard.IsNode = heard.IsNode || (isUserData && ParseUserData(bytes).has_value());
            heard.IsRos = heard.IsRos || (isUserData && Printable(bytes).starts_with("enclave="));
        }
    }
}

void ReadData(const ConstSubmessage &data, HeardCall &heard)
{
    RtpsReader reader = data.Reader();
    reader.Skip(2);
    const std::uint16_t toQos = reader.U16();
    static_cast<void>(reader.Entity());
    if (reader.Entity() != ParticipantWriter || toQos < 16)
    {
        return;
    }
    reader.Skip(toQos - 8u);
    bool leaves = false;
    if ((data.Flags & InlineQosFlag) != 0)
    {
        constexpr std::uint8_t disposedOrUnregistered = 3;
        while (const auto parameter = TakeParameter(reader))
        {
            leaves = leaves || (parameter->Id == Parameters::StatusInfo && parameter->Value.size() == 4 &&
                                (parameter->Value[3] & disposedOrUnregistered) != 0);
        }
    }
    if (leaves || (data.Flags & DataFlag) == 0)
    {
        return;
    }
    const std::uint32_t encapsulation = RtpsReader(reader.Bytes(EncapsulationSize), false).U16();
    if (!reader.IsGood() || (encapsulation != 2 && encapsulation != 3))
    {
        return;
    }
    heard.Announces = true;
    const bool littleEndian = encapsulation == 3;
    ReadParameters(RtpsReader(reader.Rest(), littleEndian), littleEndian, heard);
}

std::vector<std::uint8_t> LocatorOf(const HostAddress &address, std::uint16_t port)
{
    std::vector<std::uint8_t> locator;
    Append(locator, UdpOverIpv4, 4);
    Append(locator, port, 4);
    locator.resize(locator.size() + 12);
    Append(locator, address);
    return locator;
}

}  // namespace

std::optional<HeardCall> HeardIn(std::span<const std::uint8_t> datagram)
{
    if (!HasRtpsHeader(datagram))
    {
        return std::nullopt;
    }
    HeardCall heard;
    heard.Sender = SenderOf(datagram);
    VisitSubmessages(datagram,
                     [&heard](const ConstSubmessage &submessage)
                     {
                         if (submessage.Kind == SubmessageKind::Data)
                         {
                             ReadData(submessage, heard);
                         }
                     });
    return heard;
}

std::string LabelOf(const HeardCall &heard)
{
    if (!heard.IsRos && !heard.Name.empty())
    {
        return heard.Name;
    }
    std::string prefix;
    for (const std::uint8_t byte : heard.Sender)
    {
        constexpr std::string_view Digits = "0123456789abcdef";
        prefix += Digits[byte >> 4];
        prefix += Digits[byte & 15];
    }
    return heard.IsRos ? LabelOfRos(prefix, {}) : "a program without a name (" + prefix + ")";
}

std::string LabelOfRos(const std::string &prefix, const std::vector<std::string> &nodes)
{
    return "a program of ROS 2 (" + (nodes.empty() ? "" : NamesText(nodes) + ", ") + prefix + ")";
}

std::vector<std::uint8_t> MakeCall(const ParticipantId &sender, std::array<std::uint8_t, 4> address,
                                   std::uint16_t port)
{
    // The participant announces itself, and takes the announcements of others.
    constexpr std::uint32_t announcer = 1;
    constexpr std::uint32_t detector = 2;
    constexpr std::uint16_t toQos = 16;
    std::vector<std::uint8_t> guid(sender.begin(), sender.end());
    AppendEntity(guid, ParticipantEntity);
    std::vector<std::uint8_t> endpoints;
    Append(endpoints, announcer | detector, 4);
    std::vector<std::uint8_t> body;
    Append(body, 0, 2);
    Append(body, toQos, 2);
    AppendEntity(body, 0);
    AppendEntity(body, ParticipantWriter);
    AppendSequence(body, 1);
    Append(body, std::to_array<std::uint8_t>({0, 3, 0, 0}));  // a little-endian list
    AppendParameter(body, Parameters::ProtocolVersion, std::to_array<std::uint8_t>({2, 3, 0, 0}));
    AppendParameter(body, Parameters::VendorId, std::array<std::uint8_t, 4>{});
    AppendParameter(body, Parameters::ParticipantGuid, guid);
    AppendParameter(body, Parameters::MetatrafficUnicastLocator, LocatorOf(address, port));
    AppendParameter(body, Parameters::DefaultUnicastLocator, LocatorOf(address, port));
    AppendParameter(body, Parameters::LeaseDuration, std::to_array<std::uint8_t>({1, 0, 0, 0, 0, 0, 0, 0}));
    AppendParameter(body, Parameters::BuiltinEndpointSet, endpoints);
    AppendParameter(body, Parameters::Sentinel, {});
    std::vector<std::uint8_t> message{'R', 'T', 'P', 'S', 2, 3, 0, 0};
    Append(message, sender);
    AppendSubmessageHeader(message, SubmessageKind::Data, body.size(), DataFlag);
    Append(message, body);
    return message;
}

std::optional<std::uint32_t> SealedTagIn(std::span<const std::uint8_t> datagram)
{
    Envelope::Outer outer;
    const bool isSealed = Envelope::ReadOuter(datagram, outer) == Envelope::OuterFault::None;
    return isSealed && outer.Epoch != Envelope::EpochOfCalls ? std::optional(outer.Tag) : std::nullopt;
}

std::vector<std::uint8_t> MakeSealedCall()
{
    const Envelope::Outer outer{.Epoch = Envelope::EpochOfCalls};
    std::vector<std::uint8_t> datagram(Envelope::OuterOverhead(outer.Kind));
    Envelope::WriteOuter(outer, datagram);
    return datagram;
}

}  // namespace Rabit::Tool::Doctor
