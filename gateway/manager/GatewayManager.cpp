#include <rabit/RabitHandlerThread.h>
#include <rabit/RabitLog.h>
#include <rabit/gateway/ConfigError.h>
#include <rabit/gateway/GatewayManager.h>
#include <rabit/gateway/GatewayTap.h>
#include <rabit/idl/MessageTypeRegistry.h>

#include <algorithm>
#include <ctime>
#include <deque>
#include <limits>
#include <optional>
#include <stdexcept>

#include "clocks/GpsTime.h"
#include "clocks/SourceClock.h"
#include "foreign/ForeignTopics.h"
#include "gateway.idl.h"
#include "incarnation/IncarnationStore.h"
#include "manager/AirTraffic.h"
#include "manager/Exploration.h"
#include "manager/NodeSecurity.h"
#include "manager/TransportSettingsOf.h"
#include "manager/TypeExchange.h"
#include "mirrors/StateExchange.h"
#include "mirrors/Subscriptions.h"
#include "mirrors/TopicPublisher.h"
#include "names/NamePattern.h"
#include "presence/OriginTable.h"
#include "presence/Presence.h"
#include "presence/RemoteQueues.h"
#include "presence/Whereabouts.h"
#include "queues/LinkDriver.h"
#include "queues/OutgoingQueues.h"
#include "report/Diagnosis.h"
#include "report/FleetReport.h"
#include "report/HandlerWatch.h"
#include "report/LinkStrains.h"
#include "report/Loneliness.h"
#include "report/OtherGateways.h"
#include "report/OwnLog.h"
#include "report/ProblemLog.h"
#include "report/ProblemTexts.h"
#include "wire/Announcements.h"
#include "wire/NodeReports.h"

namespace Rabit
{
namespace
{

using Duration = std::chrono::nanoseconds;

constexpr Duration FleetPeriod = std::chrono::seconds(1);
// Least time between two posts of Gateway/Fleet: each post takes time for every node and row.
constexpr Duration ShortestFleetGap = std::chrono::milliseconds(100);
// Shorter sleeps are not worth it.
constexpr Duration ShortestSleep = std::chrono::microseconds(200);
// A round trip that a radio with a low rate alone may cause.
constexpr Duration ShortWays = std::chrono::milliseconds(100);

// Name of the file that counts the incarnations of this node. Two gateways of one node count separately.
std::string CounterName(const GatewayConfig &config)
{
    return config.Name == GatewayConfig().Name ? config.Node : config.Node + "@" + config.Name;
}

// The beginning of each line of the log. A program has one default workspace and so one node in it, the name
// of which RunNode gives to the log; a node in another workspace may be one of several in the process.
std::string LogNameOf(const GatewayConfig &config, const RabitWorkspace &workspace)
{
    const bool isOneOfSeveral = !config.Tool && &workspace != &*RabitWorkspace::GetWorkspace();
    return (isOneOfSeveral ? config.Node + ": gateway" : "gateway") +
           (config.Name == GatewayConfig().Name ? ": " : " " + config.Name + ": ");
}

const GatewayConfig &Validated(const GatewayConfig &config)
{
    ValidateGatewayConfig(config);
    return config;
}

}  // namespace

// The parts of a gateway, and the order in which they serve, start and end.
class GatewayManager::Parts
{
public:
    // The object exists once the delegate returns. So if Open throws, whatever it is, the destructor closes
    // what was opened, endpoints before the session.
    Parts(const GatewayConfig &config, std::shared_ptr<Transport> transport, GatewayManager &manager,
          const RandomSource &random, Exploration &exploration)
        : Parts(Closed(), config, std::move(transport), manager, random, exploration)
    {
        Open();
    }

    ~Parts() { Close(); }

    bool IsOpen() const { return _session != nullptr; }

