#pragma once

#include <chrono>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>

namespace Rabit
{

namespace Simulated
{
class NetworkCore;
}

// What happens to the datagrams of one direction. Decided for each datagram when it is sent: those in flight
// when the faults change keep their fate.
struct SimulatedFaults
{
    // Probability, 0 to 1, that a datagram is lost. A sample larger than TransportSettings::MaxDatagram
    // travels in several, and arrives when the last of them has.
    double Loss = 0.0;
    // Probability that a datagram arrives twice, each copy with its own delay.
    double Duplicate = 0.0;
    // A datagram takes Delay plus a uniformly drawn part of Jitter; a Jitter longer than the pause between
    // two datagrams reorders them.
    std::chrono::nanoseconds Delay = std::chrono::microseconds(200);
    std::chrono::nanoseconds Jitter = std::chrono::nanoseconds(0);
    // Probability that a datagram takes a uniformly drawn part of StraggleDelay longer.
    double Straggle = 0.0;
    std::chrono::nanoseconds StraggleDelay = std::chrono::seconds(1);
    // Nothing passes. A partition is two of these, one for each direction.
    bool Cut = false;
};

// The times of the simulated protocol; the defaults are those of our Fast DDS backend.
struct SimulatedTimings
{
    // A reliable writer asks this often, while something is not acknowledged, what its readers miss.
    std::chrono::nanoseconds HeartbeatPeriod = std::chrono::milliseconds(20);
    // A reader answers that, and a writer repairs, after this time.
    std::chrono::nanoseconds ResponseDelay = std::chrono::milliseconds(1);
    // From the arrival of an announcement to the peer being known.
    std::chrono::nanoseconds DiscoveryDelay = std::chrono::milliseconds(5);
    // Endpoints that a peer has not confirmed are told again this often.
    std::chrono::nanoseconds DiscoveryRepair = std::chrono::milliseconds(100);
};

// What the network did so far.
struct SimulatedTraffic
{
    std::uint64_t Sent = 0;  // datagrams
    std::uint64_t Lost = 0;  // of those sent: lost or cut off
    std::uint64_t Duplicated = 0;
    std::uint64_t Events = 0;  // steps of the simulation
};

// A network in the memory of one process, for SimulatedTransport sessions, under its own time.
//
// Time stands still until AdvanceTo moves it. With one seed, the same calls in the same order give the same
// deliveries in the same order. Nothing happens in between: AdvanceTo runs all handlers, on the calling
// thread, each at its simulated time; things due at one time happen in the order in which they were caused.
//
// It behaves like DDS with RTPS underneath, not like an ideal network: participants find each other by
// announcements and lose each other by leases, the two sides of a match come about separately, a reliable
// writer repairs what its keep-last history still has as long as the match holds, a best-effort reader drops
// what comes late or twice, a volatile reader loses what is written while it is not matched, and a reader
// that was lost and found again gets a transient-local history once more (as with Cyclone DDS; Fast DDS does
// not).
//
// Thread-safe; deterministic only if used by one thread at a time. Sessions keep the network alive.
class SimulatedNetwork
{
public:
    explicit SimulatedNetwork(std::uint64_t seed, const SimulatedTimings &timings = {});
    ~SimulatedNetwork();
    SimulatedNetwork(const SimulatedNetwork &) = delete;
    SimulatedNetwork &operator=(const SimulatedNetwork &) = delete;

    // Sets the faults from nodes to nodes; both are names, or patterns with `*` and `?`. Of several that fit
    // a pair, the one set last holds; setting a pair of patterns again replaces it and makes it the last. At
    // first, and after ClearFaults, every direction has the default SimulatedFaults.
    void SetFaults(const std::string &from, const std::string &to, const SimulatedFaults &faults);
    void ClearFaults();

    // The simulated time; 0 at the start.
    std::chrono::nanoseconds Now() const;
    // When the next thing will happen by itself, so that a driver can jump there. Nothing if there are no
    // sessions.
    std::optional<std::chrono::nanoseconds> NextEvent() const;
    // Makes everything happen that is due until `time`, then sets Now() to it. Does nothing if that is in the
    // past. Not from inside a handler; one thread at a time, others wait.
    void AdvanceTo(std::chrono::nanoseconds time);

    // All sessions of that node vanish without a word, as by SIGKILL: their peers hear of it by their leases,
    // their own handlers are not called any more, and their writes fail. A new session may be opened under
    // the name at once. The dead session's objects are destroyed by their owner as usual.
    void CrashNode(const std::string &node);

    SimulatedTraffic Traffic() const;

private:
    friend class SimulatedTransport;
    const std::shared_ptr<Simulated::NetworkCore> _core;
};

}  // namespace Rabit
