#pragma once

#include "Frame.h"
#include "NodeCounters.h"
#include "SendQueue.h"

#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <queue>
#include <random>
#include <string>
#include <vector>

namespace Rabit::Radio
{

struct MediumSettings
{
    std::optional<std::int64_t> BitsPerSecond;  // none: unlimited
    std::size_t QueueBytes = 16'000;            // of each node
    std::size_t Overhead = 0;                   // bytes that each frame takes on the air beyond its own
    std::uint64_t Seed = 1;                     // of losses, duplicates and jitter
};

// One direction between two nodes.
struct LinkSettings
{
    double Loss = 0;  // share of the frames, 0 to 1
    Time Delay{0};
    Time Jitter{0};  // up to so much more or less than the delay, evenly
    bool Deaf = false;
    double Duplicate = 0;  // share of the frames heard that come twice
    // Number of frames in a row that are lost, on average (Gilbert's model: a link is good or bad, and
    // changes with each frame). Up to 1 each frame is lost by itself.
    double Burst = 1;
};

// A frame that has come to a node at that time.
struct Arrival
{
    Time At;
    std::size_t To;
    FramePointer What;
};

// A shared half-duplex radio channel. Each node has a bounded queue. One frame at a time is on the air, for
// (bytes + overhead) * 8 / rate, or several if their senders are hidden from each other. The nodes that have
// something to send take turns, a frame each. A multicast
// or broadcast frame is on the air once and reaches all others; a unicast frame is on the air once and
// reaches at most the node with its address. Each receiver then loses the frame or not. If not, the frame
// arrives after the link's delay, in order unless reordering is switched on.
//
// Properties of real radios that are left out: collisions and back-off (turns are perfect), acknowledgements
// and repetitions of unicast frames by the radio, and a lower rate for multicast. Also left out are rates
// that differ between links, interference, and the back-pressure by which a full driver's queue blocks a
// socket. An outage is silence at the receivers: senders do not notice it and go on using the air.
//
// Pure: no clock, thread or socket. The caller gives the times. A time before the last one counts as the last
// one. One thread at a time.
class Medium
{
public:
    // Throws std::invalid_argument on a rate below 1 or above MostBitsPerSecond.
    explicit Medium(const MediumSettings &settings);

    static constexpr std::int64_t MostBitsPerSecond = 10'000'000'000;
    static constexpr double MostBurst = 1e6;

    // Nodes are numbered from 0 in this order. Throws std::invalid_argument if the name or the address
    // exists already.
    std::size_t Add(const std::string &name, const MacAddress &address);
    std::size_t Count() const { return _nodes.size(); }
    const std::string &NameOf(std::size_t node) const { return _nodes.at(node).Name; }
    std::optional<std::size_t> Find(const std::string &name) const;

    // A node gives a frame to its queue.
    void Offer(Time now, std::size_t node, FramePointer frame);
    // Appends all frames that have come to nodes until `now`, in the order of their arrival.
    void Advance(Time now, std::vector<Arrival> &arrived);
    // Returns when Advance has something to do next, if nothing is offered until then.
    std::optional<Time> NextEvent() const;
    // `tap` is called with each frame at the end of its time on the air, heard or not. It must not call the
    // medium.
    void SetTap(std::function<void(Time, const Frame &)> tap) { _tap = std::move(tap); }

    // Changes the rate while the medium runs. A frame on the air goes on at the new rate.
    void SetRate(Time now, std::optional<std::int64_t> bitsPerSecond);
    void SetQueue(std::size_t node, std::size_t bytes) { _nodes.at(node).Queue.SetLimit(bytes); }
    void SetOverhead(std::size_t bytes) { _overhead = bytes; }
    void SetReordering(bool on) { _reordering = on; }
    // Nodes that are hidden from each other do not hear each other, and so may send at the same time. A frame
    // is lost at a receiver that hears another frame while it is on the air, or that sends itself.
    void SetHidden(Time now, std::size_t one, std::size_t other, bool hidden);
    // A frame of which any part is on the air during an outage reaches no node.
    void SetOutage(Time now, bool on);
    // Applies to frames that leave the air after `now`.
    void SetLink(Time now, std::size_t from, std::size_t to, const LinkSettings &settings);
    const LinkSettings &LinkOf(std::size_t from, std::size_t to) const;

    std::optional<std::int64_t> Rate() const { return _rate; }
    bool IsOut() const { return _out; }
    const NodeCounters &CountersOf(std::size_t node) const { return _nodes.at(node).Counters; }
    std::size_t QueuedBytes(std::size_t node) const { return _nodes.at(node).Queue.Bytes(); }
    // Returns how long the first waiting frame has waited.
    Time QueueAge(Time now, std::size_t node) const;
    // Returns the time for which a frame was on the air since the beginning or the last Reset.
    Time Busy(Time now) const;
    Time CountedSince() const { return _countedSince; }
    // Sets all counters to zero. Frames that wait or are on the air stay.
    void Reset(Time now);

private:
    struct Node
    {
        std::string Name;
        SendQueue Queue;
        NodeCounters Counters;
    };

    struct Link
    {
        LinkSettings Settings;
        Time Last{0};  // when the latest frame comes
        bool Hidden = false;
        bool Bad = false;  // in a burst of losses
    };

    struct Later
    {
        bool operator()(const std::pair<std::uint64_t, Arrival> &a,
                        const std::pair<std::uint64_t, Arrival> &b) const
        {
            return a.second.At != b.second.At ? a.second.At > b.second.At : a.first > b.first;
        }
    };

    struct OnAir
    {
        std::size_t From;
        FramePointer What;
        std::size_t Overhead;
        Time Waited;
        Time Since;  // of the last change of rate, or of its beginning
        Time Ends;
        std::int64_t Left;  // bits * 1e9 at Since
        bool Spoiled;
        std::vector<std::size_t> With;  // senders of other frames that were on the air in that time
    };

    Time Run(Time now);
    void BeginNext(Time at);
    void Begin(Time at, std::size_t node);
    bool MaySend(std::size_t node) const;
    bool IsLost(Link &link);
    std::vector<OnAir>::iterator FirstToEnd();
    void Complete(std::vector<OnAir>::iterator frame);
    void Reach(std::size_t from, std::size_t to, const OnAir &sent);
    void Arrive(Link &link, std::size_t to, const OnAir &sent);
    Time EndOf(Time since, std::int64_t left) const;
    double Random();
    Link &LinkAt(std::size_t from, std::size_t to) { return _links.at(from * _nodes.size() + to); }

    std::optional<std::int64_t> _rate;
    std::size_t _queueBytes;
    std::size_t _overhead;
    bool _reordering = false;
    bool _out = false;
    std::mt19937_64 _random;
    std::vector<Node> _nodes;
    std::vector<Link> _links;  // from * nodes + to
    std::map<MacAddress, std::size_t> _byAddress;
    std::function<void(Time, const Frame &)> _tap;
    Time _now{0};
    std::vector<OnAir> _air;
    Time _busySince{0};  // while a frame is on the air
    std::size_t _lastTurn = 0;
    std::priority_queue<std::pair<std::uint64_t, Arrival>, std::vector<std::pair<std::uint64_t, Arrival>>,
                        Later>
        _coming;
    std::uint64_t _sequence = 0;
    Time _busy{0};
    Time _countedSince{0};
};

}  // namespace Rabit::Radio