    // Leaves the network, for good.
    void Close()
    {
        if (!_session)
        {
            return;
        }
        if (std::exchange(_forwards, false))
        {
            _workspace.RemoveQueueForwarder(_config.Name);
        }
        ReportUndelivered();
        _presence.Close();
        _subscriptions.Close();
        _foreign.Close();
        _links.Close();
        _air.Close();
        _publishers.clear();
        _session.reset();
        if (_handlers)
        {
            _handlers->Stop();
        }
    }

    // Returns when to be called again at the latest.
    Duration Service()
    {
        const Duration now = Now();
        const Presence::Served &served = _presence.Service(now);
        const PeerTable::Change &change = served.Change;
        _types.TakeIn(served, now);
        if (_exploration.IsWanted())
        {
            Explore(change, now);
        }
        for (const std::string &node : change.Forgotten)
        {
            _links.Forget(node);
            _outgoing->Forget(node);
        }
        _states.Serve(served, _publishers, now);
        if (change.NewLife)
        {
            for (const PeerTable::Peer *peer : _presence.Peers().Heard())
            {
                _links.HeardOf(peer->Node, peer->Incarnation);
            }
        }
        for (const Presence::DelayHeard &delay : served.Delays)
        {
            // On a long path datagrams are sent while a report is under way. It is not about these, so its
            // way is subtracted.
            const Duration ways = _links.ShortestRoundTrip(delay.Node);
            const Duration known = std::max(ways - ShortWays, Duration(0));
            _air.Reported(delay.Peer, delay.Delay, delay.ArrivedAt - known, now);
        }
        for (const auto &[peer, sentAt] : served.NothingLate)
        {
            _air.NothingLate(peer, sentAt, now);
        }
        if (_links.HasDelays())
        {
            _links.TakeDelays(now, [this](const std::string &node, Duration delay, Duration arrivedAt)
                              { _presence.NoteDelay(node, delay, arrivedAt); });
        }
        Duration next = std::min(_presence.NextDue(), _air.Serve(now));
        next = std::min(next, _states.Due().value_or(next));
        next = std::min(next, _foreign.Service(now));
        if (_states.TellVersions(_publishers, now))
        {
            // A beat that is due already waits for its turn.
            const Duration beat = _presence.BeatDue();
            next = beat > now ? std::min(next, beat) : next;
        }
        if (change.State || change.Offers || _foreign.TakeChange())
        {
            _nextFleet = std::min(_nextFleet, _earliestFleet);
        }
        if (now >= _nextFleet)
        {
            if (_config.Tap)
            {
                TellClocks();
            }
            PostFleet(now);
            if (_exploration.IsWanted())
            {
                SetExplored(now);
            }
            _nextFleet = now + FleetPeriod;
            _earliestFleet = now + ShortestFleetGap;
        }
        return std::min(next, _nextFleet);
    }

    Duration Now() const { return _workspace.GetClock().Monotonic(); }

private:
    struct Closed
    {
    };

    Parts(Closed /*tag*/, const GatewayConfig &config, std::shared_ptr<Transport> transport,
          GatewayManager &manager, const RandomSource &random, Exploration &exploration)
        : _config(Validated(config)),
          _manager(manager),
          _workspace(manager.GetWorkspace()),
          _transport(std::move(transport)),
          _incarnations(
              config.StateDir, CounterName(config),
              [this] { return GpsTime::ToUtcNanoseconds(_workspace.GetClock().GpsTimeSeconds()); }, random),
          _remote(config.Node),
          _links(_config, _workspace, _incarnations, random(), manager.WakeUpHandler(), Handlers()),
          _outgoing(std::make_shared<OutgoingQueues>(_config.Node, _workspace, _remote, _links, _config.Tap)),
          _incarnation(_links.Incarnation()),
          _source(_workspace.GetClock()),
          _presence(
              config.Node, _incarnation, _workspace.GetClock(), _source, _origins, _remote, random,
              [this](const std::string &node) { return IsNeeded(node); }, manager.WakeUpHandler()),
          _subscriptions(_config.Subscribe, _origins, _workspace, Handlers()),
          _states(_presence, _subscriptions, random),
          _fleet(std::make_shared<Gateway::Fleet>()),
          _exploration(exploration)
    {
        if (!_transport)
        {
            throw std::invalid_argument("GatewayManager needs a transport");
        }
        const std::vector<std::string> forwarders = _workspace.GetListOfQueueForwarders();
        if (std::find(forwarders.begin(), forwarders.end(), _config.Name) != forwarders.end())
        {
            throw NameTaken();
        }
        if (!manager.AddPublishSubscribeMessage(FleetMessageNameOf(_config), _fleet))
        {
            throw ConfigError(_config.File, 0,
                              "the local message `" + FleetMessageNameOf(_config) + "` is of another type");
        }
    }

