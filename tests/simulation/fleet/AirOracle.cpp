#include "AirOracle.h"

#include <algorithm>
#include <string>

namespace Rabit::Sim
{

namespace
{

using namespace std::chrono_literals;

// The gateway has found its pace so long after the medium has changed its rate.
constexpr Time Adapts = 5s;
// DDS says what it has to say of a newcomer in this time.
constexpr Time Discovers = 20s;
// What may be lost in a row of what is said once.
constexpr int InARow = 6;
// A track on the air, and what part of the medium tracks are to have at the least.
constexpr std::uint64_t TrackOnAir = 190;
constexpr std::uint64_t ShareOfTracks = 4;
// All that is said for each byte that was to be said, and for each start and each other node.
constexpr std::uint64_t MostForWork = 2;
constexpr std::uint64_t MostForStart = 12'000;

std::string Seconds(Time time)
{
    return std::to_string(static_cast<double>(time.count()) / 1e9) + " s";
}

// Bytes a second of a whole fleet that has nothing to say.
std::uint64_t IdleLaw(std::uint64_t nodes)
{
    return 300 * nodes + 20 * nodes * (nodes - 1);
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

void AirOracle::Restart(std::size_t node)
{
    for (std::size_t other = 0; other < _senders.size(); ++other)
    {
        const bool counts = _senders[node].Alive && _senders[other].Alive && !_outage && node != other;
        PairOf(node, other) = PairOf(other, node) = {_world.Now, false, counts};
    }
}

void AirOracle::OnStarted(std::size_t node)
{
    ++_starts;
    _senders[node] = {.Alive = true, .Last = _network.Sent(_world.NameOf(node)), .Second = {}};
    _discoverySince = _world.Now;
    Restart(node);
}

void AirOracle::OnEnded(std::size_t node)
{
    _senders[node].Alive = false;
    _discoverySince = _world.Now;
    Restart(node);
}

void AirOracle::OnOutage()
{
    _outage = true;
    std::fill(_pairs.begin(), _pairs.end(), Pair());
}

void AirOracle::OnOutageEnd()
{
    _outage = false;
    _discoverySince = _world.Now;
    for (std::size_t node = 0; node < _senders.size(); ++node)
    {
        Restart(node);
    }
}

void AirOracle::OnRate(std::uint64_t bytesPerSecond)
{
    _rate = bytesPerSecond;
    _rateSince = _world.Now;
}

void AirOracle::OnStep()
{
    if (!_plan)
    {
        return;
    }
    for (std::size_t node = 0; node < _senders.size(); ++node)
    {
        if (_senders[node].Alive && _plan->Budget)
        {
            CheckBudget(node);
        }
    }
    for (std::size_t i = 0; i < _pairs.size(); ++i)
    {
        if (_pairs[i].Counts && !_pairs[i].WasUp && _world.Now > _pairs[i].Since + _plan->UpWithin)
        {
            _world.Fail(16, _world.NameOf(i / _senders.size()) + " has not shown " +
                                _world.NameOf(i % _senders.size()) + " as UP for " +
                                Seconds(_plan->UpWithin));
        }
    }
}

// In no second more than the budget and a twentieth; of DDS itself, when nobody has come or gone.
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
    for (const Gateway::NodeStatus &status : fleet.nodes)
    {
        for (std::size_t node = 0; node < _senders.size(); ++node)
        {
            Pair &pair = PairOf(observer, node);
            if (status.node != _world.NameOf(node) || !pair.Counts)
            {
                continue;
            }
            if (status.state == Gateway::NodeState::LOST && pair.WasUp)
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
    if (!_plan || _world.Now < _rateSince + Adapts)
    {
        return;
    }
    _longestAge = std::max(_longestAge, age);
    if (age > _plan->PoseAge)
    {
        _world.Fail(19, "a track of " + _world.NameOf(node) + " that comes to " +
                            _world.NameOf(_world.Lives[observerLife].Node) + " is " + Seconds(age) + " old");
    }
}

void AirOracle::OnNewestTrack(std::size_t observer, std::size_t node, Time age)
{
    const Pair &pair = PairOf(observer, node);
    if (!_plan || !pair.Counts || _world.Now < pair.Since + _plan->UpWithin + Adapts ||
        _world.Now < _rateSince + Adapts)
    {
        return;
    }
    const Time pause = std::max<Time>(_world.Plan.Machines[node].TrackPeriod,
                                      1s * (_senders.size() * TrackOnAir * ShareOfTracks) / _rate);
    if (age > _plan->PoseAge + InARow * pause)
    {
        _world.Fail(20, "the newest track that " + _world.NameOf(observer) + " has of " +
                            _world.NameOf(node) + " is " +
                            (age == Time::max() ? "of another life" : Seconds(age) + " old"));
    }
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
    const std::uint64_t most = MostForWork * _work + MostForStart * _starts * count +
                               static_cast<std::uint64_t>(_world.Now / 1s) * IdleLaw(count);
    _sentBeforeIdle = Total();
    _idleSince = _world.Now;
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
    const std::uint64_t most = _plan->Budget ? std::min(100 * count, IdleLaw(count)) : IdleLaw(count);
    _world.Say("idle: " + std::to_string(bytes) + " bytes a second");
    if (bytes > most)
    {
        _world.Fail(22, std::to_string(count) + " idle nodes send " + std::to_string(bytes) +
                            " bytes a second; expected " + std::to_string(most) + " or less");
    }
}

}  // namespace Rabit::Sim
