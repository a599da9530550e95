#pragma once

#include <array>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace Rabit
{

// Measures the delay of the other nodes' link frames against the quickest of each. This node reports it to
// them as the input of their CapacityEstimate.
//
// Both times are of monotonic clocks, the sender's and ours. Only changes of their difference are used, and a
// step of a wall clock has no effect. A clock that runs faster than ours by up to 100 ppm makes a datagram
// seem 15 ms late at most: only the last two and a half minutes count. A delay above Longest is ignored: the
// sender's clock stood still, with its computer.
//
// A node is reported to while its datagrams are later than Late, and for Echo after that. So it learns that
// nothing is late any more. Each report is about a newer datagram than the one before.
//
// Bounded: MostPeers nodes, the one that was silent for longest is forgotten. No allocation for a node that
// is known. Pure; `arrivedAt` and `now` never go back by more than threads do.
class DelayMeter
{
public:
    using Duration = std::chrono::nanoseconds;

    static constexpr Duration Late = std::chrono::milliseconds(20);
    static constexpr Duration Echo = std::chrono::seconds(3);
    static constexpr Duration Longest = std::chrono::seconds(10);
    static constexpr Duration Bucket = std::chrono::seconds(30);
    static constexpr std::size_t MostPeers = 1024;

    // A report to a node.
    struct Report
    {
        const std::string *Node = nullptr;
        Duration Delay{0};
        Duration Held{0};  // since that datagram arrived
    };

    // A datagram of that incarnation of a node came, with the sending time `sentAt` by the node's monotonic
    // clock. An impossible time is dropped. Returns true if there is something to report to the node.
    bool Heard(std::string_view node, std::uint64_t incarnation, Duration sentAt, Duration arrivedAt);

    // Takes the reports to send now, for at most `most` nodes, those that have waited for longest first. The
    // names are valid until the next call.
    const std::vector<Report> &Take(std::size_t most, Duration now);

private:
    static constexpr std::size_t Buckets = 5;
    static constexpr Duration None = Duration::max();
    // Decades. A later time could overflow a subtraction.
    static constexpr Duration LatestTime{std::int64_t{1} << 61};

    struct Peer
    {
        std::uint64_t Incarnation = 0;
        std::array<Duration, Buckets> Least{};  // arrival less sending, the newest first
        Duration Quickest = None;               // the least of these
        Duration BucketEnd{0};
        Duration SentAt{0};  // of the newest datagram
        Duration ArrivedAt{0};
        Duration Delay{0};
        Duration TellUntil = Duration::min();
        Duration ToldAt = Duration::min();
        bool Told = true;

        void Begin(std::uint64_t incarnation, Duration offset, Duration now);
        void Turn(Duration now);
    };

    Peer &PeerOf(std::string_view node);

    using Peers = std::map<std::string, Peer, std::less<>>;

    Peers _peers;
    Peers::iterator _last = _peers.end();  // the node that was heard last
    std::vector<Report> _reports;
};

}  // namespace Rabit
