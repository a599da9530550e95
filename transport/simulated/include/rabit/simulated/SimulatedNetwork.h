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

// Faults of the datagrams of one direction. Each datagram's fate is decided when it is sent, over a limited
// medium when it has passed that. Datagrams in flight when the faults change keep their fate.
struct SimulatedFaults
{
    // Probability, 0 to 1, that a datagram is lost. A sample larger than TransportSettings::MaxDatagram
    // travels in several, and arrives when the last of them has.
    double Loss = 0.0;
    // Losses come in bursts of so many datagrams on average (Gilbert's model); 1 or less: each by itself.
    double Burst = 1.0;
    // Probability that a datagram arrives twice, each copy with its own delay.
    double Duplicate = 0.0;
    // A datagram takes Delay plus a uniformly drawn part of Jitter; a Jitter longer than the pause between
    // two datagrams reorders them.
    std::chrono::nanoseconds Delay = std::chrono::microseconds(200);
    std::chrono::nanoseconds Jitter = std::chrono::nanoseconds(0);
    // Probability that a datagram takes a uniformly drawn part of StraggleDelay longer.
    double Straggle = 0.0;
    std::chrono::nanoseconds StraggleDelay = std::chrono::seconds(1);
    // Nothing passes. A partition needs two of these, one for each direction.
    bool Cut = false;
};

// The times of the simulated protocol; the defaults are those of our Fast DDS backend.
struct SimulatedTimings
{
    // While samples are unacknowledged, a reliable writer sends a heartbeat after this time. The interval
    // then doubles up to the longest, and starts anew with each write and acknowledgement.
    std::chrono::nanoseconds HeartbeatPeriod = std::chrono::milliseconds(20);
    std::chrono::nanoseconds LongestHeartbeatPeriod = std::chrono::milliseconds(1000);
    // A reader answers a heartbeat, and a writer repairs, after this time.
    std::chrono::nanoseconds ResponseDelay = std::chrono::milliseconds(1);
    // From the arrival of an announcement or a card until it is read.
    std::chrono::nanoseconds DiscoveryDelay = std::chrono::milliseconds(5);
};

// A half-duplex medium that nodes share, a radio: one datagram at a time is on the air, and nodes with
// datagrams take turns. Other datagrams of a node wait in its queue, first in first out, even if its process
// has ended; the sender does not notice. A datagram takes its size as TransportCounters counts it: a
// multicast one once, a unicast one once for each receiver.
struct SimulatedMedium
{
    // For all nodes together; 0: unlimited, nothing takes time or waits. A datagram that is on the air during
    // a change keeps its rate.
    std::uint64_t BytesPerSecond = 0;
    // Capacity of a node's queue. A datagram for which there is no room is dropped.
    std::uint64_t QueueBytes = 16'000;
    // Bytes of each datagram on the medium beyond its IP packet: 14 for the header of Ethernet.
    std::uint64_t Overhead = 0;
};

// Statistics of a medium since its creation. Bytes are as on the air.
struct SimulatedAir
{
    std::uint64_t Carried = 0;  // datagrams
    std::uint64_t CarriedBytes = 0;
    std::uint64_t Dropped = 0;  // datagrams for which the queue of their node had no room
    std::uint64_t DroppedBytes = 0;
    std::chrono::nanoseconds LongestWait{0};  // of a datagram in the queue
};

// Datagrams that a node's sessions have sent, past sessions included; on the air or dropped before it.
struct SimulatedSent
{
    std::uint64_t Datagrams = 0;
    std::uint64_t Bytes = 0;
    std::uint64_t DiscoveryBytes = 0;  // part of Bytes: announcements of participants and endpoints
    std::uint64_t WaitingBytes = 0;    // part of Bytes: now in the queue of the medium
};

// Statistics of the whole network.
struct SimulatedTraffic
{
    std::uint64_t Sent = 0;  // datagrams, one for each receiver
    std::uint64_t Lost = 0;  // part of Sent: lost, cut off or dropped by a queue
    std::uint64_t Duplicated = 0;
    std::uint64_t Events = 0;  // steps of the simulation
};

// A network in the memory of one process, for SimulatedTransport sessions, under its own time.
//
// Datagrams are counted as with the real backends. Samples with several readers, announcements and endpoints
// go by multicast where the sender's settings allow it (TransportSettings::Multicast).
//
// Time stands still until AdvanceTo moves it. If the seed, the calls and their order are the same, so are the
// deliveries and their order. AdvanceTo runs all handlers, on the calling thread, each at its simulated time;
// nothing happens outside of it. Events due at one time happen in the order in which they were caused.
//
// It behaves like our backends on DDS, not like an ideal network:
// - Participants find each other by announcements and cards (transport/rtps), and lose each other by leases.
// - The two sides of a match come about separately.
// - A reliable writer repairs the samples of its keep-last history as long as the match holds.
// - A best-effort reader drops late and duplicate samples.
// - A volatile reader loses samples written while it is not matched.
// - A reader that was lost and found gets a transient-local history again (as with Cyclone DDS; Fast DDS does
//   not).
//
// Thread-safe; deterministic only if used by one thread at a time. Sessions keep the network alive.
class SimulatedNetwork
{
public:
    explicit SimulatedNetwork(std::uint64_t seed, const SimulatedTimings &timings = {});
    ~SimulatedNetwork();
    SimulatedNetwork(const SimulatedNetwork &) = delete;
    SimulatedNetwork &operator=(const SimulatedNetwork &) = delete;

    // Sets the faults from nodes to nodes; both are names, or patterns with `*` and `?`. If several rules fit
    // a pair, the one set last applies. Setting a pair of patterns again replaces it and makes it the last.
    // At first, and after ClearFaults, every direction has the default SimulatedFaults.
    void SetFaults(const std::string &from, const std::string &to, const SimulatedFaults &faults);
    void ClearFaults();

    // Makes a medium for the nodes that fit that pattern, or changes the one made for it. If a node fits
    // several, it uses the one made last. Its datagrams occupy that medium alone, wherever the receiver is;
    // datagrams already sent stay on theirs. At first all is unlimited.
    void SetMedium(const std::string &nodes, const SimulatedMedium &medium);
    // Statistics of the medium of that pattern; zeros if none was made.
    SimulatedAir Air(const std::string &nodes) const;
    SimulatedSent Sent(const std::string &node) const;

    // The simulated time; 0 at the start.
    std::chrono::nanoseconds Now() const;
    // Time of the next event, so that a driver can jump there. Empty if there are no sessions.
    std::optional<std::chrono::nanoseconds> NextEvent() const;
    // Runs all events that are due until `time`, then sets Now() to it. Does nothing if `time` is in the
    // past. Not from inside a handler; one thread at a time, others wait.
    void AdvanceTo(std::chrono::nanoseconds time);

    // All sessions of that node vanish without a goodbye, as by SIGKILL. Their peers notice it by their
    // leases, their own handlers are not called any more, and their writes fail. A new session may be opened
    // under the name at once. The dead session's objects are destroyed by their owner as usual.
    void CrashNode(const std::string &node);

    SimulatedTraffic Traffic() const;

    // Time of the last best-effort sample of that topic from node `from` to readers of node `to` that are
    // matched with its writer now. An overtaken sample does not count. Empty if none came, or if no such
    // match is left.
    std::optional<std::chrono::nanoseconds> LastArrival(const std::string &from, const std::string &to,
                                                        const std::string &topic) const;

private:
    friend class SimulatedKeys;
    friend class SimulatedTransport;
    const std::shared_ptr<Simulated::NetworkCore> _core;
};

}  // namespace Rabit