    void Open()
    {
        try
        {
            OpenSession();
        }
        catch (const TransportError &error)
        {
            const std::string setting = error.Setting().empty() ? "interfaces" : error.Setting();
            throw ConfigError(_config.File, LineOfSetting(_config, setting), error.what());
        }
    }

    void OpenSession()
    {
        TransportSettings settings = TransportSettingsOf(_config, _incarnation);
        _keysEndAt = AddSecurity(_config, _transport->Name(), settings);
        _session = _transport->Open(settings, [this](const PeerEvent &event) { _presence.OnPeer(event); });
        _air.TakeTurns(*_session, _manager.WakeUpHandler());
        _openedAt = Now();
        if (_config.Tool)
        {
            _presence.BeTool([this](const std::string &node)
                             { return MatchesAny(_config.Tool->AsksOf, node); });
        }
        if (_config.Replay)
        {
            _presence.BeReplay();
        }
        // First, so that the others learn of this node as early as possible.
        _presence.Open(*_session, Announcements::Of(_config));
        _links.Open(*_session);
        _subscriptions.Open(*_session);
        for (const PublishRule &rule : _config.Publish)
        {
            _publishers.emplace_back(rule, *MessageTypeRegistry::Find(rule.Type), _config.Node, _source,
                                     *_session);
            Attach(_publishers.back());
        }
        _foreign.Open(*_session, _manager, _openedAt);
        _air.Open(*_session);
        _states.Open(_publishers);
        _forwards = _workspace.AddQueueForwarder(_config.Name, _outgoing);
        if (!_forwards)
        {
            throw NameTaken();
        }
    }

    void SetExplored(Duration now)
    {
        _exploredAt = now;
        _exploration.SetNodes(_presence.Peers(), _problemTexts, _workspace.GetClock().Now());
    }

    // Serves the requests of FleetExplorer.
    void Explore(const PeerTable::Change &change, Duration now)
    {
        // Clocks and counts change with each beat.
        if (change.State || change.Offers || change.NewLife || !_exploredAt ||
            now - *_exploredAt >= FleetPeriod)
        {
            SetExplored(now);
        }
        const Exploration::Requests requests = _exploration.TakeRequests();
        for (const TypeQuestions::Wanted &wanted : requests.Lacking)
        {
            // A node that is not there hears no question. If too many texts are wanted, the next turns try
            // again.
            const PeerTable::Peer *peer = _presence.Peers().Find(wanted.Node);
            if (peer != nullptr && peer->State != Gateway::NodeState::LOST)
            {
                static_cast<void>(_types.Want(wanted, now));
            }
        }
        bool any = false;
        for (const SubscribeRule &rule : requests.Subscriptions)
        {
            try
            {
                any |= _subscriptions.Add(rule, *_session);
            }
            catch (const TransportError &error)
            {
                Log({"subscribe " + rule.Message + ": " + error.what()});
            }
        }
        if (any)
        {
            _states.SubscriptionsAdded(now);
        }
        if (requests.LookedFor)
        {
            _exploration.FindSubscribers(*requests.LookedFor, *_session);
        }
    }

