#pragma once

#include <SimRandom.h>
#include <rabit/gateway/links/LinkOptions.h>

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace Rabit::Sim
{

// How one direction between two nodes behaves for a while.
struct Weather
{
    double Loss = 0;       // 0 to 0.6
    double Duplicate = 0;  // 0 to 0.2
    double Straggle = 0;   // part of the datagrams that take up to 90 s
    LinkTime Delay{std::chrono::milliseconds(1)};
    LinkTime Jitter{0};  // the delay varies by up to this much, which reorders
};

// The medium that all nodes share, one frame at a time. Each node has a queue in front of it that drops
// frames that do not fit.
struct Medium
{
    std::int64_t BitsPerSecond = 0;  // 0: no limit
    std::size_t QueueBytes = 0;      // of each node, as on the air
};

// How a node gets its incarnations.
enum class IncarnationMode
{
    Counter,         // a counter in a file
    WallClock,       // no file: the seconds of the wall clock, which steps
    CounterAndClock  // the higher of both, as IncarnationStore does
};

struct ScenarioNode
{
    std::string Name;
    IncarnationMode Incarnations = IncarnationMode::Counter;
    bool NeverThere = false;  // a dead peer: others send to it, it never starts
    std::int64_t DriftPpm = 0;
    LinkTime DriverDelay{0};   // how late, at most, the driver calls Run
    bool RoomIsWrong = false;  // its queues tell a random number for their room
};

struct ScenarioQueue
{
    std::string Name;
    std::size_t Capacity = 10;
    LinkTime ConsumePeriod{std::chrono::milliseconds(1)};  // a message is taken out this often
    double PopEventLoss = 0;  // part of the pop events that the node does not hear
    double LocalFill = 0;     // local producers fill it up at this part of the pops
};

struct ScenarioLink
{
    std::size_t Source = 0;
    std::size_t Destination = 0;
    std::size_t Queue = 0;
    LinkOptions Options;
};

enum class FaultKind
{
    Weather,    // A -> B changes its weather
    CutStart,   // A -> B carries nothing
    CutEnd,     // A -> B carries again
    Crash,      // node A ends at once
    Start,      // node A starts (again)
    ClockStep,  // node A's wall clock jumps by Amount seconds
    Stall,      // node A's queues are not emptied for Amount nanoseconds
    Forget,     // node A forgets node B, if nothing waits there for B
    Rate        // the medium carries Amount bits a second from now on
};

struct Fault
{
    LinkTime At{0};
    FaultKind Kind = FaultKind::Weather;
    std::size_t A = 0;
    std::size_t B = 0;
    Sim::Weather Weather{};
    std::int64_t Amount = 0;
    bool LoseStorage = false;  // Start: the counter file is gone
};

// Messages enqueued on one link at one moment.
struct Burst
{
    LinkTime At{0};
    std::size_t Link = 0;
    int Count = 1;
};

// Everything about a run that is decided in advance. The same seed always gives the same scenario.
struct Scenario
{
    std::vector<ScenarioNode> Nodes;
    std::vector<ScenarioQueue> Queues;  // each node has all of them
    std::vector<ScenarioLink> Links;
    std::vector<Fault> Faults;
    std::vector<Burst> Bursts;
    Sim::Medium Medium;
    std::vector<Weather> Start;  // from node i to node j at index i * Nodes.size() + j
    LinkTime CalmAt{0};          // the faults stop here
    LinkSettings Settings;
    double MalformedPart = 0;  // part of the datagrams that are followed by a malformed copy
    // True if a life of a node may begin with a lower incarnation than the one before: its storage may be
    // lost, or it has none and the wall clock steps. Only then may a peer remember a higher incarnation of
    // the node.
    bool IncarnationsMayFall = false;
    bool WaitForStragglers = false;  // go on until the last datagram has come

    explicit Scenario(std::uint64_t seed);
};

}  // namespace Rabit::Sim
