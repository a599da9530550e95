#include "OutgoingMessage.h"

#include <algorithm>
#include <functional>
#include <string_view>

#include "common/RtpsReader.h"
#include "common/RtpsWriter.h"
#include "guard/DeliveryCheck.h"
#include "rtps/DiscoverySubmessages.h"

namespace Rabit::FastDds
{

using namespace Rtps;

namespace
{

bool Asks(RtpsReader body, std::uint8_t flags, FirstRequest &request)
{
    request.Reader = body.Entity();
    request.Writer = body.Entity();
    const std::int64_t base = body.Sequence();
    const std::uint32_t bits = body.Bits();
    return body.IsGood() && (flags & FinalFlag) == 0 && base <= 1 && bits == 0;
}

using Part = ConstSubmessage;

// True if the submessage announces a participant as alive.
bool IsAnnouncement(const Part &part)
{
    const auto said = ReadAnnouncement(part.Whole);
    return said && said->Writer == ParticipantWriter && said->Alive;
}

std::uint64_t DigestOf(std::span<const std::uint8_t> bytes)
{
    return std::hash<std::string_view>()({reinterpret_cast<const char *>(bytes.data()), bytes.size()});
}

}  // namespace

OutgoingMessage ReadOutgoing(std::span<const std::uint8_t> datagram)
{
    OutgoingMessage message;
    int announcements = 0;
    int requests = 0;
    int heartbeats = 0;
    int others = 0;
    int samples = 0;
    int destinations = 0;
    GuidPrefix peer{};
    FirstRequest request;
    LoneHeartbeat heartbeat;
    std::uint64_t digest = 0;
    const auto visit = [&](const Part &part)
    {
        RtpsReader body = part.Reader();
        const auto writer = IsDelivery(part.Kind) ? WriterOf(part) : std::nullopt;
        const bool isOfSamples = writer && !IsBuiltin(*writer);
        message.HasSamples = message.HasSamples || isOfSamples;
        switch (part.Kind)
        {
            case SubmessageKind::Pad:
            case SubmessageKind::InfoTimestamp:
                break;
            case SubmessageKind::InfoDestination:
                peer = PrefixOf(part.Body());
                ++destinations;
                break;
            case SubmessageKind::AckNack:
                (Asks(body, part.Flags, request) ? requests : others) += 1;
                break;
            case SubmessageKind::Data:
            case SubmessageKind::DataFrag:
            {
                const bool whole = part.Kind == SubmessageKind::Data;
                const bool announces = whole && IsAnnouncement(part);
                (announces ? announcements : others) += 1;
                samples += whole && isOfSamples ? 1 : 0;
                if (announces)
                {
                    // The digest omits the reader that it is for.
                    digest = DigestOf(part.Body().subspan(std::min(WriterInData, part.Body().size())));
                }
                break;
            }
            case SubmessageKind::Heartbeat:
                body.Skip(sizeof(EntityId));  // the reader
                heartbeat.Writer = body.Entity();
                heartbeat.First = body.Sequence();
                heartbeat.Last = body.Sequence();
                ++heartbeats;
                break;
            default:
                ++others;
                break;
        }
    };
    VisitSubmessages(datagram, visit);
    const int all = announcements + requests + heartbeats + others;
    message.IsOfSamplesToOne = samples > 0 && samples == all && destinations == 1 && peer != GuidPrefix{};
    if (announcements == 1 && all == 1)
    {
        message.Announcement = digest;
    }
    if (requests == 1 && all == 1)
    {
        request.Peer = peer;
        message.Request = request;
    }
    if (heartbeats == 1 && all == 1)
    {
        heartbeat.Peer = peer;
        message.Heartbeat = heartbeat;
    }
    return message;
}

void WriteWithoutDestination(std::span<const std::uint8_t> datagram, std::vector<std::uint8_t> &to)
{
    to.assign(datagram.begin(),
              datagram.begin() + static_cast<std::ptrdiff_t>(std::min(RtpsHeaderSize, datagram.size())));
    VisitSubmessages(datagram,
                     [&to](const Part &part)
                     {
                         if (part.Kind != SubmessageKind::InfoDestination)
                         {
                             to.insert(to.end(), part.Whole.begin(), part.Whole.end());
                         }
                     });
}

void WriteWithoutProperties(std::span<const std::uint8_t> announcement, std::vector<std::uint8_t> &to)
{
    constexpr std::size_t FixedSize = SubmessageHeaderSize + 20;  // up to the inline QoS
    const auto add = [&to](std::span<const std::uint8_t> bytes) { Append(to, bytes); };
    to.clear();
    add(announcement.first(std::min(RtpsHeaderSize, announcement.size())));
    const auto visit = [&](const Part &part)
    {
        if (part.Kind != SubmessageKind::Data || !IsAnnouncement(part))
        {
            add(part.Whole);
            return;
        }
        const auto payload = ReadAnnouncement(part.Whole)->Payload;
        const std::size_t begins = to.size();
        add(part.Whole.first(FixedSize));
        to[begins + 1] = static_cast<std::uint8_t>(to[begins + 1] & ~InlineQosFlag);
        add(payload.first(EncapsulationSize));
        const std::span<const std::uint8_t> parameters = payload.subspan(EncapsulationSize);
        std::size_t copied = 0;
        VisitParameters(payload,
                        [&](const ListParameter &parameter)
                        {
                            if (parameter.Id == Parameters::PropertyList)
                            {
                                add(parameters.subspan(copied, parameter.At - copied));
                                copied = parameter.At + 4 + parameter.Value.size();
                            }
                        });
        add(parameters.subspan(copied));
        // A length of 0 means "to the end of the message", which remains true.
        if (part.Whole[2] != 0 || part.Whole[3] != 0)
        {
            Write(std::span(to).subspan(begins + 2, 2), to.size() - begins - SubmessageHeaderSize,
                  part.LittleEndian);
        }
    };
    VisitSubmessages(announcement, visit);
}

std::vector<std::uint32_t> DiscoveryPortsOf(std::span<const std::uint8_t> announcement)
{
    std::vector<std::uint32_t> ports;
    const auto visit = [&ports](const Part &part)
    {
        const auto said = part.Kind == SubmessageKind::Data ? ReadAnnouncement(part.Whole) : std::nullopt;
        if (!said || said->Writer != ParticipantWriter || !said->Alive)
        {
            return;
        }
        const bool littleEndian = IsLittleEndianList(said->Payload);
        VisitParameters(said->Payload,
                        [&](const ListParameter &parameter)
                        {
                            if (parameter.Id == Parameters::MetatrafficUnicastLocator ||
                                parameter.Id == Parameters::MetatrafficMulticastLocator)
                            {
                                RtpsReader locator(parameter.Value, littleEndian);
                                constexpr std::uint32_t udpV4 = 1;  // RTPS 2.3, 9.3.2
                                if (locator.U32() == udpV4)
                                {
                                    ports.push_back(locator.U32());
                                }
                            }
                        });
    };
    VisitSubmessages(announcement, visit);
    return ports;
}

std::vector<Acknowledgement> ReadAcknowledgements(std::span<const std::uint8_t> datagram)
{
    std::vector<Acknowledgement> found;
    GuidPrefix sender = PrefixOf(datagram.subspan(std::min(PrefixAt, datagram.size())));
    VisitSubmessages(datagram,
                     [&](const Part &part)
                     {
                         if (part.Kind == SubmessageKind::InfoSource)
                         {
                             sender = PrefixOf(part.Body().subspan(std::min(PrefixAt, part.Body().size())));
                         }
                         if (part.Kind != SubmessageKind::AckNack)
                         {
                             return;
                         }
                         RtpsReader body = part.Reader();
                         Acknowledgement said{.Peer = sender};
                         said.Reader = body.Entity();
                         said.Writer = body.Entity();
                         said.Base = body.Sequence();
                         said.Asks = body.Bits() > 0 || (said.Base <= 1 && (part.Flags & FinalFlag) == 0);
                         if (body.IsGood())
                         {
                             found.push_back(said);
                         }
                     });
    return found;
}

}  // namespace Rabit::FastDds