    RabitHandlerThread *Handlers() const { return _handlers.get(); }

    ConfigError NameTaken() const
    {
        return {_config.File, LineOfSetting(_config, "name"),
                "there is a gateway `" + _config.Name +
                    "` in this workspace already; each needs a `name` of its own"};
    }

    // Nodes that the configuration names, and those for which messages wait, are not forgotten.
    bool IsNeeded(const std::string &node) const
    {
        const auto names = [&node](const std::string &name) { return name == node; };
        return std::any_of(_config.Subscribe.begin(), _config.Subscribe.end(),
                           [&names](const SubscribeRule &rule)
                           { return std::any_of(rule.From.begin(), rule.From.end(), names); }) ||
               std::any_of(_config.Send.begin(), _config.Send.end(),
                           [&names](const SendRule &rule) { return names(rule.To); }) ||
               _links.HasPending(node);
    }

    void Attach(TopicPublisher &publisher)
    {
        if (_manager.AddPublishSubscribeMessage(publisher.Rule().Message, publisher.Local()))
        {
            _manager.WakeUpManagerOnMessagePost(publisher.Local());
            publisher.SetAttached();
        }
    }

    void ReportUndelivered() const
    {
        // A program that ends soon after a refusal learns the reason nevertheless. Other problems may only be
        // the end of the other managers.
        Log(_problemLog.AtEnd(_outgoing->Problems()));
        for (const Gateway::LinkStatus &link : _outgoing->Status())
        {
            if (link.outbox > 0)
            {
                RabitLog::Write(RabitLogLevel::Warning,
                                _logName + std::to_string(link.outbox) + " messages for `" + link.node + "/" +
                                    link.queue + "` were accepted and not acknowledged before the end");
            }
        }
    }

    void Log(const std::vector<std::string> &lines) const
    {
        for (const std::string &line : lines)
        {
            RabitLog::Write(RabitLogLevel::Warning, _logName + line);
        }
    }

    void TellClocks() const
    {
        std::vector<GatewayTap::PeerClock> peers;
        for (const PeerTable::Peer *peer : _presence.Peers().Heard())
        {
            if (const auto relation = peer->Clock.Source())
            {
                peers.push_back({peer->Node, peer->Incarnation, relation->ToLocal, peer->Clock.RoundTrip()});
            }
        }
        _config.Tap->Clocks(_incarnation, Duration(_source.At(Duration(0))), peers);
    }

    void PostFleet(Duration now)
    {
        Gateway::Fleet &fleet = *_fleet;
        fleet.Clear();
        fleet.node = _config.Node;
        fleet.incarnation = _incarnation;
        _subscriptions.Report(fleet);
        for (const TopicPublisher &publisher : _publishers)
        {
            fleet.publications.push_back(publisher.Status());
        }
        fleet.links = _outgoing->Status();
        fleet.inbound = _links.InboundStatus();
        fleet.forgotten = _presence.Peers().Forgotten();
        fleet.crowded_out =
            _presence.Peers().CrowdedOut() + _subscriptions.CrowdedOut() + _links.CrowdedOut();
        fleet.malformed = _presence.Malformed() + _links.Malformed() + _types.Malformed();
        FleetReport::FillNodes(_presence.Peers(), now, fleet);
        _problemTexts.Fill(_presence.Peers(), fleet);
        _air.Report(fleet, now);
        FleetReport::AddNameProblems(_presence.Peers(), fleet);
        FleetReport::AddNetworkProblems(_session->NetworkProblems(), fleet);
        AddProblems(now, fleet);
        _foreign.Report(now, fleet);
        OtherGateways::AddSharedNodes(_workspace, _config.Name, fleet);
        _presence.SetStrains(_strains.Look(fleet, _presence.Peers(), now));
        {
            const auto global = fleet.GetGlobalPublishSubscribeMessageRef();
            const RabitHandlerThread::Scope scope(Handlers(), _fleetName, global);
            fleet.PostMessage();
        }
        Log(_problemLog.Look(fleet.problems, now));
        _lasted = _problemLog.Lasted(now);
        constexpr std::size_t most = std::numeric_limits<std::uint16_t>::max();
        const auto count = static_cast<std::uint16_t>(std::min(_lasted.Problems.size(), most));
        // No node lists a tool, so a tool does not tell its problems.
        _presence.SetProblems(_config.Tool ? ProblemCount() : ProblemCount{count, _lasted.Digest});
        for (const PeerTable::Peer *peer : _presence.Peers().Heard())
        {
            const TypeQuestions::Wanted problems{peer->Node, "",
                                                 NodeReports::NameOf(NodeReports::Kind::Problems)};
            if (!_problemTexts.Lacks(*peer))
            {
                _presence.TypesLacking().LetGo(problems);
            }
            else if (MatchesAny(_config.ProblemsOf, peer->Node))
            {
                // If too many texts are wanted, the next post asks again.
                static_cast<void>(_types.Want(problems, now));
            }
        }
    }

