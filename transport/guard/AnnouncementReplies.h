#pragma once

#include <chrono>
#include <cstddef>
#include <map>
#include <optional>

#include "guard/RtpsMessage.h"

namespace Rabit::Rtps
{

// Decides when to announce this participant again to a peer that announces itself. The vendor answers a
// newcomer once, when it discovers it. That answer is lost if the newcomer does not listen yet, or on the
// way, and the next announcement comes a period later. A peer that has heard us sends a datagram to us alone.
// If it announces itself again before that, it has not heard us. A pure state machine, not thread-safe.
class AnnouncementReplies
{
public:
    using TimePoint = std::chrono::steady_clock::time_point;

    // One announcement answers all peers that wait for one.
    static constexpr std::chrono::milliseconds Gap{100};
    // A peer may have nothing to send to us.
    static constexpr int MostForOne = 8;
    // A peer that was silent for this long may have forgotten us. Never shorter than two and a half periods,
    // so that one missed announcement does not count.
    static constexpr std::chrono::milliseconds ShortestSilence{15000};
    static constexpr std::size_t MostPeers = 1024;

    // `period`: announcement period of all participants.
    explicit AnnouncementReplies(std::chrono::milliseconds period);

    // A participant has announced itself. Returns true if this participant should be announced now.
    bool OnAnnouncement(const GuidPrefix &peer, TimePoint now);
    // The peer has sent a datagram to us alone.
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
