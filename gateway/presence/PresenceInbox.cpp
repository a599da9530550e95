#include "presence/PresenceInbox.h"

#include <rabit/gateway/NamePattern.h>

#include <algorithm>
#include <utility>

#include "presence/Whereabouts.h"
#include "wire/Announcements.h"
#include "wire/BeatFormat.h"
#include "wire/BeatNews.h"
#include "wire/GatewayTopics.h"

namespace Rabit
{
namespace
{

// Clock readings on which arithmetic cannot overflow: three centuries either way are more than any clock
// shows.
bool IsPlausible(std::int64_t nanoseconds)
{
    constexpr std::int64_t most = std::int64_t{1} << 61;
    return nanoseconds >= 0 && nanoseconds < most;
}

bool IsPlausible(const Gateway::Wanted &wanted)
{
    return wanted.states.size() <= (Announcements::MostOffers + 7) / 8;
}

bool IsPlausible(const Gateway::AnnouncementPart &part)
{
    if (Whereabouts::IsIn(part))
    {
        return part.first == 0 && !part.bytes.empty() && part.bytes.size() <= Whereabouts::Size;
    }
    return part.of <= Announcements::LargestEncoded && !part.bytes.empty() &&
           part.first + part.bytes.size() <= part.of;
}

template <typename Entries>
bool AreFew(const Entries &entries)
{
    return entries.size() <= PresenceInbox::MostEntries;
}

bool IsPlausible(const Gateway::Beat &beat)
{
    const auto plausible = [](const auto &entry) { return IsPlausible(entry); };
    const Gateway::BeatNews &news = NewsOf(beat);
    return IsPlausible(beat.source_ns) &&
           news.first_state + news.states.size() <= Announcements::MostOffers && AreFew(news.wants) &&
           AreFew(news.echoes) && AreFew(news.delays) && news.parts.size() <= 1 &&
           std::all_of(news.wants.begin(), news.wants.end(), plausible) &&
           std::all_of(news.parts.begin(), news.parts.end(), plausible);
}

}  // namespace

// The sender is the node that DDS reports, never a name in the payload; samples of programs that are no nodes
// are dropped.
bool PresenceInbox::AddBeat(SampleBytes bytes, const SampleInfo &info, Duration arrival)
{
    const bool isOurs = BeatFormat::IsPresent(bytes);
    HeardBeat heard;
    const bool good = IsNodeName(info.Node) &&
                      (!isOurs || (bytes.size() <= LargestBeat && IsPlausible(info.SourceTime) &&
                                   GatewayTopics::TypeOf<Gateway::Beat>().Deserialize(bytes, heard.Beat) &&
                                   IsPlausible(heard.Beat)));
    const std::lock_guard lock(_mutex);
    if (!good || !HasRoomFor((isOurs ? bytes.size() : 0) + sizeof(HeardBeat)))
    {
        return Drop();
    }
    if (!isOurs)
    {
        _contents.OtherFormats.emplace_back(info.Node);
        return true;
    }
    heard.Node = info.Node;
    heard.Incarnation = info.Incarnation;
    heard.Utc = info.SourceTime;
    heard.Sequence = info.Sequence;
    heard.Arrival = arrival;
    _contents.Beats.push_back(std::move(heard));
    return true;
}

bool PresenceInbox::AddEvent(const PeerEvent &event)
{
    const std::lock_guard lock(_mutex);
    if (!IsNodeName(event.Node) || !HasRoomFor(event.Node.size() + sizeof(PeerEvent)))
    {
        return Drop();
    }
    _contents.Events.push_back(event);
    return true;
}

bool PresenceInbox::HasRoomFor(std::size_t bytes)
{
    if (bytes > LargestContents - _bytes)
    {
        return false;
    }
    _bytes += bytes;
    _any.store(true, std::memory_order_release);
    return true;
}

bool PresenceInbox::Drop()
{
    ++_dropped;
    return false;
}

PresenceInbox::Contents PresenceInbox::Take()
{
    const std::lock_guard lock(_mutex);
    _any.store(false, std::memory_order_relaxed);
    _bytes = 0;
    return std::exchange(_contents, {});
}

std::uint64_t PresenceInbox::Dropped() const
{
    const std::lock_guard lock(_mutex);
    return _dropped;
}

}  // namespace Rabit