    // Returns a report of this node, for one that requests it; empty: there is none, or it is refused.
    std::optional<std::string> ReportOf(NodeReports::Name name) const
    {
        switch (name.What)
        {
            case NodeReports::Kind::Problems:
                // If words are refused, the digest alone: with it the requests end.
                return ProblemTexts::ReportOf(
                    _config.Reports ? _lasted
                                    : ProblemLog::Standing{.Problems = {}, .Digest = _lasted.Digest});
            case NodeReports::Kind::Air:
                return AirReport::TextOf(_fleet->air);
            case NodeReports::Kind::LastLines:
                return _config.Reports ? std::optional(_log.Last(name.Argument)) : std::nullopt;
            case NodeReports::Kind::LinesFrom:
                return _config.Reports ? _log.From(name.Argument) : std::nullopt;
            case NodeReports::Kind::Echo:
                break;
        }
        return std::string();
    }

    void OnText(const std::string &node, std::uint64_t definition, TypeQuestions::Answer answer)
    {
        const auto report = NodeReports::NameIn(definition);
        if (!report)
        {
            _exploration.AddText(definition, std::move(answer.Text));
        }
        else if (report->What == NodeReports::Kind::Problems)
        {
            if (const PeerTable::Peer *peer = _presence.Peers().Find(node))
            {
                _problemTexts.Add(*peer, answer.Text);
                _nextFleet = std::min(_nextFleet, _earliestFleet);
            }
        }
        else
        {
            _exploration.AddReport(node, *report, {std::move(answer.Text), Now() - answer.AskedAt});
        }
    }

    void AddProblems(Duration now, Gateway::Fleet &fleet) const
    {
        if (auto lonely = Loneliness::Look(_config, _presence.Peers(), _session->Counters(), _openedAt, now))
        {
            fleet.problems.push_back(std::move(*lonely));
        }
        if (auto ending = KeysProblem(_keysEndAt, std::time(nullptr)))
        {
            fleet.problems.push_back(std::move(*ending));
        }
        for (const TopicPublisher &publisher : _publishers)
        {
            if (!publisher.IsAttached())
            {
                fleet.problems.push_back({"publish " + publisher.Rule().Message, "",
                                          "the local message `" + publisher.Rule().Message +
                                              "` is of another type than `" + publisher.Rule().Type + "`"});
            }
        }
        for (const auto &problems :
             {_config.Tap ? _config.Tap->Problems() : std::vector<Gateway::Problem>(),
              Diagnosis::OfSubscriptions(_subscriptions, _presence.Peers(), now - _openedAt, now),
              _outgoing->Problems(), _links.Problems(), _presence.Problems(now), _slow.Problems(now)})
        {
            fleet.problems.insert(fleet.problems.end(), problems.begin(), problems.end());
        }
    }

