#include "LinkSimulation.h"

#include "Oracle.h"
#include "Packet.h"
#include "Scenario.h"
#include "SimNode.h"

#include <algorithm>
#include <deque>
#include <memory>
#include <queue>
#include <utility>
#include <vector>

namespace Rabit::Sim
{

namespace
{

using namespace std::chrono_literals;

// All accepted messages must have an outcome this long after the faults have stopped (invariant 11).
constexpr LinkTime DrainTime = 60s;
constexpr LinkTime LongestStraggle = 90s;
constexpr LinkTime LongestPreparation = 50ms;
// Overhead in bytes of a part that goes alone: the headers of two datagrams, the frame's head and the
// acknowledgement's. BytesOfAHead is the frame's head alone, at most.
constexpr double BytesOfAPart = 350;
constexpr std::size_t BytesOfAHead = 100;
// A run has some thousands of events. With more than this, a node asks to be run without end.
constexpr std::uint64_t MostEvents = 1'000'000;

enum class EventKind
{
    Datagram,
    Air,  // the medium has carried the frame that was its turn
    Wake,
    Fault,
    Burst,
    Consume,
    Prepare,
    Calm
};

struct Event
{
    LinkTime At{0};
    std::uint64_t Order = 0;
    EventKind Kind = EventKind::Wake;
    std::size_t A = 0;
    std::size_t B = 0;

    bool operator>(const Event &other) const { return At != other.At ? At > other.At : Order > other.Order; }
};

class Simulation
{
public:
    Simulation(std::uint64_t seed, std::ostream *trace);
    SimResult Run();

private:
    struct Path
    {
        Sim::Weather Weather;
        int Cuts = 0;
    };

    void Schedule(LinkTime at, EventKind kind, std::size_t a, std::size_t b = 0);
    void Handle(const Event &event);
    void OnFault(const Fault &fault);
    void OnDatagram(std::size_t slot);
    void OnConsume(std::size_t node, std::size_t queue);
    void ScheduleConsume(std::size_t node, std::size_t queue);
    void OnCalm();
    void StartNode(std::size_t node, bool storageLost);
    void Transmit(Packet packet);
    void BeginOnAir();
    void OnAir();
    // The network beyond the medium: loss, delay, duplicates.
    void Carry(Packet packet);
    std::size_t CostOf(const Packet &packet) const
    {
        return packet.Bytes.size() + _plan.Settings.AirOverhead;
    }
    void CheckBytes();
    void Put(Packet packet, LinkTime at);
    // Runs the node if something is due, and schedules its next wake-up.
    void Pump(std::size_t node);
    bool IsDrained();
    std::string Lead() const;

