// Nodes with clocks of their own that send beats to each other over a network with delays, and the
// recordings that they make. They use the gateway's clock filter (PeerClock), and the recorder's format.
// Time is true time, in nanoseconds since the beginning.
#pragma once

#include <rabit/mcap/McapWriter.h>

#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <queue>
#include <random>
#include <string>
#include <vector>

#include "MemoryFile.h"
#include "clocks/PeerClock.h"
#include "recording/merge/Lives.h"

class SyntheticFleet
{
public:
    using Time = std::int64_t;

    struct Standstill
    {
        Time At = 0;
        Time For = 0;
    };
    struct Spec
    {
        std::string Name;
        Time Begin = 0;
        Time End = 0;
        Time WallAhead = 0;  // of its log clock against true time, at time 0
        double Rate = 0;     // its clock gains that part of time
        std::uint64_t Incarnation = 1;
        bool IsRecorded = true;
        Time SplitEvery = 0;  // 0: one file
        std::optional<Standstill> Stands;
    };
    // Returns the delay of a message that is sent at `at`; empty: it is lost. The nodes are given by index.
    using Network =
        std::function<std::optional<Time>(std::size_t from, std::size_t to, Time at, std::mt19937 &random)>;

    SyntheticFleet(std::vector<Spec> specs, Network network, unsigned seed = 1);

    // Returns the log clock of a node at a true time.
    Time LogAt(std::size_t node, Time at) const;
    // Opens the files <name>_<n>.mcap.
    Rabit::Merge::OpenFile Opener() const;
    std::vector<std::string> Paths() const;

    // Each message of `Pose` holds the true time at which it was posted.
    static Rabit::Mcap::Bytes PoseOf(Time posted);
    static Time PostedOf(Rabit::Mcap::ByteView data);

    std::map<std::string, std::shared_ptr<MemoryFile>> Files;  // may be changed before they are read

private:
    struct Event
    {
        Time At = 0;
        std::uint64_t Order = 0;
        std::function<void()> Do;
        bool operator<(const Event &other) const
        {
            return std::pair(At, Order) > std::pair(other.At, other.Order);
        }
    };
    struct Heard  // by one node of another one
    {
        Rabit::PeerClock Clock;
        bool HasBeat = false;
        Time BeatSource = 0;  // of the last beat, by the sender's clock
        Time Arrival = 0;     // by the own clock
        Time LastPose = -1;
    };
    struct Node
    {
        Spec Is;
        std::map<std::size_t, Heard> Peers;
        std::shared_ptr<MemoryFile> File;
        std::unique_ptr<Rabit::Mcap::McapWriter> Writer;
        unsigned FileNumber = 0;
        Time FileBegan = 0;
        std::map<std::string, std::uint16_t> Channels;
        std::map<std::string, std::pair<Time, Rabit::Mcap::Bytes>> LastOfStates;  // publish time
    };

    Time MonotonicAt(std::size_t node, Time at) const;
    Time ToLog(std::size_t node, Time monotonic) const;
    // Returns when the node does what is due at `at`: then, or when its clock goes on after a standstill.
    Time Awake(std::size_t node, Time at) const;
    bool Lives(std::size_t node, Time at) const;
    void Schedule(Time at, std::function<void()> action);
    void Repeat(std::size_t node, Time at, Time period, const std::function<void(Time)> &action);
    void Beat(std::size_t from, Time at);
    void TakeBeat(std::size_t to, std::size_t from, Time source, std::optional<std::pair<Time, Time>> echo,
                  Time at);
    void Post(std::size_t from, Time at);
    void Report(std::size_t node, Time at);
    void Record(std::size_t node, Time at, const std::string &topic, const std::string &kind,
                const std::string &origin, Time publishLog, const Rabit::Mcap::Bytes &data);
    void Split(std::size_t node, Time at);

    std::vector<Node> _nodes;
    Network _network;
    std::mt19937 _random;
    std::priority_queue<Event> _events;
    std::uint64_t _order = 0;
};
