#pragma once

#include <algorithm>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <map>
#include <tuple>

#include "OutgoingMessage.h"

namespace Rabit::FastDds
{

// Decides when a heartbeat that says nothing new goes out again. The vendor repeats it, every 20 ms (that of
// discovery every second), as long as a reader has not acknowledged all: for a reader that is out of reach
// for the rest of its lease, and all who did acknowledge answer each time. Here repetitions follow each other
// at doubling distances, and begin anew when a reader acknowledges or asks for something. A heartbeat with
// other numbers, or to somebody else, goes at once. Since the vendor goes on, what is held is not lost. A
// pure state machine, not thread-safe.
class HeartbeatPace
{
public:
    using TimePoint = std::chrono::steady_clock::time_point;

    struct Gaps
    {
        std::chrono::milliseconds First;
        std::chrono::milliseconds Longest;
    };
    static constexpr Gaps OfTopics{std::chrono::milliseconds(20), std::chrono::milliseconds(1000)};
    static constexpr Gaps OfDiscovery{std::chrono::milliseconds(1000), std::chrono::milliseconds(4000)};
    static constexpr std::size_t Most = 4096;  // heartbeats, and readers

    // `destination` numbers the places to send to.
    bool MayGo(std::uint64_t destination, const LoneHeartbeat &heartbeat, TimePoint now);
    // Somebody has acknowledged to a writer of ours, or asked for something.
    void OnAcknowledgement(const Acknowledgement &acknowledgement, TimePoint now);
    std::size_t Size() const { return std::max(_sent.size(), _acknowledged.size()); }

private:
    struct Sent
    {
        std::int64_t First = 0;
        std::int64_t Last = 0;
        TimePoint Next;  // time that it may go again
        std::chrono::milliseconds Gap{};
    };
    using Place = std::tuple<Rtps::EntityId, std::uint64_t, Rtps::GuidPrefix>;    // the writer first
    using Reader = std::tuple<Rtps::EntityId, Rtps::GuidPrefix, Rtps::EntityId>;  // the writer first

    static Gaps GapsOf(Rtps::EntityId writer);

    std::map<Place, Sent> _sent;
    std::map<Reader, std::int64_t> _acknowledged;  // all before
};

}  // namespace Rabit::FastDds
