#include "AirOracle.h"

#include <algorithm>
#include <cmath>
#include <string>

namespace Rabit::Sim
{

namespace
{

using namespace std::chrono_literals;

// Time in which a gateway adapts to a new rate of the medium. It begins when the datagrams sent until then
// have gone: a full queue of each node at most, which no node can take back.
constexpr Time Adapts = 5s;
// A node notices a slower medium once its queue holds this much, as when all nodes send.
constexpr Time Flood = 500ms;
// Time and bytes of the discovery of a newcomer by DDS. Discovery goes before tracks.
constexpr Time Discovers = 20s;
constexpr std::uint64_t Discovery = 20'000;
// A node with a limited rate notices the end of discovery this much later (air/DiscoveryBurst).
constexpr Time DiscoveryIsOver = 2s;
// All must be UP within this part of the time that the plans' radios allow; in the simulation it takes a
// third.
constexpr int PartOfWait = 2;
// Least age that a track may have on arrival, for the check of the newest track.
constexpr Time OnTheWay = 1s;
// Number of unrepeated samples that may be lost in a row; the second is for a medium that carries less than
// in the plan.
constexpr int InARow = 5;
constexpr int InARowWhenItDoesNotFit = 6;
// Least share of the medium for tracks: a quarter, as the plans have it. Notes take all that their class may
// have in two cases: the medium carries less than in the plan, or the node has a large note to send.
// Telemetry then has 3 parts of 43, and a quarter of all goes to presence first (docs/how_to/radio.md).
constexpr double ShareOfTracks = 1.0 / 4;
constexpr double ShareWhenItDoesNotFit = 3.0 / 43 * 3 / 4;
// Most bytes sent for each byte of work, and for each start and each other node.
constexpr double MostForWork = 1.5;
constexpr std::uint64_t MostForStart = 9'000;

std::string Seconds(Time time)
{
    return std::to_string(static_cast<double>(time.count()) / 1e9) + " s";
}

// After an outage longer than a lease of DDS, all nodes find each other anew, by announcements at this
// interval. With a budget, leases are longer than the outages of the plans.
constexpr Time Lease = 30s;
constexpr Time Announces = 10s;

// Most bytes a second of a whole idle fleet. With a budget, beats have a twentieth of it, and DDS some 25
// bytes for each node: 100 for each with a budget of 1500.
std::uint64_t IdleLaw(std::uint64_t nodes, const std::optional<std::uint64_t> &budget)
{
    const std::uint64_t most = 300 * nodes + 20 * nodes * (nodes - 1);
    return budget ? std::min(most, nodes * (*budget / 20 + 25)) : most;
}

}  // namespace

AirOracle::AirOracle(FleetWorld &world, const SimulatedNetwork &network)
    : _world(world),
      _network(network),
      _plan(world.Plan.Thin),
      _pairs(world.Plan.Machines.size() * world.Plan.Machines.size()),
      _senders(world.Plan.Machines.size()),
      _rate(_plan ? _plan->BytesPerSecond : 0)
{
}

void AirOracle::Restart(std::size_t node, Time since)
{
    for (std::size_t other = 0; other < _senders.size(); ++other)
    {
        const bool counts = _senders[node].Alive && _senders[other].Alive && !_outage && node != other;
        for (Pair *pair : {&PairOf(node, other), &PairOf(other, node)})
        {
            pair->Since = since;
            pair->WasUp = false;
            pair->Counts = counts;
        }
    }
}

void AirOracle::OnStarted(std::size_t node)
{
    ++_starts;
    Sender &sender = _senders[node];
    sender.Alive = true;
    sender.Last = _network.Sent(_world.NameOf(node));
    sender.Second.clear();
    sender.Bytes = 0;
    _discoverySince = _world.DisturbedAt = _world.Now;
    Restart(node, _world.Now);
}

void AirOracle::OnEnded(std::size_t node)
{
    _senders[node].Alive = false;
    _discoverySince = _world.DisturbedAt = _world.Now;
    Restart(node, _world.Now);
    for (std::size_t other = 0; other < _senders.size(); ++other)
    {
        PairOf(other, node).Ended = PairOf(other, node).Shown;
    }
}

void AirOracle::OnOutage()
{
    _outage = true;
    _outageSince = _world.Now;
    for (Pair &pair : _pairs)
    {
        pair.WasUp = pair.Counts = false;
    }
}

void AirOracle::OnOutageEnd()
{
    _outage = false;
    _discoverySince = _world.DisturbedAt = _world.Now;
    const bool isForgotten = _world.Now > _outageSince + Lease && !_plan->Budget;
    for (std::size_t node = 0; node < _senders.size(); ++node)
    {
        Restart(node, _world.Now + (isForgotten ? Announces : Time(0)));
    }
}

void AirOracle::OnRate(std::uint64_t bytesPerSecond)
{
    const bool falls = bytesPerSecond < _rate;
    _rate = bytesPerSecond;
    _world.DisturbedAt = _world.Now;
    for (Sender &sender : _senders)
    {
        sender.MayFlood = falls;
        sender.AdaptedAt = falls ? sender.AdaptedAt : WhenAdapted();
    }
}

Time AirOracle::WhenAdapted() const
{
    return _world.Now + Adapts + TimeOf(SimulatedMedium().QueueBytes * _senders.size());
}

// A slower medium shows only in the bytes that wait for it. A node that sends little may learn of it late.
void AirOracle::LookForFlood(Sender &sender, const SimulatedSent &sent) const
{
    if (sender.MayFlood && TimeOf(sent.WaitingBytes * _senders.size()) > Flood)
    {
        sender.MayFlood = false;
        sender.AdaptedAt = WhenAdapted();
    }
}

// Returns the time that these bytes take on the medium at its present rate.
Time AirOracle::TimeOf(std::uint64_t bytes) const
{
    return Time(static_cast<Time::rep>(bytes * 1'000'000'000 / _rate));
}

void AirOracle::OnStep()
{
    if (!_plan)
    {
        return;
    }
    if (_world.Trace != nullptr && _world.Now >= _saidAt + 1s)
    {
        SayWhatIsSent();
    }
    for (std::size_t node = 0; node < _senders.size(); ++node)
    {
        if (_senders[node].MayFlood)
        {
            LookForFlood(_senders[node], _network.Sent(_world.NameOf(node)));
        }
        if (_senders[node].Alive && _plan->Budget)
        {
            CheckBudget(node);
        }
    }
    for (std::size_t i = 0; i < _pairs.size(); ++i)
    {
        const Time within = _plan->UpWithin / PartOfWait;
        if (_pairs[i].Counts && !_pairs[i].WasUp && _world.Now > _pairs[i].Since + within)
        {
            _world.Fail(16, _world.NameOf(i / _senders.size()) + " has not shown " +
                                _world.NameOf(i % _senders.size()) + " as UP for " + Seconds(within));
        }
    }
}

// No second may have more than the budget and a twentieth. DDS's own bytes count when no node has come or
// gone.
void AirOracle::CheckBudget(std::size_t node)
{
    Sender &sender = _senders[node];
    const SimulatedSent sent = _network.Sent(_world.NameOf(node));
    const bool isQuiet = _world.Now > _discoverySince + Discovers;
    const std::uint64_t bytes =
        sent.Bytes - sender.Last.Bytes - (isQuiet ? 0 : sent.DiscoveryBytes - sender.Last.DiscoveryBytes);
    sender.Last = sent;
    if (bytes == 0)
    {
        return;
    }
    sender.Second.emplace_back(_world.Now, bytes);
    sender.Bytes += bytes;
    while (sender.Second.front().first <= _world.Now - 1s)
    {
        sender.Bytes -= sender.Second.front().second;
        sender.Second.pop_front();
    }
    if (sender.Bytes * 20 > *_plan->Budget * 21)
    {
        _world.Fail(18, _world.NameOf(node) + " has sent " + std::to_string(sender.Bytes) +
                            " bytes within a second, with a budget of " + std::to_string(*_plan->Budget));
    }
}

void AirOracle::OnFleet(std::size_t observerLife, const Gateway::Fleet &fleet)
{
    if (!_plan)
    {
        return;
    }
    const std::size_t observer = _world.Lives[observerLife].Node;
    if (_world.Trace != nullptr)
    {
        _world.Say(_world.NameOf(observer) + " uses " + std::to_string(fleet.air.used) + " of " +
                   std::to_string(fleet.air.capacity) + " bytes a second");
    }
    for (const Gateway::NodeStatus &status : fleet.nodes)
    {
        for (std::size_t node = 0; node < _senders.size(); ++node)
        {
            Pair &pair = PairOf(observer, node);
            if (status.node != _world.NameOf(node))
            {
                continue;
            }
            pair.Shown = status.incarnation;
            if (!pair.Counts || pair.Shown == pair.Ended)
            {
                continue;
            }
            if (status.state == Gateway::NodeState::LOST && pair.WasUp &&
                _world.Now >= _senders[node].AdaptedAt)
            {
                _world.Fail(17, _world.NameOf(observer) + " shows " + status.node +
                                    " as LOST, and the medium carries what it says");
            }
            if (status.state == Gateway::NodeState::UP && !pair.WasUp && _world.Now > pair.Since)
            {
                pair.WasUp = true;
                _longestUntilUp = std::max(_longestUntilUp, _world.Now - pair.Since);
            }
        }
    }
}

void AirOracle::OnTrack(std::size_t observerLife, std::size_t node, Time age)
{
    if (_plan && _world.Trace != nullptr)
    {
        _world.Say("a track of " + _world.NameOf(node) + " comes to " +
                   _world.NameOf(_world.Lives[observerLife].Node) + ", " + Seconds(age) + " old");
    }
    if (!_plan || _world.Now < _senders[node].AdaptedAt)
    {
        return;
    }
    _longestAge = std::max(_longestAge, age);
    if (age > (_rate < _plan->BytesPerSecond ? _plan->SlowPoseAge : _plan->PoseAge))
    {
        _world.Fail(19, "a track of " + _world.NameOf(node) + " that comes to " +
                            _world.NameOf(_world.Lives[observerLife].Node) + " is " + Seconds(age) + " old");
    }
}

void AirOracle::OnNewestTrack(std::size_t observer, std::size_t node, Time age)
{
    const Pair &pair = PairOf(observer, node);
    if (!_plan || !pair.Counts)
    {
        return;
    }
    const Time since = std::max(pair.Since + _plan->UpWithin + Adapts, _senders[node].AdaptedAt);
    const double carried = static_cast<double>(_rate) / static_cast<double>(_senders.size());
    const double ofNode = std::min(carried, _plan->Budget ? static_cast<double>(*_plan->Budget) : carried);
    const bool discovers = _world.Now <= _discoverySince + Discovers;
    const auto allowed = [&](double share, int inARow)
    {
        const double seconds = static_cast<double>(TrackOnAir) / share / ofNode;
        const Time pause =
            std::max(_world.Plan.Machines[node].TrackPeriod, Time(std::llround(seconds * 1e9)));
        return std::max(_plan->PoseAge, OnTheWay) + inARow * pause +
               (discovers ? TimeOf(Discovery) + DiscoveryIsOver : Time(0));
    };
    const Time besideCommands = allowed(ShareWhenItDoesNotFit, InARowWhenItDoesNotFit);
    const std::optional<Time> &large = _senders[node].LargeAt;
    const bool fits = _rate >= _plan->BytesPerSecond && !(large && _world.Now - *large <= besideCommands);
    const Time most = fits ? allowed(ShareOfTracks, InARow) : besideCommands;
    // The promise holds from `since` on.
    if (age > most && _world.Now - since > most)
    {
        _world.Fail(20, "the newest track that " + _world.NameOf(observer) + " has of " +
                            _world.NameOf(node) + " is " +
                            (age == Time::max() ? "of another life" : Seconds(age) + " old"));
    }
}

// Writes the bytes of the last second to the trace.
void AirOracle::SayWhatIsSent()
{
    std::string line = "sent (DDS's own):";
    _said.resize(_senders.size());
    for (std::size_t node = 0; node < _senders.size(); ++node)
    {
        const SimulatedSent sent = _network.Sent(_world.NameOf(node));
        line += " " + _world.NameOf(node) + " " + std::to_string(sent.Bytes - _said[node].Bytes) + " (" +
                std::to_string(sent.DiscoveryBytes - _said[node].DiscoveryBytes) + ")";
        _said[node] = sent;
    }
    _saidAt = _world.Now;
    _world.Say(line);
}

std::uint64_t AirOracle::Total() const
{
    std::uint64_t bytes = 0;
    for (std::size_t node = 0; node < _senders.size(); ++node)
    {
        bytes += _network.Sent(_world.NameOf(node)).Bytes;
    }
    return bytes;
}

void AirOracle::BeginIdle()
{
    const std::uint64_t count = _senders.size();
    const std::uint64_t most = static_cast<std::uint64_t>(MostForWork * static_cast<double>(_work)) +
                               MostForStart * _starts * count +
                               static_cast<std::uint64_t>(_world.Now / 1s) * IdleLaw(count, {});
    _sentBeforeIdle = Total();
    _idleSince = _world.Now;
    _mostSaid = _sentBeforeIdle * 100 / most;
    _world.Say("sent " + std::to_string(_sentBeforeIdle) + " bytes, for " + std::to_string(_work) +
               " of work");
    if (_sentBeforeIdle > most)
    {
        _world.Fail(21, "the fleet has sent " + std::to_string(_sentBeforeIdle) + " bytes for " +
                            std::to_string(_work) + " that were to be said; " + std::to_string(most) +
                            " would do");
    }
}

void AirOracle::EndIdle()
{
    const std::uint64_t count = _senders.size();
    const std::uint64_t bytes =
        (Total() - _sentBeforeIdle) * 1000 / static_cast<std::uint64_t>((_world.Now - _idleSince) / 1ms);
    const std::uint64_t most = IdleLaw(count, _plan->Budget);
    _world.Say("idle: " + std::to_string(bytes) + " bytes a second");
    if (bytes > most)
    {
        _world.Fail(22, std::to_string(count) + " idle nodes send " + std::to_string(bytes) +
                            " bytes a second; expected " + std::to_string(most) + " or less");
    }
}

}  // namespace Rabit::Sim