    const Scenario _plan;
    SimRandom _random;
    Oracle _oracle;
    std::vector<DriftingClock> _lifeClocks;
    SimWorld _world;
    std::vector<std::unique_ptr<SimNode>> _nodes;
    std::vector<LinkTime> _wakeAt;  // true time of the node's next wake-up; LinkNever: none
    std::vector<LinkTime> _stalledUntil;
    std::vector<bool> _consuming;  // by node and queue: a message will be taken out
    std::vector<Path> _paths;
    std::priority_queue<Event, std::vector<Event>, std::greater<>> _events;
    std::uint64_t _order = 0;
    std::vector<Packet> _packets;
    std::vector<std::size_t> _freeSlots;
    std::deque<Packet> _air;           // waits for the medium, or is on it
    std::vector<std::size_t> _queued;  // bytes of these, by node
    std::int64_t _rate;
    LinkTime _drainOnAir{0};  // the time that a thin medium needs for what waits when the faults stop
    LinkTime _lastDatagramAt{0};
    LinkTime _lastOutcomeAt{0};
    bool _calm = false;
    bool _drained = false;
    SimStatistics _statistics;
    std::ostream *_trace;
};

Simulation::Simulation(std::uint64_t seed, std::ostream *trace)
    : _plan(seed),
      _random(seed ^ 0x5851f42d4c957f2dULL),
      _oracle(_plan),
      _world{.Plan = _plan,
             .Oracle = _oracle,
             .Random = _random,
             .LifeClocks = _lifeClocks,
             .Transmit = [this](Packet packet) { Transmit(std::move(packet)); },
             .QueueFilled = [this](std::size_t node, std::size_t queue) { ScheduleConsume(node, queue); },
             .Prepare =
                 [this](std::size_t node, std::size_t index)
             {
                 const LinkTime takes(_random.Between(0, LinkTime(LongestPreparation).count()));
                 Schedule(_world.Now + takes, EventKind::Prepare, node, index);
             }},
      _wakeAt(_plan.Nodes.size(), LinkNever),
      _stalledUntil(_plan.Nodes.size(), LinkTime(0)),
      _consuming(_plan.Nodes.size() * _plan.Queues.size(), false),
      _queued(_plan.Nodes.size(), 0),
      _rate(_plan.Medium.BitsPerSecond),
      _trace(trace)
{
    for (const Weather &weather : _plan.Start)
    {
        _paths.push_back({weather, 0});
    }
    for (std::size_t i = 0; i < _plan.Nodes.size(); ++i)
    {
        _nodes.push_back(std::make_unique<SimNode>(_world, i));
    }
    for (std::size_t i = 0; i < _plan.Faults.size(); ++i)
    {
        Schedule(_plan.Faults[i].At, EventKind::Fault, i);
    }
    for (std::size_t i = 0; i < _plan.Bursts.size(); ++i)
    {
        Schedule(_plan.Bursts[i].At, EventKind::Burst, i);
    }
    Schedule(_plan.CalmAt, EventKind::Calm, 0);
}

SimResult Simulation::Run()
{
    for (std::size_t i = 0; i < _nodes.size(); ++i)
    {
        if (!_plan.Nodes[i].NeverThere)
        {
            StartNode(i, false);
        }
    }
    while (!_events.empty() && _oracle.Failure().empty())
    {
        const Event event = _events.top();
        _events.pop();
        _world.Now = event.At;
        ++_statistics.Events;
        const std::uint64_t outcomes = _oracle.Outcomes();
        Handle(event);
        if (_oracle.Outcomes() != outcomes)
        {
            _lastOutcomeAt = _world.Now;
        }
        if (_statistics.Events > MostEvents)
        {
            _oracle.Fail(10, "a node asks to be run without end: " +
                                 (event.Kind == EventKind::Wake && _nodes[event.A]->IsAlive()
                                      ? _nodes[event.A]->Links().Describe()
                                      : std::string()));
        }
        if (_calm && !_drained && IsDrained())
        {
            _drained = true;
            _statistics.LongestDrain = std::max(_lastOutcomeAt - _plan.CalmAt, LinkTime(0));
        }
        if (_calm && !_drained && _world.Now > _plan.CalmAt + DrainTime + _drainOnAir)
        {
            std::vector<bool> alive;
            for (const auto &node : _nodes)
            {
                alive.push_back(node->IsAlive());
            }
            _oracle.Fail(11, std::to_string(_oracle.Undrained(alive)) +
                                 " messages have no outcome 60 s after the "
                                 "faults stopped");
        }
        if (_drained && (!_plan.WaitForStragglers || _world.Now > _lastDatagramAt))
        {
            break;
        }
    }
    _statistics.Accepted = _oracle.Accepted();
    _statistics.Refused = _oracle.Refused();
    _statistics.Delivered = _oracle.OutcomesOf(LinkOutcome::Delivered);
    _statistics.Expired = _oracle.OutcomesOf(LinkOutcome::Expired);
    _statistics.InDoubt = _oracle.OutcomesOf(LinkOutcome::InDoubt);
    _statistics.RefusedThere = _oracle.OutcomesOf(LinkOutcome::RefusedThere);
    _statistics.DeliveredAgain = _oracle.RedeliveredTwice();
    _statistics.ThinMedia = _plan.Medium.BitsPerSecond > 0 ? 1 : 0;
    _statistics.GivenUp = _oracle.GivenUp();
    _statistics.LargeDelivered = _oracle.LargeDelivered();
    _statistics.PayloadDelivered = _oracle.DeliveredBytes();
    for (const auto &node : _nodes)
    {
        _statistics.Raises += node->IsAlive() ? node->Links().Counters().Raises : 0;
        if (node->IsAlive())
        {
            node->Links().VisitReceivers(
                [this](std::string_view, std::string_view, const LinkReceiverCounters &counters)
                { _statistics.PartsHeld += counters.Kept; });
        }
    }
    CheckBytes();
    return {_oracle.Failure(), _statistics};
}

// Invariant 15. Each accepted byte is sent as often as the run's worst loss requires, in both directions,
// and once more for what nodes forget in crashes. Acknowledgements and headers are counted with each
// message. A link that hears nothing asks now and then.
void Simulation::CheckBytes()
{
    double worst = 0;
    for (const Weather &weather : _plan.Start)
    {
        worst = std::max(worst, weather.Loss);
    }
    for (const Fault &fault : _plan.Faults)
    {
        worst = std::max(worst, fault.Kind == FaultKind::Weather ? fault.Weather.Loss : 0);
    }
    const double sends = 1 / ((1 - worst) * (1 - worst));
    const double parts = static_cast<double>(_oracle.AcceptedBytes()) /
                         static_cast<double>(_plan.Settings.MaxDatagram - BytesOfAHead);
    const double messages = static_cast<double>(_oracle.AcceptedBytes()) +
                            BytesOfAPart * (static_cast<double>(_oracle.Accepted()) + parts);
    const double asking =
        static_cast<double>(_plan.Links.size()) * std::chrono::duration<double>(_world.Now).count() *
        (static_cast<double>(_plan.Settings.MaxDatagram + _plan.Settings.AirOverhead) + BytesOfAPart);
    const double bound = 2 * (sends * messages + asking);
    _statistics.MostSent =
        static_cast<std::uint64_t>(100 * static_cast<double>(_statistics.BytesSent) / bound);
    if (static_cast<double>(_statistics.BytesSent) > bound)
    {
        _oracle.Fail(15, std::to_string(_statistics.BytesSent) + " bytes were sent where " +
                             std::to_string(static_cast<std::uint64_t>(bound)) + " are enough");
    }
}

std::string Simulation::Lead() const
{
    return std::to_string(static_cast<double>(_world.Now.count()) / 1e9) + "  ";
}

void Simulation::Schedule(LinkTime at, EventKind kind, std::size_t a, std::size_t b)
{
    _events.push({at, _order++, kind, a, b});
}

void Simulation::Handle(const Event &event)
{
    switch (event.Kind)
    {
        case EventKind::Datagram:
            OnDatagram(event.A);
            break;
        case EventKind::Air:
            OnAir();
            break;
        case EventKind::Wake:
            if (event.At == _wakeAt[event.A])
            {
                _wakeAt[event.A] = LinkNever;
                Pump(event.A);
            }
            break;
        case EventKind::Fault:
            OnFault(_plan.Faults[event.A]);
            break;
        case EventKind::Burst:
        {
            const Burst &burst = _plan.Bursts[event.A];
            const std::size_t source = _plan.Links[burst.Link].Source;
            if (_nodes[source]->IsAlive())
            {
                if (_trace != nullptr)
                {
                    *_trace << Lead() << "n" << source << " enqueues " << burst.Count << " on link "
                            << burst.Link << " from message " << _oracle.Accepted() << '\n';
                }
                for (int i = 0; i < burst.Count; ++i)
                {
                    _nodes[source]->Enqueue(burst.Link);
                }
                Pump(source);
            }
            break;
        }
        case EventKind::Consume:
            OnConsume(event.A, event.B);
            break;
        case EventKind::Prepare:
            _nodes[event.A]->FinishPreparation(event.B);
            ++_statistics.Prepared;
            if (_nodes[event.A]->IsAlive())
            {
                Pump(event.A);
            }
            break;
        case EventKind::Calm:
            OnCalm();
            break;
    }
}

void Simulation::OnFault(const Fault &fault)
{
    Path &path = _paths[fault.A * _plan.Nodes.size() + fault.B];
    if (_trace != nullptr)
    {
        static constexpr const char *Names[] = {"weather",    "cut",   "cut ends", "crash", "start",
                                                "clock step", "stall", "forget",   "rate"};
        *_trace << Lead() << Names[static_cast<int>(fault.Kind)] << " n" << fault.A << " n" << fault.B << ' '
                << fault.Amount << (fault.LoseStorage ? " storage lost" : "") << '\n';
    }
    switch (fault.Kind)
    {
        case FaultKind::Weather:
            path.Weather = fault.Weather;
            break;
        case FaultKind::CutStart:
            ++path.Cuts;
            break;
        case FaultKind::CutEnd:
            --path.Cuts;
            break;
        case FaultKind::Crash:
            if (_nodes[fault.A]->IsAlive())
            {
                _statistics.Raises += _nodes[fault.A]->Links().Counters().Raises;
                ++_statistics.Crashes;
                _nodes[fault.A]->Crash();
                _wakeAt[fault.A] = LinkNever;
            }
            break;
        case FaultKind::Start:
            if (!_nodes[fault.A]->IsAlive())
            {
                _statistics.StoragesLost += fault.LoseStorage ? 1 : 0;
                StartNode(fault.A, fault.LoseStorage);
            }
            break;
        case FaultKind::ClockStep:
            _nodes[fault.A]->StepWallClock(fault.Amount);
            break;
        case FaultKind::Stall:
            _stalledUntil[fault.A] = _world.Now + LinkTime(fault.Amount);
            break;
        case FaultKind::Rate:
            _rate = fault.Amount;
            ++_statistics.RateChanges;
            break;
        case FaultKind::Forget:
            if (_nodes[fault.A]->IsAlive() && fault.A != fault.B)
            {
                _statistics.Forgotten += _nodes[fault.A]->Forget(fault.B) ? 1 : 0;
                Pump(fault.A);
            }
            break;
    }
}

void Simulation::StartNode(std::size_t node, bool storageLost)
{
    _wakeAt[node] = LinkNever;
    _nodes[node]->Start(storageLost);
    Pump(node);
}

// The faults stop: paths are whole, all nodes are up, and queues are emptied. Datagrams sent earlier may
// still come.
void Simulation::OnCalm()
{
    _calm = true;
    for (Path &path : _paths)
    {
        path.Weather = {.Delay = std::min<LinkTime>(path.Weather.Delay, 40ms)};
        path.Cuts = 0;
    }
    if (_rate > 0)
    {
        // Three times the pending bytes, all with their headers and acknowledgements.
        const std::size_t bytes = _oracle.PendingBytes() + 400 * _oracle.PendingCount();
        _drainOnAir = LinkTime(static_cast<std::int64_t>(3 * 8 * bytes) * 1'000'000'000 / _rate);
    }
    for (std::size_t i = 0; i < _nodes.size(); ++i)
    {
        _stalledUntil[i] = LinkTime(0);
        _nodes[i]->SetCalm();
        if (!_nodes[i]->IsAlive() && !_plan.Nodes[i].NeverThere)
        {
            StartNode(i, false);
        }
    }
}

void Simulation::OnConsume(std::size_t node, std::size_t queue)
{
    _consuming[node * _plan.Queues.size() + queue] = false;
    if (!_nodes[node]->IsAlive())
    {
        return;
    }
    bool more = true;
    if (_world.Now >= _stalledUntil[node])
    {
        more = _nodes[node]->Consume(queue);
        Pump(node);
    }
    if (more)
    {
        ScheduleConsume(node, queue);
    }
}

void Simulation::ScheduleConsume(std::size_t node, std::size_t queue)
{
    if (_consuming[node * _plan.Queues.size() + queue])
    {
        return;
    }
    _consuming[node * _plan.Queues.size() + queue] = true;
    const LinkTime period = _plan.Queues[queue].ConsumePeriod;
    const LinkTime soonest = _world.Now + (_calm ? std::min<LinkTime>(period, 10ms) : period);
    Schedule(std::max(soonest, std::min(_stalledUntil[node], _plan.CalmAt)), EventKind::Consume, node, queue);
}

void Simulation::Transmit(Packet packet)
{
    ++_statistics.Datagrams;
    const std::size_t cost = CostOf(packet);
    _statistics.BytesSent += cost;
    if (_rate == 0)
    {
        Carry(std::move(packet));
        return;
    }
    if (_queued[packet.From] + cost > _plan.Medium.QueueBytes)
    {
        ++_statistics.Overflows;
        return;
    }
    _queued[packet.From] += cost;
    _air.push_back(std::move(packet));
    if (_air.size() == 1)
    {
        BeginOnAir();
    }
}

void Simulation::BeginOnAir()
{
    const auto bits = static_cast<std::int64_t>(8 * CostOf(_air.front()));
    Schedule(_world.Now + LinkTime(bits * 1'000'000'000 / _rate), EventKind::Air, 0);
}

void Simulation::OnAir()
{
    Packet packet = std::move(_air.front());
    _air.pop_front();
    _queued[packet.From] -= CostOf(packet);
    if (!_air.empty())
    {
        BeginOnAir();
    }
    Carry(std::move(packet));
}

void Simulation::Carry(Packet packet)
{
    const Path &path = _paths[packet.From * _plan.Nodes.size() + packet.To];
    const bool lost = path.Cuts > 0 || _random.Chance(path.Weather.Loss);
    if (_trace != nullptr)
    {
        *_trace << Lead() << "sent " << Describe(packet) << (lost ? "  (lost)" : "") << '\n';
    }
    if (lost)
    {
        ++_statistics.Lost;
        return;
    }
    const auto delay = [&]
    {
        if (_random.Chance(path.Weather.Straggle))
        {
            ++_statistics.Straggling;
            return LinkTime(_random.Between(0, LongestStraggle.count()));
        }
        return path.Weather.Delay + LinkTime(_random.Between(0, path.Weather.Jitter.count()));
    };
    if (_random.Chance(path.Weather.Duplicate))
    {
        ++_statistics.Duplicated;
        Put(packet, _world.Now + delay());
    }
    Put(std::move(packet), _world.Now + delay());
}

void Simulation::Put(Packet packet, LinkTime at)
{
    if (_freeSlots.empty())
    {
        _freeSlots.push_back(_packets.size());
        _packets.emplace_back();
    }
    const std::size_t slot = _freeSlots.back();
    _freeSlots.pop_back();
    _packets[slot] = std::move(packet);
    if (!_calm)
    {
        _lastDatagramAt = std::max(_lastDatagramAt, at);
    }
    Schedule(at, EventKind::Datagram, slot);
}

void Simulation::OnDatagram(std::size_t slot)
{
    Packet packet = std::move(_packets[slot]);
    _freeSlots.push_back(slot);
    SimNode &node = *_nodes[packet.To];
    if (!node.IsAlive())
    {
        return;
    }
    if (_trace != nullptr)
    {
        *_trace << Lead() << "came " << Describe(packet) << '\n';
    }
    // A short frame tells its sender's life only to a node that knows it already.
    if (node.Receive(packet) && _nodes[packet.From]->IsAlive() &&
        _nodes[packet.From]->Links().IncarnationTo(_plan.Nodes[packet.To].Name) == packet.SenderLife)
    {
        _oracle.Knows(packet.To, packet.From, _nodes[packet.To]->LocalNow());
    }
    Pump(packet.To);
    if (_random.Chance(_plan.MalformedPart))
    {
        ++_statistics.Malformed;
        const std::string before = node.Links().Describe();
        node.ReceiveSpoiled(packet);
        if (node.Links().Describe() != before)
        {
            _oracle.Fail(9, "malformed input changed the state: " + Describe(packet));
        }
    }
}

void Simulation::Pump(std::size_t index)
{
    SimNode &node = *_nodes[index];
    // A driver with a delay runs at its own times; a driver without one runs at once.
    const LinkTime delay = _calm ? LinkTime(0) : _plan.Nodes[index].DriverDelay;
    if (node.Links().NextDue() <= node.LocalNow() && (delay == LinkTime(0) || _wakeAt[index] == LinkNever))
    {
        node.Links().Run(node.LocalNow());
    }
    node.Check();
    const LinkTime due = node.Links().NextDue();
    if (due == LinkNever)
    {
        return;
    }
    // A slow clock is not there yet after this wait: then the node is asked again a moment later.
    const LinkTime wait = std::max<LinkTime>(due - node.LocalNow(), 1us);
    const LinkTime at =
        _world.Now + wait + LinkTime(delay == LinkTime(0) ? 0 : _random.Between(0, delay.count()));
    if (at < _wakeAt[index])
    {
        _wakeAt[index] = at;
        Schedule(at, EventKind::Wake, index);
    }
}

bool Simulation::IsDrained()
{
    if (_world.Now < _plan.CalmAt + 1s)
    {
        return false;  // the last messages are enqueued in this second
    }
    std::vector<bool> alive;
    for (const auto &node : _nodes)
    {
        alive.push_back(node->IsAlive());
    }
    return _oracle.Undrained(alive) == 0;
}

}  // namespace

SimResult RunSeed(std::uint64_t seed, std::ostream *trace)
{
    return Simulation(seed, trace).Run();
}

}  // namespace Rabit::Sim
