#pragma once

#include <chrono>
#include <cstddef>
#include <map>
#include <optional>

#include "guard/RtpsMessage.h"

namespace Rabit::Rtps
{

// Decides when to announce ourselves once more to who announces itself. The vendor answers a newcomer once,
// at the moment at which it is discovered; that answer is lost if the newcomer does not listen yet, or on the
// way, and our next announcement comes a period later. Whoever has heard us sends something to us alone: who
// announces itself again before it does, has not. A pure state machine, not thread-safe.
class AnnouncementReplies
{
public:
    using TimePoint = std::chrono::steady_clock::time_point;

    // One announcement answers all who wait for one.
    static constexpr std::chrono::milliseconds Gap{100};
    // Somebody may have nothing to say to us.
    static constexpr int MostForOne = 8;
    // Who was silent for so long may have forgotten us; but never while it has missed one period at most.
    static constexpr std::chrono::milliseconds ShortestSilence{15000};
    static constexpr std::size_t MostPeers = 1024;

    // The period in which all announce themselves.
    explicit AnnouncementReplies(std::chrono::milliseconds period);

    // A participant has announced itself. Whether to announce ourselves now.
    bool OnAnnouncement(const GuidPrefix &peer, TimePoint now);
    // It has sent something to us alone.
    void OnAddressed(const GuidPrefix &peer);
    void OnGone(const GuidPrefix &peer);

private:
    struct Peer
    {
        TimePoint Announced;
        bool KnowsUs = false;
        int Replies = 0;
    };

    const std::chrono::milliseconds _silence;
    std::map<GuidPrefix, Peer> _peers;
    std::optional<TimePoint> _last;
};

}  // namespace Rabit::Rtps
