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

// What happens to the datagrams of one direction. Decided for each datagram when it is sent, over a limited
// medium when it has passed that: those in flight when the faults change keep their fate.
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
    // A reliable writer asks after this time, while something is not acknowledged, what its readers miss;
    // then at distances that double up to the longest, and begin anew with each write and acknowledgement.
    std::chrono::nanoseconds HeartbeatPeriod = std::chrono::milliseconds(20);
    std::chrono::nanoseconds LongestHeartbeatPeriod = std::chrono::milliseconds(1000);
    // A reader answers that, and a writer repairs, after this time.
    std::chrono::nanoseconds ResponseDelay = std::chrono::milliseconds(1);
    // From the arrival of an announcement or a card to its being read.
    std::chrono::nanoseconds DiscoveryDelay = std::chrono::milliseconds(5);
};

// A half-duplex medium that nodes share, a radio: one datagram at a time is on the air, and the nodes that
// have something to send take turns. What a node sends meanwhile waits in a queue of its own, first in first
// out; it does so as well when its process has ended, and nobody who sends is told of it. A datagram takes
// its size as TransportCounters counts it; one by multicast once, one by unicast once for each receiver.
struct SimulatedMedium
{
    // Of all nodes together; 0: unlimited, nothing takes time or waits. What is on the air when it changes
    // keeps the rate at which it began.
    std::uint64_t BytesPerSecond = 0;
    // What a node's queue holds at most. A datagram for which there is no room is dropped.
    std::uint64_t QueueBytes = 16'000;
};

// What a medium did so far. Bytes are as on the air.
struct SimulatedAir
{
    std::uint64_t Carried = 0;  // datagrams
    std::uint64_t CarriedBytes = 0;
    std::uint64_t Dropped = 0;  // datagrams for which the queue of their node had no room
    std::uint64_t DroppedBytes = 0;
    std::chrono::nanoseconds LongestWait{0};  // of a datagram in the queue
};

// What a node's sessions have sent so far, those that are gone included; on the air or dropped before it.
struct SimulatedSent
{
    std::uint64_t Datagrams = 0;
    std::uint64_t Bytes = 0;
    std::uint64_t DiscoveryBytes = 0;  // of those: of participants and endpoints
    std::uint64_t WaitingBytes = 0;    // of those: in the queue before its medium now
};

// What the network did so far.
struct SimulatedTraffic
{
    std::uint64_t Sent = 0;  // datagrams, one for each receiver
    std::uint64_t Lost = 0;  // of those sent: lost, cut off or dropped by a queue
    std::uint64_t Duplicated = 0;
    std::uint64_t Events = 0;  // steps of the simulation
};

// A network in the memory of one process, for SimulatedTransport sessions, under its own time.
//
// What takes the air is counted as with the real backends: samples with several readers, announcements and
// endpoints go by multicast where the sender's settings allow it (TransportSettings::Multicast).
//
// Time stands still until AdvanceTo moves it. With one seed, the same calls in the same order give the same
// deliveries in the same order. Nothing happens in between: AdvanceTo runs all handlers, on the calling
// thread, each at its simulated time; things due at one time happen in the order in which they were caused.
//
// It behaves like our backends on DDS, not like an ideal network: participants find each other by
// announcements and cards (transport/rtps), and lose each other by leases, the two sides of a match come
// about separately, a reliable writer repairs what its keep-last history still has as long as the match
// holds, a best-effort reader drops what comes late or twice, a volatile reader loses what is written while
// it is not matched, and a reader that was lost and found again gets a transient-local history once more (as
// with Cyclone DDS; Fast DDS does not).
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

    // Makes a medium for the nodes that fit that pattern, or changes the one made for it. Of several that a
    // node fits, the one made last is its own. What it sends takes the air of that medium alone, wherever the
    // receiver is; what has been sent does not move to another one. At first all is unlimited.
    void SetMedium(const std::string &nodes, const SimulatedMedium &medium);
    // Of the medium of that pattern; zeros if none was made.
    SimulatedAir Air(const std::string &nodes) const;
    SimulatedSent Sent(const std::string &node) const;

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

    // When a best-effort sample of that topic last came from a node to readers of another one that are
    // matched with its writer now; one that was overtaken does not count. Nothing if none came, or if no such
    // match is left.
    std::optional<std::chrono::nanoseconds> LastArrival(const std::string &from, const std::string &to,
                                                        const std::string &topic) const;

private:
    friend class SimulatedTransport;
    const std::shared_ptr<Simulated::NetworkCore> _core;
};

}  // namespace Rabit
