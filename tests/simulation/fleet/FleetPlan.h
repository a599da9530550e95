#pragma once

#include <SimRandom.h>
#include <rabit/gateway/GatewayConfig.h>
#include <rabit/simulated/SimulatedNetwork.h>

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace Rabit::Sim
{

using Time = std::chrono::nanoseconds;

// A track on the air, bytes, with all headers.
constexpr std::uint64_t TrackOnAir = 104;

// The part of all notes that may be as large as FleetPlan::LargestNote.
constexpr double LargeNotes = 0.02;

// One machine with a node on it.
struct MachinePlan
{
    std::string Name;
    bool NeverThere = false;    // others send to it, it never starts
    bool KeepsCounter = false;  // has a state_dir
    std::int64_t DriftPpm = 0;  // of its monotonic clock
    int QueueCapacity = 10;
    Time ConsumePeriod{std::chrono::milliseconds(1)};  // a note is taken out of the queue this often
    Time TrackPeriod{std::chrono::milliseconds(100)};  // a track is posted this often
    std::vector<SendRule> Send;                        // one for each other node, in the order of the nodes
};

enum class FaultKind
{
    Weather,    // A -> B gets other faults
    CutStart,   // A -> B carries nothing
    CutEnd,     // A -> B carries again
    Crash,      // A ends at once
    Leave,      // A ends in an orderly way
    Start,      // A starts (again)
    ClockStep,  // A's wall clock jumps by Amount seconds
    Stall,      // A takes nothing out of its queue for Amount nanoseconds
    Rate,       // the thin medium carries Amount bytes a second from now on
    Outage,     // nobody hears anybody
    OutageEnd,
};

struct FaultEvent
{
    Time At{0};
    FaultKind Kind = FaultKind::Weather;
    std::size_t A = 0;
    std::size_t B = 0;
    SimulatedFaults Weather{};
    std::int64_t Amount = 0;
    bool LoseStorage = false;  // Start: the counter file is gone
};

// Notes sent at one moment.
struct Burst
{
    static constexpr std::size_t ToAll = static_cast<std::size_t>(-1);  // to `*/Notes`

    Time At{0};
    std::size_t Source = 0;
    std::size_t Destination = 0;
    int Count = 1;
};

// A new Mode.
struct ModePost
{
    Time At{0};
    std::size_t Node = 0;
};

// A shared medium that carries the fleet's traffic, and the promises that must hold on it.
struct ThinPlan
{
    std::uint64_t BytesPerSecond = 0;     // when nothing is wrong
    std::optional<std::uint64_t> Budget;  // of each node
    Time UpWithin{0};                     // all are UP so long after a start, or after an outage
    Time PoseAge{0};                      // no track is older when it comes, besides the pause between two
    Time SlowPoseAge{0};                  // the same while the medium carries less than that
};

// Everything about a run of the fleet that is decided in advance. The same seed always gives the same plan.
struct FleetPlan
{
    std::vector<MachinePlan> Machines;
    std::vector<SimulatedFaults> Start;  // from i to j at index i * Machines.size() + j
    std::vector<FaultEvent> Faults;
    std::vector<Burst> Bursts;
    std::int64_t LargestNote = 60'000;  // bytes, to all its receivers together
    std::vector<ModePost> Modes;
    Time CalmAt{0};  // the faults stop here
    // Whether a life may begin with a lower incarnation than the one before: storage is lost or there is
    // none, and the wall clocks step.
    bool IncarnationsMayFall = false;
    // The lease of all nodes: the default, or one longer than most cuts.
    std::chrono::milliseconds Lease{};
    std::optional<ThinPlan> Thin;
    bool HasKeys = false;

    // Seeds from this one on are over a thin medium, and those from the other one on are of fleets with keys
    // over networks as of the first ones.
    static constexpr std::uint64_t FirstThinSeed = 1'000'000;
    static constexpr std::uint64_t FirstKeyedSeed = 2'000'000;

    explicit FleetPlan(std::uint64_t seed);

private:
    void DrawWide(SimRandom &random);
    void DrawThin(SimRandom &random);
};

}  // namespace Rabit::Sim
