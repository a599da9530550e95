#include "OutgoingMessage.h"

#include <algorithm>
#include <functional>
#include <string_view>

#include "DeliveryCheck.h"
#include "RtpsReader.h"

namespace Rabit::FastDds
{

namespace
{

constexpr std::uint8_t LittleEndian = 0x01;
constexpr std::uint8_t Final = 0x02;      // of an ACKNACK: no answer is wanted
constexpr std::uint8_t InlineQos = 0x02;  // of a DATA: as one that disposes has
constexpr std::uint8_t HasData = 0x04;

// Of all but samples: the reader comes first.
EntityId WriterOf(RtpsReader body)
{
    body.Skip(4);
    return body.Entity();
}

bool Asks(RtpsReader body, std::uint8_t flags, FirstRequest &request)
{
    request.Reader = body.Entity();
    request.Writer = body.Entity();
    const std::int64_t base = body.Sequence();
    const std::uint32_t bits = body.Bits();
    return body.IsGood() && (flags & Final) == 0 && base <= 1 && bits == 0;
}

}  // namespace

OutgoingMessage ReadOutgoing(std::span<const std::uint8_t> datagram)
{
    OutgoingMessage message;
    int announcements = 0;
    int requests = 0;
    int others = 0;
    FirstRequest request;
    std::uint64_t digest = 0;
    RtpsReader rest(datagram, true);
    rest.Skip(RtpsHeaderSize);
    while (rest.Left() >= SubmessageHeaderSize)
    {
        const auto head = rest.Bytes(2);
        const std::uint8_t flags = head[1];
        const bool littleEndian = (flags & LittleEndian) != 0;
        const auto lengthBytes = rest.Bytes(2);
        const std::size_t length = RtpsReader(lengthBytes, littleEndian).U16();
        const auto kind = static_cast<SubmessageKind>(head[0]);
        const bool toTheEnd =
            length == 0 && kind != SubmessageKind::Pad && kind != SubmessageKind::InfoTimestamp;
        const auto bytes = rest.Bytes(toTheEnd ? rest.Left() : length);
        RtpsReader body(bytes, littleEndian);
        switch (kind)
        {
            case SubmessageKind::Pad:
            case SubmessageKind::InfoTimestamp:
                break;
            case SubmessageKind::InfoDestination:
                if (bytes.size() >= request.Peer.size())
                {
                    std::copy_n(bytes.begin(), request.Peer.size(), request.Peer.begin());
                }
                break;
            case SubmessageKind::AckNack:
                message.HasSamples = message.HasSamples || !IsBuiltin(WriterOf(body));
                (Asks(body, flags, request) ? requests : others) += 1;
                break;
            case SubmessageKind::Data:
            case SubmessageKind::DataFrag:
            {
                body.Skip(8);  // flags, where the inline QoS is, the reader
                const EntityId writer = body.Entity();
                message.HasSamples = message.HasSamples || !IsBuiltin(writer);
                const bool announces = kind == SubmessageKind::Data && writer == ParticipantWriter &&
                                       (flags & HasData) != 0 && (flags & InlineQos) == 0;
                (announces ? announcements : others) += 1;
                digest = std::hash<std::string_view>()(
                    {reinterpret_cast<const char *>(bytes.data()), bytes.size()});
                break;
            }
            case SubmessageKind::Heartbeat:
            case SubmessageKind::HeartbeatFrag:
            case SubmessageKind::Gap:
            case SubmessageKind::NackFrag:
                message.HasSamples = message.HasSamples || !IsBuiltin(WriterOf(body));
                ++others;
                break;
            default:
                ++others;
                break;
        }
    }
    if (announcements == 1 && requests + others == 0)
    {
        message.Announcement = digest;
    }
    if (requests == 1 && announcements + others == 0)
    {
        message.Request = request;
    }
    return message;
}

}  // namespace Rabit::FastDds
