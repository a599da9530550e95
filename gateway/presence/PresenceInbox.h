#pragma once

#include <rabit/transport/Transport.h>

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <mutex>
#include <string_view>
#include <vector>

#include "gateway.idl.h"
#include "presence/SenderCheck.h"

namespace Rabit
{

// Beats, announcements and events of peers on their way from the transport's threads to the gateway's. What
// is too large is dropped before it is decoded, what makes no sense after that, and what comes faster than
// the gateway takes it in when the inbox is full; all are counted. Thread-safe.
class PresenceInbox
{
public:
    using Duration = std::chrono::nanoseconds;

    // Bytes of a beat as it is on the wire; echoes in it, and nodes that it asks for.
    static constexpr std::size_t LargestBeat = 8 * 1024;
    static constexpr std::size_t MostEchoes = 64;
    // What the inbox holds at most, samples counted as they are on the wire plus the size of an entry. More
    // is no fleet but a fault: 1000 nodes that announce themselves in 4 kB each within one pass of the
    // gateway.
    static constexpr std::size_t LargestContents = 4 * 1024 * 1024;

    struct Heard
    {
        Gateway::Beat Beat;
        Duration Arrival{0};
    };
    struct Contents
    {
        std::vector<Heard> Beats;
        std::vector<Gateway::Announcement> Announcements;
        std::vector<PeerEvent> Events;
    };

    // `senders` must outlive the object.
    explicit PresenceInbox(SenderCheck &senders) : _senders(senders) {}

    // These return whether there is something to take. `participant` is who wrote the sample
    // (SampleInfo::Node): what it says in another node's name is dropped, and counted by `senders`.
    bool AddBeat(SampleBytes bytes, std::string_view participant, Duration arrival);
    bool AddAnnouncement(SampleBytes bytes, std::string_view participant, Duration arrival);
    bool AddEvent(const PeerEvent &event);

    Contents Take();
    // Samples that made no sense, and what found the inbox full.
    std::uint64_t Dropped() const;

private:
    bool HasRoomFor(std::size_t bytes);
    bool Drop();

    SenderCheck &_senders;
    mutable std::mutex _mutex;
    Contents _contents;
    std::size_t _bytes = 0;
    std::uint64_t _dropped = 0;
};

}  // namespace Rabit
