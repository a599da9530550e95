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

// How late the link frames of the other nodes come, against the quickest of each: what this node tells them,
// so that they learn how much the air carries for them (CapacityEstimate).
//
// Both times are of monotonic clocks, the sender's and ours: what they say is never compared but for how it
// changes, and a step of a wall clock is not seen. A clock that runs faster than ours by up to 100 ppm makes
// a datagram seem 15 ms late at most: only the last two and a half minutes count. A delay above Longest is
// none: the sender's clock stood still, with its computer.
//
// There is something to tell of a node while its datagrams are later than Late, and for Echo after that, so
// that it hears that all is well again. Each report is about a newer datagram than the one before.
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

    // What is to be told to a node.
    struct Report
    {
        const std::string *Node = nullptr;
        Duration Delay{0};
        Duration Held{0};  // since that datagram arrived
    };

    // A datagram of that life of a node came, which it says that it sent when its monotonic clock showed
    // `sentAt`. A time that no clock shows is dropped. Returns whether there is something to tell of the
    // node.
    bool Heard(std::string_view node, std::uint64_t incarnation, Duration sentAt, Duration arrivedAt);

    // What there is to tell now, of at most so many nodes, those first that have waited for longest. It
    // counts as told. The names are valid until the next call.
    const std::vector<Report> &Take(std::size_t most, Duration now);

private:
    static constexpr std::size_t Buckets = 5;
    static constexpr Duration None = Duration::max();
    // Decades. What is beyond it could not be subtracted.
    static constexpr Duration LatestTime{std::int64_t{1} << 61};

    struct Peer
    {
        std::uint64_t Incarnation = 0;
        std::array<Duration, Buckets> Least{};  // arrival less sending, the newest first
        Duration Quickest = None;               // of these
        Duration BucketEnd{0};
        Duration SentAt{0};  // of the newest
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
    Peers::iterator _last = _peers.end();  // that was heard
    std::vector<Report> _reports;
};

}  // namespace Rabit
