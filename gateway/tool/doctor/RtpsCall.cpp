#include "doctor/RtpsCall.h"

#include <algorithm>

#include "common/ParticipantIdentity.h"
#include "guard/RtpsMessage.h"
#include "guard/RtpsReader.h"

namespace Rabit::Tool::Doctor
{
namespace
{

using namespace Rabit::Rtps;

// OMG DDSI-RTPS 2.3, 9.3.1.3 and 9.6.2.2.2.
constexpr EntityId ParticipantWriter = 0x000100c2;
constexpr EntityId ParticipantEntity = 0x000001c1;
constexpr std::uint8_t FlagInlineQos = 2;
constexpr std::uint8_t FlagData = 4;
constexpr std::uint16_t ParameterListLittleEndian = 0x0300;  // the bytes 00 03, read as a big-endian number

enum Parameter : std::uint16_t
{
    Sentinel = 0x01,
    LeaseDuration = 0x02,
    ProtocolVersion = 0x15,
    VendorId = 0x16,
    UserData = 0x2c,
    DefaultUnicastLocator = 0x31,
    MetatrafficUnicastLocator = 0x32,
    ParticipantGuid = 0x50,
    BuiltinEndpoints = 0x58,
    EntityName = 0x62,
    IdentityToken = 0x1001  // OMG DDS Security 1.1, 7.4.1.3
};

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

// Reads the parameters of an announcement, which follow its encapsulation.
void ReadParameters(RtpsReader &reader, bool littleEndian, HeardCall &heard)
{
    while (reader.IsGood() && reader.Left() >= 4)
    {
        const std::uint16_t parameter = reader.U16();
        const std::uint16_t length = reader.U16();
        if (parameter == Sentinel)
        {
            return;
        }
        RtpsReader value(reader.Bytes(length), littleEndian);
        heard.HasKeys = heard.HasKeys || parameter == IdentityToken;
        if (parameter == EntityName || parameter == UserData)
        {
            const auto bytes = value.Bytes(value.U32());
            heard.Name = parameter == EntityName ? Printable(bytes) : heard.Name;
            heard.IsNode = heard.IsNode || (parameter == UserData && ParseUserData(bytes).has_value());
        }
    }
}

void ReadData(const Submessage &data, HeardCall &heard)
{
    RtpsReader reader(data.Body(), data.LittleEndian);
    reader.Skip(2);
    const std::uint16_t toQos = reader.U16();
    static_cast<void>(reader.Entity());
    if (reader.Entity() != ParticipantWriter || (data.Flags & FlagData) == 0 || toQos < 16)
    {
        return;
    }
    reader.Skip(toQos - 8u);
    while ((data.Flags & FlagInlineQos) != 0 && reader.IsGood())
    {
        const std::uint16_t parameter = reader.U16();
        const std::uint16_t length = reader.U16();
        if (parameter == Sentinel)
        {
            break;
        }
        reader.Skip(length);
    }
    RtpsReader kind(reader.Bytes(4), false);
    const std::uint16_t encapsulation = kind.U16();
    if (!reader.IsGood() || (encapsulation != 2 && encapsulation != 3))
    {
        return;
    }
    heard.Announces = true;
    const bool littleEndian = encapsulation == 3;
    RtpsReader parameters(reader.Rest(), littleEndian);
    ReadParameters(parameters, littleEndian, heard);
}

void Put16(std::vector<std::uint8_t> &out, std::uint16_t number)
{
    out.push_back(static_cast<std::uint8_t>(number));
    out.push_back(static_cast<std::uint8_t>(number >> 8));
}

void Put32(std::vector<std::uint8_t> &out, std::uint32_t number)
{
    Put16(out, static_cast<std::uint16_t>(number));
    Put16(out, static_cast<std::uint16_t>(number >> 16));
}

void PutBytes(std::vector<std::uint8_t> &out, std::span<const std::uint8_t> bytes)
{
    for (const std::uint8_t byte : bytes)
    {
        out.push_back(byte);
    }
}

void PutEntity(std::vector<std::uint8_t> &out, EntityId entity)
{
    for (const int shift : {24, 16, 8, 0})
    {
        out.push_back(static_cast<std::uint8_t>(entity >> shift));
    }
}

void PutParameter(std::vector<std::uint8_t> &out, Parameter parameter, const std::vector<std::uint8_t> &value)
{
    Put16(out, parameter);
    Put16(out, static_cast<std::uint16_t>(value.size()));
    PutBytes(out, value);
}

std::vector<std::uint8_t> GuidOf(const ParticipantId &sender)
{
    std::vector<std::uint8_t> guid;
    PutBytes(guid, sender);
    PutEntity(guid, ParticipantEntity);
    return guid;
}

std::vector<std::uint8_t> LocatorOf(std::array<std::uint8_t, 4> address, std::uint16_t port)
{
    constexpr std::uint32_t udpOverIpv4 = 1;
    std::vector<std::uint8_t> locator;
    Put32(locator, udpOverIpv4);
    Put32(locator, port);
    locator.resize(locator.size() + 12);
    PutBytes(locator, address);
    return locator;
}

}  // namespace

std::optional<HeardCall> HeardIn(std::span<const std::uint8_t> datagram)
{
    constexpr std::size_t header = 20;
    if (!HasRtpsHeader(datagram))
    {
        return std::nullopt;
    }
    HeardCall heard;
    heard.Sender = SenderOf(datagram);
    // TakeSubmessage needs bytes that may be changed.
    std::vector<std::uint8_t> copy(datagram.begin(), datagram.end());
    std::span<std::uint8_t> rest = std::span(copy).subspan(header);
    while (!rest.empty())
    {
        const std::optional<Submessage> submessage = TakeSubmessage(rest);
        if (!submessage)
        {
            break;
        }
        if (submessage->Kind == SubmessageKind::Data)
        {
            ReadData(*submessage, heard);
        }
    }
    return heard;
}

std::vector<std::uint8_t> MakeCall(const ParticipantId &sender, std::array<std::uint8_t, 4> address,
                                   std::uint16_t port)
{
    // The participant announces itself, and takes the announcements of others.
    constexpr std::uint32_t announcer = 1;
    constexpr std::uint32_t detector = 2;
    constexpr std::uint16_t toQos = 16;
    std::vector<std::uint8_t> parameters;
    PutParameter(parameters, ProtocolVersion, {2, 3, 0, 0});
    PutParameter(parameters, VendorId, {0, 0, 0, 0});
    PutParameter(parameters, ParticipantGuid, GuidOf(sender));
    PutParameter(parameters, MetatrafficUnicastLocator, LocatorOf(address, port));
    PutParameter(parameters, DefaultUnicastLocator, LocatorOf(address, port));
    PutParameter(parameters, LeaseDuration, {1, 0, 0, 0, 0, 0, 0, 0});
    std::vector<std::uint8_t> endpoints;
    Put32(endpoints, announcer | detector);
    PutParameter(parameters, BuiltinEndpoints, endpoints);
    PutParameter(parameters, Sentinel, {});
    std::vector<std::uint8_t> body;
    Put16(body, 0);
    Put16(body, toQos);
    PutEntity(body, 0);
    PutEntity(body, ParticipantWriter);
    Put32(body, 0);
    Put32(body, 1);
    Put16(body, ParameterListLittleEndian);
    Put16(body, 0);
    PutBytes(body, parameters);
    std::vector<std::uint8_t> message;
    PutBytes(message, std::to_array<std::uint8_t>({'R', 'T', 'P', 'S', 2, 3, 0, 0}));
    PutBytes(message, sender);
    AppendSubmessageHeader(message, SubmessageKind::Data, body.size(), FlagData);
    PutBytes(message, body);
    return message;
}

}  // namespace Rabit::Tool::Doctor
