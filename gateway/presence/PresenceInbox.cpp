#include "presence/PresenceInbox.h"

#include <algorithm>
#include <utility>

#include "names/NamePattern.h"
#include "wire/Announcements.h"
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

bool IsPlausible(const Gateway::Beat &beat)
{
    return IsNodeName(beat.node) && IsPlausible(beat.monotonic_ns) && IsPlausible(beat.source_ns) &&
           IsPlausible(beat.utc_ns) && beat.wants.size() <= PresenceInbox::MostEchoes &&
           std::all_of(beat.wants.begin(), beat.wants.end(),
                       [](const std::string &node) { return IsNodeName(node); }) &&
           beat.echoes.size() <= PresenceInbox::MostEchoes &&
           std::all_of(beat.echoes.begin(), beat.echoes.end(),
                       [](const Gateway::BeatEcho &echo) {
                           return IsNodeName(echo.node) && IsPlausible(echo.monotonic_ns) &&
                                  IsPlausible(echo.held_ns);
                       });
}

}  // namespace

bool PresenceInbox::AddBeat(SampleBytes bytes, std::string_view participant, Duration arrival)
{
    Heard heard;
    heard.Arrival = arrival;
    const bool good = bytes.size() <= LargestBeat &&
                      GatewayTopics::TypeOf<Gateway::Beat>().Deserialize(bytes, heard.Beat) &&
                      IsPlausible(heard.Beat);
    if (good && !_senders.MaySpeakFor(participant, heard.Beat.node, arrival))
    {
        return false;
    }
    const std::lock_guard lock(_mutex);
    if (!good || !HasRoomFor(bytes.size() + sizeof(Heard)))
    {
        return Drop();
    }
    _contents.Beats.push_back(std::move(heard));
    return true;
}

bool PresenceInbox::AddAnnouncement(SampleBytes bytes, std::string_view participant, Duration arrival)
{
    Gateway::Announcement announcement;
    const bool good = bytes.size() <= Announcements::LargestEncoded &&
                      GatewayTopics::TypeOf<Gateway::Announcement>().Deserialize(bytes, announcement) &&
                      Announcements::IsPlausible(announcement);
    if (good && !_senders.MaySpeakFor(participant, announcement.node, arrival))
    {
        return false;
    }
    const std::lock_guard lock(_mutex);
    if (!good || !HasRoomFor(bytes.size() + sizeof(Gateway::Announcement)))
    {
        return Drop();
    }
    _contents.Announcements.push_back(std::move(announcement));
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
    _bytes = 0;
    return std::exchange(_contents, {});
}

std::uint64_t PresenceInbox::Dropped() const
{
    const std::lock_guard lock(_mutex);
    return _dropped;
}

}  // namespace Rabit
