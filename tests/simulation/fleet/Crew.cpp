#include "Crew.h"

#include <rabit/gateway/GatewayManager.h>

#include <algorithm>
#include <utility>

namespace Rabit::Sim
{

namespace
{

// Bytes on the air of a note that is acknowledged, without its filler.
constexpr std::uint64_t NoteOnAir = 330;

}  // namespace

Crew::Crew(RabitWorkspace &workspace, FleetWorld &world, const Oracles &oracles, SimRandom &random,
           std::size_t life)
    : RabitManager("Crew", workspace),
      _world(world),
      _oracles(oracles),
      _random(random),
      _life(life),
      _plan(world.Plan.Machines[world.Lives[life].Node]),
      _queue(std::make_shared<RabitQueue>(_plan.QueueCapacity, Queue)),
      _track(std::make_shared<Track>()),
      _mode(std::make_shared<Mode>()),
      _fleet(std::make_shared<Gateway::Fleet>())
{
    AddManagerMessageQueue(Queue, _queue);
    _queue->Register_SomethingEnqueued([this] { NoteArrivals(); });
    WakeUpManagerOnEnqueue(_queue);
    AddPublishSubscribeMessage("Track", _track);
    AddPublishSubscribeMessage("Mode", _mode);
    AddPublishSubscribeMessage(FleetMessageName, _fleet);
    WakeUpManagerOnMessagePost(_fleet);
    AddMirrors("Track", _tracks);
    AddMirrors("Mode", _modes);
}

Crew::~Crew()
{
    _queue->DisconnectAllHandlers();
}

template <typename Message>
void Crew::AddMirrors(const char *name, std::vector<Mirror<Message>> &mirrors)
{
    for (std::size_t node = 0; node < _world.Plan.Machines.size(); ++node)
    {
        if (node != _world.Lives[_life].Node)
        {
            Mirror<Message> mirror{node, std::make_shared<Message>()};
            AddPublishSubscribeMessage(_world.NameOf(node) + "/" + name, mirror.Local);
            WakeUpManagerOnMessagePost(mirror.Local);
            mirrors.push_back(std::move(mirror));
        }
    }
}

template <typename Message>
void Crew::FetchMirrors(MirrorOracle::Topic topic, std::vector<Mirror<Message>> &mirrors)
{
    for (Mirror<Message> &mirror : mirrors)
    {
        if (mirror.Local->FetchMessage() && mirror.Local->WasPosted())
        {
            _oracles.Mirrors.OnFetched(topic, _life, mirror.Node, mirror.Local->life, mirror.Local->number,
                                       mirror.Local->GetAgeSeconds());
            if (topic == MirrorOracle::Topic::Track)
            {
                _oracles.Air.OnTrack(_life, mirror.Node,
                                     _oracles.Mirrors.AgeOf(topic, _life, mirror.Local->life));
            }
        }
    }
}

// Runs when the gateway has put notes into the queue, before anything else happens.
void Crew::NoteArrivals()
{
    while (static_cast<int>(_arrivals.size()) < _queue->NoMessagesInQueue())
    {
        Arrival arrival{_world.Now, {}};
        for (std::size_t life = 0; life < _world.Lives.size(); ++life)
        {
            arrival.SourceClocks.push_back(_oracles.ClockOf(life));
        }
        _arrivals.push_back(std::move(arrival));
    }
}

bool Crew::TakeOne()
{
    std::shared_ptr<RabitMessage> message;
    if (!_queue->GetMessage(message))
    {
        return false;
    }
    const auto note = std::dynamic_pointer_cast<Note>(message);
    if (!note || _arrivals.empty())
    {
        _world.Fail(8, "something else than a note came, or a note of which nobody was told");
        return false;
    }
    const Arrival arrival = std::move(_arrivals.front());
    _arrivals.pop_front();
    const bool known = note->number < _oracles.Notes.Notes();
    _oracles.Notes.OnArrived(_life, *note, message->IsRedelivered(),
                             known ? arrival.SourceClocks[_oracles.Notes.SourceLife(note->number)] : Time(0));
    return true;
}

void Crew::EmptyQueue()
{
    while (TakeOne())
    {
    }
}

void Crew::Send(std::size_t destination, int count)
{
    _orders.emplace_back(destination, count);
    WakeUpManagerEH();
}

void Crew::Hurry()
{
    _hurries = true;
    _stalledUntil = _world.Now;
    _nextTake = LocalNow();
    WakeUpManagerEH();
}

void Crew::PostMode()
{
    _postMode = true;
    WakeUpManagerEH();
}

void Crew::SendNotes()
{
    const auto orders = std::exchange(_orders, {});
    for (const auto &[destination, count] : orders)
    {
        const std::string address =
            (destination == Burst::ToAll ? std::string("*") : _world.NameOf(destination)) + "/" + Queue;
        const std::uint64_t receivers = destination == Burst::ToAll ? _world.Plan.Machines.size() - 1 : 1;
        for (int i = 0; i < count; ++i)
        {
            const auto note = std::make_shared<Note>(_oracles.Notes.Make(_life, destination, _random));
            const Time now = LocalNow();
            const std::uint64_t number = note->number;
            const bool accepted = AddMessageToQueue(address, std::static_pointer_cast<RabitMessage>(note),
                                                    _oracles.Notes.MakeReceipt(number));
            _oracles.Notes.OnSent(number, accepted, now);
            _oracles.Air.OnWork(accepted ? (note->filler.size() + NoteOnAir) * receivers : 0);
        }
    }
}

void Crew::ExecuteUnitOfWork()
{
    const Time now = LocalNow();
    FetchMirrors(MirrorOracle::Topic::Track, _tracks);
    FetchMirrors(MirrorOracle::Topic::Mode, _modes);
    if (_fleet->FetchMessage())
    {
        _oracles.Presence.OnFleet(_life, *_fleet);
        _oracles.Air.OnFleet(_life, *_fleet);
        _oracles.Notes.OnFleet(_life, *_fleet);
    }
    SendNotes();
    if (now >= _nextTrack && !_silent)
    {
        _track->life = _life;
        _track->number = _oracles.Mirrors.OnPosted(MirrorOracle::Topic::Track, _life);
        _track->PostMessage();
        _oracles.Air.OnWork(TrackOnAir);
        _nextTrack = now + _plan.TrackPeriod;
    }
    if (std::exchange(_postMode, false))
    {
        _mode->life = _life;
        _mode->number = _oracles.Mirrors.OnPosted(MirrorOracle::Topic::Mode, _life);
        _mode->PostMessage();
    }
    if (now >= _nextTake && _world.Now >= _stalledUntil && TakeOne())
    {
        _nextTake = now + (_hurries ? std::min<Time>(_plan.ConsumePeriod, std::chrono::milliseconds(1))
                                    : _plan.ConsumePeriod);
    }
    Time next = _silent ? now + std::chrono::seconds(1) : _nextTrack;
    if (!_arrivals.empty())
    {
        next = std::min(next, std::max(_nextTake, now + (_stalledUntil - _world.Now)));
    }
    SetWakeupTimeDelaySec(std::max(1e-6, std::chrono::duration<double>(next - now).count()));
}

}  // namespace Rabit::Sim
