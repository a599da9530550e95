#include "rtps/OwnCard.h"

#include <algorithm>
#include <iterator>
#include <optional>

namespace Rabit::Rtps
{

void OwnCard::Announced(std::span<const std::uint8_t> message)
{
    VisitSubmessages(message,
                     [&](const ConstSubmessage &part)
                     {
                         if (part.Kind != SubmessageKind::Data)
                         {
                             return;
                         }
                         const std::uint64_t content = ContentOf(part.Whole);
                         if (_participant.empty() || content != _participantContent)
                         {
                             _header.assign(message.begin(), message.begin() + RtpsHeaderSize);
                             _participant.assign(part.Whole.begin(), part.Whole.end());
                             _participantContent = content;
                             _changed = true;
                         }
                     });
}

void OwnCard::Said(const EndpointSubmessage &said)
{
    Writer &writer = _writers[said.Said.Writer];
    switch (said.Kind)
    {
        case SubmessageKind::Heartbeat:
            writer.Last = said.Said.Last;
            for (std::int64_t number = writer.Base; number < said.Said.First; ++number)
            {
                See(writer, number);
            }
            break;
        case SubmessageKind::Gap:
            for (const std::int64_t number : said.Gone)
            {
                See(writer, number);
            }
            break;
        case SubmessageKind::Data:
            See(writer, said.Said.First);
            Put(said);
            break;
        default:
            break;
    }
}

void OwnCard::See(Writer &writer, std::int64_t number)
{
    if (number >= writer.Base)
    {
        writer.Seen.insert(number);
    }
    while (writer.Seen.erase(writer.Base) > 0)
    {
        ++writer.Base;
    }
}

void OwnCard::Put(const EndpointSubmessage &said)
{
    const EntityId subject = SubjectOf(said.Whole);
    Endpoint &endpoint = _endpoints[{said.Said.Writer, subject}];
    const std::uint64_t content = ContentOf(said.Whole);
    if (said.Said.First < endpoint.Number || (!endpoint.Announcement.empty() && content == endpoint.Content))
    {
        return;
    }
    endpoint = {.First = endpoint.First > 0 ? endpoint.First : said.Said.First,
                .Number = said.Said.First,
                .Content = content,
                .Alive = said.Said.Alive,
                .Announcement = {said.Whole.begin(), said.Whole.end()}};
    _changed = true;
    if (_endpoints.size() > MostEndpoints)
    {
        LeaveOutOldest();
    }
}

void OwnCard::LeaveOutOldest()
{
    auto oldest = _endpoints.end();
    for (auto at = _endpoints.begin(); at != _endpoints.end(); ++at)
    {
        if (!at->second.Alive && (oldest == _endpoints.end() || at->second.Number < oldest->second.Number))
        {
            oldest = at;
        }
    }
    if (oldest != _endpoints.end())
    {
        _endpoints.erase(oldest);
    }
}

OwnCard::Acknowledged OwnCard::Of(EntityId writer) const
{
    Acknowledged result;
    const auto found = _writers.find(writer);
    if (found == _writers.end())
    {
        return result;
    }
    constexpr std::int64_t mostAsked = 256;
    const Writer &known = found->second;
    result.Base = known.Base;
    for (std::int64_t number = known.Base; number <= std::min(known.Last, known.Base + mostAsked - 1);
         ++number)
    {
        if (!known.Seen.contains(number))
        {
            result.Missing.push_back(number);
        }
    }
    return result;
}

bool OwnCard::TakeChanged()
{
    return !_participant.empty() && std::exchange(_changed, false);
}

std::vector<std::uint8_t> OwnCard::Message(std::size_t most) const
{
    std::vector<const Endpoint *> chosen;
    for (const auto &[key, endpoint] : _endpoints)
    {
        chosen.push_back(&endpoint);
    }
    std::stable_sort(chosen.begin(), chosen.end(),
                     [](const Endpoint *a, const Endpoint *b)
                     { return a->Alive != b->Alive ? a->Alive : a->First < b->First; });
    chosen.resize(std::min(chosen.size(), most));
    std::vector<std::uint8_t> message = _header;
    AppendAnnouncement(message, _participant, 1);
    for (const Endpoint *const endpoint : chosen)
    {
        AppendAnnouncement(message, endpoint->Announcement, endpoint->Number);
    }
    return message;
}

std::size_t OwnCard::Endpoints() const
{
    return static_cast<std::size_t>(std::count_if(_endpoints.begin(), _endpoints.end(),
                                                  [](const auto &each) { return each.second.Alive; }));
}

}  // namespace Rabit::Rtps
