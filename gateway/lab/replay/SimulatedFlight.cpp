#include "SimulatedFlight.h"

#include <rabit/idl/MessageType.h>
#include <rabit/idl/MessageTypeRegistry.h>

#include <algorithm>
#include <limits>
#include <utility>

#include "FleetFacts.h"

namespace Rabit::WhatIf
{
namespace
{

using Json = SimulatedFlight::Json;
using Replay::ReplayStream;

// Nodes that end this shortly before the last one, in nanoseconds, were told to end with it.
constexpr Time EndsTogether = 2'000'000'000;
// A message that was older than this when it was posted, in nanoseconds, is posted as old as this. Clocks of
// simulated nodes begin at a few of these.
constexpr Time OldestPost = 900'000'000'000;
// Of looking at counters.
constexpr Nanoseconds LookPeriod = std::chrono::seconds(1);

// Empties a queue, as a manager that is never late.
class Taker final : public RabitManager
{
public:
    using RabitManager::RabitManager;
    void ExecuteUnitOfWork() final
    {
        std::shared_ptr<RabitMessage> message;
        while (GetManagerMessageQueue()->GetMessage(message))
        {
        }
    }
};

// Tells of each Gateway/Fleet of a node.
class FleetWatch final : public RabitManager
{
public:
    using Look = std::function<void(const Gateway::Fleet &)>;
    FleetWatch(RabitWorkspace &workspace, const std::string &message, Look look)
        : RabitManager("FlightWatch", workspace), _look(std::move(look))
    {
        AddPublishSubscribeMessage(message, _fleet);
        WakeUpManagerOnMessagePost(_fleet);
    }
    void ExecuteUnitOfWork() final
    {
        if (_fleet->FetchMessage())
        {
            _look(*_fleet);
        }
    }

private:
    const Look _look;
    const std::shared_ptr<Gateway::Fleet> _fleet = std::make_shared<Gateway::Fleet>();
};

Json ValuesFact(const std::string &node, const std::string &message, bool isOwn,
                const FlightTap::Values &values)
{
    Json at = Json::array();
    Json posted = Json::array();
    for (const auto &[arrived, post] : values)
    {
        at.push_back(arrived.count());
        posted.push_back(post.count());
    }
    return {{"fact", "values"}, {"message", message}, {"node", node},
            {"own", isOwn},     {"at", at},           {"posted", posted}};
}

}  // namespace

// A life of a node in the simulation.
struct SimulatedFlight::Flying
{
    struct Posted
    {
        std::shared_ptr<RabitMessage> Message;
        const MessageType *Type = nullptr;
        FlightTap::Values Values{};
    };
    std::string Name;  // of the life
    std::map<std::string, Posted> Posts{};
    std::shared_ptr<FlightTap> Tap{};
    Facts::FleetFacts Facts{};
    Nanoseconds NextPublications{0};
};

SimulatedFlight::SimulatedFlight(Recording &recording, const FlightSettings &settings, Tell tell)
    : _recording(recording),
      _settings(settings),
      _tell(std::move(tell)),
      _times(recording.Plan().Streams.size()),
      _fleet(settings.Seed),
      _lives(recording.Lives().size())
{
    _fleet.Network.SetMedium("*", settings.Medium);
    _fleet.Network.SetFaults("*", "*", settings.Faults);
    _begin = _recording.Messages().First();
    const Time last = _recording.Messages().Last();
    _end = last;
    for (const RecordedLife &life : _recording.Lives())
    {
        _end = life.End + EndsTogether > last ? std::min(_end, life.End) : _end;
    }
    _end = std::max(_begin, _end);
}

SimulatedFlight::~SimulatedFlight() = default;

void SimulatedFlight::Run()
{
    _tell({{"fact", "flight"}, {"end", Since(_end)}});
    for (const std::string &note : _recording.Notes())
    {
        _tell({{"fact", "note"}, {"text", note}});
    }
    const std::vector<RecordedLife> &lives = _recording.Lives();
    std::multimap<Time, std::size_t> ends;
    std::size_t nextLife = 0;
    _recording.Messages().Begin(_begin);
    auto item = _recording.Messages().Next();
    for (;;)
    {
        constexpr Time never = std::numeric_limits<Time>::max();
        const Time start = nextLife < lives.size() ? std::max(lives[nextLife].Begin, _begin) : never;
        const Time end = ends.empty() ? never : ends.begin()->first;
        const Time post = item ? item->LogTime : never;
        const Time now = std::min({start, end, post});
        if (now == never || now > _end)
        {
            break;
        }
        RunTo(now);
        if (end == now)
        {
            End(ends.begin()->second, true);
            ends.erase(ends.begin());
        }
        else if (start == now)
        {
            if (lives[nextLife].End < _end)
            {
                ends.emplace(lives[nextLife].End + 1, nextLife);
            }
            Start(nextLife++);
        }
        else
        {
            Play(*item);
            item = _recording.Messages().Next();
        }
    }
    RunTo(_end);
    while (!_there.empty())
    {
        End(_there.begin()->second, false);
    }
    TellQueues();
    TellFlown();
}

void SimulatedFlight::RunTo(Time time)
{
    const Nanoseconds until(Since(time));
    while (_nextMedium <= until)
    {
        _fleet.RunFor(_nextMedium - _fleet.Network.Now());
        TellMedium();
        _nextMedium += LookPeriod;
    }
    _fleet.RunFor(until - _fleet.Network.Now());
}

void SimulatedFlight::Start(std::size_t life)
{
    const RecordedLife &recorded = _recording.Lives()[life];
    if (const auto known = _there.find(recorded.Node); known != _there.end())
    {
        End(known->second, true);
    }
    GatewayConfig config = recorded.Config;
    if (_settings.Budget)
    {
        config.Radio.Budget = *_settings.Budget > 0 ? _settings.Budget : std::nullopt;
    }
    auto flying = std::make_unique<Flying>();
    flying->Name = recorded.Node + "#" + std::to_string(life);
    Flying *const added = flying.get();
    _lives[life] = std::move(flying);
    _there[recorded.Node] = life;
    const auto prepare = [this, added](SimulatedNode &node, GatewayConfig &configured)
    {
        added->Tap = std::make_shared<FlightTap>(configured.Node, node.Clock, node.Ahead, _book);
        configured.Tap = added->Tap;
        for (const PublishRule &rule : configured.Publish)
        {
            const MessageType *type = MessageTypeRegistry::Find(rule.Type);
            Flying::Posted posted{type->CreateShared(), type};
            if (node.Workspace.AddPublishSubscribeMessage(rule.Message, posted.Message))
            {
                added->Posts.emplace(rule.Message, std::move(posted));
            }
        }
        for (const AcceptRule &rule : configured.Accept)
        {
            node.Reactor.AddManager(std::make_unique<Taker>(rule.Queue, node.Workspace));
        }
        node.Reactor.AddManager(std::make_unique<FleetWatch>(
            node.Workspace, FleetMessageNameOf(configured),
            [this, added](const Gateway::Fleet &fleet)
            {
                for (Json &fact : added->Facts.Look(fleet))
                {
                    TellOf(*added, std::move(fact));
                }
                if (_fleet.Network.Now() >= added->NextPublications)
                {
                    added->NextPublications = _fleet.Network.Now() + LookPeriod;
                    for (const Gateway::PublicationStatus &status : fleet.publications)
                    {
                        TellOf(*added, {{"fact", "publication"},
                                        {"message", status.message},
                                        {"offered", status.offered},
                                        {"replaced", status.replaced}});
                    }
                }
            }));
    };
    _tell({{"fact", "life"},
           {"file", added->Name},
           {"node", recorded.Node},
           {"t", _fleet.Network.Now().count()},
           {"ended", recorded.End < _end ? Json(Since(recorded.End)) : Json()}});
    constexpr double gpsAtBeginning = 1.4e9;
    _fleet.Add(config, gpsAtBeginning + std::chrono::duration<double>(_fleet.Network.Now()).count(), "",
               prepare);
}

void SimulatedFlight::End(std::size_t life, bool isCrash)
{
    const std::unique_ptr<Flying> flying = std::move(_lives[life]);
    const std::string &node = _recording.Lives()[life].Node;
    if (!flying)
    {
        return;
    }
    _there.erase(node);
    for (const auto &[message, posted] : flying->Posts)
    {
        if (!posted.Values.empty())
        {
            TellOf(*flying, ValuesFact(node, message, true, posted.Values));
        }
    }
    for (const auto &[stream, values] : flying->Tap->Arrived())
    {
        TellOf(*flying, ValuesFact(stream.first, stream.second, false, values));
    }
    const auto &streams = _recording.Plan().Streams;
    for (std::size_t at = 0; at < streams.size(); ++at)
    {
        if (streams[at].Node == node)
        {
            _times.Forget(at);
        }
    }
    if (isCrash)
    {
        _fleet.Kill(node);
    }
}

void SimulatedFlight::Play(const Replay::ReplayItem &item)
{
    const ReplayStream &stream = _recording.Plan().Streams[item.Stream];
    const auto there = _there.find(stream.Node);
    const MessageType *type = MessageTypeRegistry::Find(stream.Type);
    if (there == _there.end() || type == nullptr || stream.What == ReplayStream::Kind::Fleet)
    {
        return;
    }
    SimulatedNode &node = _fleet[stream.Node];
    if (stream.What == ReplayStream::Kind::Queue)
    {
        const std::shared_ptr<RabitMessage> message = type->CreateShared();
        if (type->Deserialize(item.Data, *message))
        {
            node.Workspace.AddMessageToQueue(stream.Peer + "/" + stream.Name, message);
        }
        return;
    }
    Flying &flying = *_lives[there->second];
    const auto posted = flying.Posts.find(stream.Name);
    if (posted == flying.Posts.end() || posted->second.Type != type ||
        !type->Deserialize(item.Data, *posted->second.Message))
    {
        return;
    }
    const Nanoseconds age(static_cast<std::int64_t>(
        std::min(item.LogTime - std::min(item.LogTime, item.PublishTime), OldestPost)));
    const PostTime now = node.Clock->Now();
    const Nanoseconds at = _times.Of(item.Stream, now.Monotonic, age);
    posted->second.Message->PostMessage(
        {now.GpsTimeSeconds - std::chrono::duration<double>(now.Monotonic - at).count(), at});
    posted->second.Values.emplace_back(_fleet.Network.Now(), at - node.Ahead);
}

void SimulatedFlight::TellOf(const Flying &flying, Json fact)
{
    fact["file"] = flying.Name;
    fact["t"] = _fleet.Network.Now().count();
    _tell(std::move(fact));
}

void SimulatedFlight::TellMedium()
{
    const SimulatedAir air = _fleet.Network.Air("*");
    _tell({{"fact", "medium"},
           {"t", _fleet.Network.Now().count()},
           {"bytes", air.CarriedBytes},
           {"carried", air.Carried},
           {"dropped", air.Dropped},
           {"longest_wait", air.LongestWait.count()}});
}

void SimulatedFlight::TellQueues()
{
    for (const auto &[link, entry] : _book->Links)
    {
        Json ages = Json::array();
        for (const Nanoseconds age : entry.Ages)
        {
            ages.push_back(age.count());
        }
        const auto &[from, to, queue] = link;
        _tell({{"fact", "queue"},
               {"from", from},
               {"to", to},
               {"queue", queue},
               {"sent", entry.Sent},
               {"refused", entry.Refused},
               {"outcomes", entry.Outcomes},
               {"ages", ages}});
    }
}

void SimulatedFlight::TellFlown()
{
    for (const auto &[observer, streams] : _recording.Arrivals())
    {
        for (const auto &[stream, arrivals] : streams)
        {
            Json at = Json::array();
            Json posted = Json::array();
            for (const Recording::Arrival &arrival : arrivals)
            {
                at.push_back(Since(arrival.At));
                posted.push_back(Since(arrival.Posted));
            }
            _tell({{"fact", "flown"},
                   {"at", observer},
                   {"node", stream.first},
                   {"message", stream.second},
                   {"arrived", at},
                   {"posted", posted}});
        }
    }
}

}  // namespace Rabit::WhatIf
