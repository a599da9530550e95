#include "Introductions.h"

#include "OutgoingMessage.h"
#include "common/RtpsReader.h"
#include "common/RtpsWriter.h"
#include "guard/RtpsMessage.h"
#include "rtps/DiscoverySubmessages.h"

namespace Rabit::FastDds
{

using namespace Rtps;

namespace
{

// OMG DDS Security 1.1, 7.4: the writer and the reader of protected announcements.
constexpr std::uint32_t ProtectedAnnouncements = 3u << 26;

void ClearFlags(std::span<std::uint8_t> payload)
{
    const bool littleEndian = IsLittleEndianList(payload);
    const auto clear = [&](const ListParameter &parameter)
    {
        if (parameter.Id == Parameters::BuiltinEndpointSet && parameter.Value.size() == sizeof(std::uint32_t))
        {
            const std::uint32_t flags = RtpsReader(parameter.Value, littleEndian).U32();
            Write(payload.subspan(EncapsulationSize + parameter.At + SubmessageHeaderSize, sizeof(flags)),
                  flags & ~ProtectedAnnouncements, littleEndian);
        }
    };
    VisitParameters(payload, clear);
}

}  // namespace

Introductions::Message Introductions::Read(std::span<std::uint8_t> datagram)
{
    auto message = Message::Other;
    const auto visit = [&](const SubmessageOf<std::uint8_t> &part)
    {
        const auto said = part.Kind == SubmessageKind::Data ? ReadAnnouncement(part.Whole) : std::nullopt;
        if (said && said->Writer == ParticipantWriter)
        {
            message = said->Alive ? Message::Announcement : Message::Goodbye;
            if (said->Alive)
            {
                ClearFlags(said->Payload);
            }
        }
    };
    VisitSubmessages(datagram, visit);
    if (message != Message::Announcement)
    {
        return message;
    }
    if (!ReadOutgoing(datagram).Announcement || datagram.size() > LargestAnnouncement)
    {
        return Message::Other;
    }
    const std::lock_guard lock(_mutex);
    _announcements.Put(SenderOf(datagram), {datagram.begin(), datagram.end()});
    return message;
}

bool Introductions::Has(const GuidPrefix &sender) const
{
    const std::lock_guard lock(_mutex);
    return _announcements.Find(sender) != nullptr;
}

std::vector<std::uint8_t> Introductions::Take(const GuidPrefix &sender)
{
    const std::lock_guard lock(_mutex);
    const auto *const found = _announcements.Find(sender);
    auto taken = found == nullptr ? std::vector<std::uint8_t>() : *found;
    _announcements.Erase(sender);
    return taken;
}

}  // namespace Rabit::FastDds
