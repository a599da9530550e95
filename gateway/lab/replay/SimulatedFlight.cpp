#include "SimulatedFlight.h"

#include <algorithm>
#include <limits>
#include <utility>

#include "FleetFacts.h"
#include "RecordedFacts.h"
#include "RecordedPosts.h"

namespace Rabit::WhatIf
{
namespace
{

using Json = SimulatedFlight::Json;
using Replay::ReplayStream;

// Of looking at counters.
constexpr Nanoseconds LookPeriod = std::chrono::seconds(1);

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
    std::string Name;  // of the life
    std::unique_ptr<RecordedPosts> Posts{};
    std::map<std::string, FlightTap::Values> Own{};  // by message
    std::shared_ptr<FlightTap> Tap{};
    Facts::FleetFacts Facts{};
};

SimulatedFlight::SimulatedFlight(Recording &recording, const FlightSettings &settings, Tell tell)
    : _recording(recording),
      _settings(settings),
      _tell(std::move(tell)),
      _times(recording.Plan().Streams.size()),
      _begin(recording.Begin()),
      _end(recording.End()),
      _fleet(settings.Seed),
      _lives(recording.Lives().size())
{
    _fleet.Network.SetMedium("*", settings.Medium);
    _fleet.Network.SetFaults("*", "*", settings.Faults);
}

SimulatedFlight::~SimulatedFlight() = default;

void SimulatedFlight::Run()
{
    for (Json &fact : FactsOfFlight(_recording))
    {
        _tell(std::move(fact));
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
    for (Json &fact : FactsOfArrivals(_recording))
    {
        _tell(std::move(fact));
    }
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
    flying->Name = NameOfLife(_recording, life);
    Flying *const added = flying.get();
    _lives[life] = std::move(flying);
    _there[recorded.Node] = life;
    const auto prepare = [this, added](SimulatedNode &node, GatewayConfig &configured)
    {
        added->Tap = std::make_shared<FlightTap>(configured.Node, node.Clock, node.Ahead, _book);
        configured.Tap = added->Tap;
        added->Posts = std::make_unique<RecordedPosts>(node.Workspace, configured);
        for (const AcceptRule &rule : configured.Accept)
        {
            node.Reactor.AddManager(std::make_unique<QueueTaker>(rule.Queue, node.Workspace));
        }
        node.Reactor.AddManager(std::make_unique<FleetWatch>(node.Workspace, FleetMessageNameOf(configured),
                                                             [this, added](const Gateway::Fleet &fleet)
                                                             {
                                                                 for (Json &fact : added->Facts.Look(fleet))
                                                                 {
                                                                     TellOf(*added, std::move(fact));
                                                                 }
                                                             }));
    };
    _tell(FactOfLife(_recording, life));
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
    for (const auto &[message, values] : flying->Own)
    {
        TellOf(*flying, ValuesFact(node, message, true, values));
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
    if (there == _there.end())
    {
        return;
    }
    Flying &flying = *_lives[there->second];
    if (const auto posted = flying.Posts->Play(item, stream, _times))
    {
        flying.Own[stream.Name].emplace_back(_fleet.Network.Now(), *posted - _fleet[stream.Node].Ahead);
    }
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

}  // namespace Rabit::WhatIf
