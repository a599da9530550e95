#pragma once

#include <rabit/base/Backoff.h>

#include <algorithm>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <map>
#include <tuple>

#include "OutgoingMessage.h"

namespace Rabit::FastDds
{

// Decides when an unchanged heartbeat goes out again. The vendor repeats it every 20 ms (in discovery every
// second) until every reader has acknowledged all samples: for an unreachable reader until its lease ends.
// All other readers answer each time. Here the intervals of repetitions double, and start anew when a reader
// acknowledges or requests something. A heartbeat with other numbers, or to another destination, goes at
// once. Held heartbeats are not lost, since the vendor repeats them. A pure state machine, not thread-safe.
class HeartbeatPace
{
public:
    using TimePoint = std::chrono::steady_clock::time_point;

    static constexpr Backoff::Settings OfTopics{std::chrono::milliseconds(20),
                                                std::chrono::milliseconds(1000)};
    static constexpr Backoff::Settings OfDiscovery{std::chrono::milliseconds(1000),
                                                   std::chrono::milliseconds(4000)};
    static constexpr std::size_t Most = 4096;  // number of heartbeats, and of readers

    // `destination`: number of an address, chosen by the caller.
    bool MayGo(std::uint64_t destination, const LoneHeartbeat &heartbeat, TimePoint now);
    // A peer has acknowledged samples of a writer of ours, or requested something.
    void OnAcknowledgement(const Acknowledgement &acknowledgement, TimePoint now);
    std::size_t Size() const { return std::max(_sent.size(), _acknowledged.size()); }

private:
    struct Sent
    {
        std::int64_t First = 0;
        std::int64_t Last = 0;
        Backoff Gap;
        TimePoint Next;  // when it may go again
    };
    using Place = std::tuple<Rtps::EntityId, std::uint64_t, Rtps::GuidPrefix>;    // the writer first
    using Reader = std::tuple<Rtps::EntityId, Rtps::GuidPrefix, Rtps::EntityId>;  // the writer first

    std::map<Place, Sent> _sent;
    std::map<Reader, std::int64_t> _acknowledged;  // all samples before this one
};

}  // namespace Rabit::FastDds