    const GatewayConfig &_config;  // the manager's
    GatewayManager &_manager;
    RabitWorkspace &_workspace;
    const std::shared_ptr<Transport> _transport;
    IncarnationStore _incarnations;
    OriginTable _origins;
    RemoteQueues _remote;
    HandlerWatch _slow{_workspace.GetClock()};
    // Calls the program's own handlers of data from other nodes. Null where the network is stepped.
    const std::unique_ptr<RabitHandlerThread> _handlers{
        _transport && !_transport->IsStepped() ? std::make_unique<RabitHandlerThread>(&_slow) : nullptr};
    LinkDriver _links;
    const std::shared_ptr<OutgoingQueues> _outgoing;
    const std::uint64_t _incarnation;
    const SourceClock _source;
    Presence _presence;
    Subscriptions _subscriptions;
    StateExchange _states;
    ForeignTopics _foreign{_config, _source, Handlers()};
    std::shared_ptr<Gateway::Fleet> _fleet;
    LinkStrains _strains;
    Exploration &_exploration;
    std::optional<Duration> _exploredAt;
    const std::string _logName = LogNameOf(_config, _workspace);
    const std::string _fleetName = FleetMessageNameOf(_config);
    ProblemLog _problemLog{_fleetName};
    ProblemLog::Standing _lasted;
    ProblemTexts _problemTexts{_config.Tool.has_value()};  // of the others
    const OwnLog _log{_logName + "node " + _config.Node + ", " + Whereabouts::OfThisProcess()};
    bool _forwards = false;
    Duration _nextFleet{0};
    Duration _earliestFleet{0};
    Duration _openedAt{0};
    std::optional<std::time_t> _keysEndAt;
    std::unique_ptr<TransportSession> _session;
    std::deque<TopicPublisher> _publishers;
    TypeExchange _types{_config,
                        _presence,
                        _links,
                        _manager.WakeUpHandler(),
                        [this](const std::string &node, std::uint64_t definition,
                               TypeQuestions::Answer answer) { OnText(node, definition, std::move(answer)); },
                        [this](NodeReports::Name name) { return ReportOf(name); }};
    AirTraffic _air{_config, _workspace.GetClock(), _presence, _links, _publishers, _types};
};

GatewayManager::GatewayManager(const GatewayConfig &config, std::shared_ptr<Transport> transport)
    : GatewayManager(config, std::move(transport), *RabitWorkspace::GetWorkspace())
{
}

GatewayManager::GatewayManager(const GatewayConfig &config, std::shared_ptr<Transport> transport,
                               RabitWorkspace &workspace, RandomSource random)
    : RabitManager(config.Name, workspace),
      _config(config),
      _transport(std::move(transport)),
      _random(std::move(random)),
      _exploration(std::make_unique<Exploration>(WakeUpHandler())),
      _parts(std::make_unique<Parts>(_config, _transport, *this, _random, *_exploration))
{
}

GatewayManager::~GatewayManager() = default;

FleetExplorer &GatewayManager::Explorer()
{
    _exploration->BeWanted();
    return *_exploration;
}

void GatewayManager::Startup()
{
    if (!_parts || !_parts->IsOpen())
    {
        _parts.reset();
        _parts = std::make_unique<Parts>(_config, _transport, *this, _random, *_exploration);
    }
}

void GatewayManager::ExecuteUnitOfWork()
{
    const std::uint64_t asked = _exploration->BeginTurn();
    const Duration next = _parts->Service();
    _exploration->EndTurn(asked);
    const Duration sleep = std::max(next - _parts->Now(), ShortestSleep);
    SetWakeupTimeDelaySec(std::chrono::duration<double>(sleep).count());
}

void GatewayManager::Shutdown()
{
    if (_parts)
    {
        _parts->Close();
    }
}

}  // namespace Rabit
