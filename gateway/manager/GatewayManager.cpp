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
#include "manager/Exploration.h"
#include "manager/GatewayPath.h"
#include "manager/TransportSettingsOf.h"
#include "mirrors/Subscriptions.h"
#include "names/NamePattern.h"
#include "paths/PathChoice.h"
#include "paths/PeersOverPaths.h"
#include "presence/OriginTable.h"
#include "presence/RemoteQueues.h"
#include "presence/Whereabouts.h"
#include "queues/LinkDriver.h"
#include "queues/OutgoingQueues.h"
#include "report/Diagnosis.h"
#include "report/FleetReport.h"
#include "report/HandlerWatch.h"
#include "report/LinkStrains.h"
#include "report/OtherGateways.h"
#include "report/OwnLog.h"
#include "report/PathReport.h"
#include "report/ProblemLog.h"
#include "report/ProblemTexts.h"
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

std::vector<std::shared_ptr<Transport>> Checked(std::vector<std::shared_ptr<Transport>> transports,
                                                std::size_t paths)
{
    if (transports.size() != paths ||
        std::find(transports.begin(), transports.end(), nullptr) != transports.end())
    {
        throw std::invalid_argument("GatewayManager needs a transport for each path");
    }
    return transports;
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
    Parts(const GatewayConfig &config, const std::vector<std::shared_ptr<Transport>> &transports,
          GatewayManager &manager, const RandomSource &random, Exploration &exploration)
        : Parts(Closed(), config, transports, manager, random, exploration)
    {
        Open();
    }

    ~Parts()
    {
        _exploration.SetLinks(nullptr);
        Close();
    }

    bool IsOpen() const { return _isOpen; }

    // Leaves the network, for good.
    void Close()
    {
        if (!std::exchange(_isOpen, false))
        {
            return;
        }
        if (std::exchange(_forwards, false))
        {
            _workspace.RemoveQueueForwarder(_config.Name);
        }
        ReportUndelivered();
        for (const auto &path : _paths)
        {
            path->SayGoodbye();
        }
        _subscriptions.Close();
        _foreign.Close();
        _links.Close();
        for (const auto &path : _paths)
        {
            path->Close();
        }
        if (_handlers)
        {
            _handlers->Stop();
        }
    }

    // Returns when to be called again at the latest.
    Duration Service()
    {
        const Duration now = Now();
        Heard change;
        for (std::size_t path = 0; path < _paths.size(); ++path)
        {
            const PeerTable::Change &heard = _paths[path]->TakeIn(now).Change;
            if (heard.Any())
            {
                TakeIn(path, heard, change, now);
            }
        }
        if (_paths.size() > 1)
        {
            ChoosePaths(change, now);
        }
        if (change.Offers || change.NewLife)
        {
            MatchSubscriptions();
        }
        if (_exploration.IsWanted())
        {
            Explore(change, now);
        }
        Duration next = _foreign.Service(now);
        for (const auto &path : _paths)
        {
            next = std::min(next, path->Send(now));
        }
        if (_paths.size() > 1)
        {
            next = std::min(next, _choice.Due().value_or(next));
            _links.WillServe(next);
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
    // The changes that all paths together have heard of in a turn.
    struct Heard
    {
        bool State = false;
        bool NewLife = false;
        bool Offers = false;
    };

    Parts(Closed /*tag*/, const GatewayConfig &config,
          const std::vector<std::shared_ptr<Transport>> &transports, GatewayManager &manager,
          const RandomSource &random, Exploration &exploration)
        : _config(Validated(config)),
          _manager(manager),
          _workspace(manager.GetWorkspace()),
          _isStepped(transports.front()->IsStepped()),
          _incarnations(
              config.StateDir, CounterName(config),
              [this] { return GpsTime::ToUtcNanoseconds(_workspace.GetClock().GpsTimeSeconds()); }, random),
          _remote(config.Node),
          _links(_config, _workspace, _incarnations, random(), manager.WakeUpHandler(), Handlers()),
          _outgoing(std::make_shared<OutgoingQueues>(_config.Node, _workspace, _remote, _links, _config.Tap)),
          _incarnation(_links.Incarnation()),
          _source(_workspace.GetClock()),
          _subscriptions(_config.Subscribe, _origins, _workspace, Handlers(), _config.Tap),
          _choice(transports.size()),
          _fleet(std::make_shared<Gateway::Fleet>()),
          _exploration(exploration)
    {
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
        _exploration.SetLinks(
            [this](const std::string &node, const std::string &queue, std::chrono::milliseconds expire)
            { _links.SetExpiry(node, queue, expire); });
        MakePaths(transports, random);
    }

    void MakePaths(const std::vector<std::shared_ptr<Transport>> &transports, const RandomSource &random)
    {
        const GatewayPath::Shared shared{
            .Manager = _manager,
            .WakeUp = _manager.WakeUpHandler(),
            .Workspace = _workspace,
            .Incarnation = _incarnation,
            .Source = _source,
            .Origins = _origins,
            .Remote = _remote,
            .Links = _links,
            .Subscribed = _subscriptions,
            .Choice = _choice,
            .Random = random,
            .IsNeeded = [this](const std::string &node) { return IsNeeded(node); },
            .OnText = [this](const std::string &node, std::uint64_t definition, TypeQuestions::Answer answer)
            { OnText(node, definition, std::move(answer)); },
            .ReportOf = [this](NodeReports::Name name) { return ReportOf(name); }};
        const std::vector<GatewayConfig> configs = PathConfigsOf(_config);
        _subscriptions.SetSessions(configs.size());
        std::vector<const PeerTable *> tables;
        for (std::size_t path = 0; path < configs.size(); ++path)
        {
            _paths.push_back(std::make_unique<GatewayPath>(configs[path], transports[path], path, shared));
            tables.push_back(&_paths.back()->Beats().Peers());
        }
        _peers.emplace(std::move(tables), _choice);
        if (_paths.size() > 1)
        {
            _links.SetSecondPath({.Choose =
                                      [this](std::string_view node, std::string_view queue, std::size_t bytes)
                                  {
                                      const std::optional<std::size_t> second =
                                          _choice.Second(node, Now(), queue.empty());
                                      return second && _paths[*second]->MayTakeCopy(node, queue, bytes)
                                                 ? second
                                                 : std::nullopt;
                                  },
                                  .Sent = [this](std::size_t path) { _paths[path]->CopySent(); }});
        }
    }

    // Takes in the changes that a path has heard of.
    void TakeIn(std::size_t path, const PeerTable::Change &heard, Heard &change, Duration now)
    {
        Presence &beats = _paths[path]->Beats();
        for (const std::string &node : heard.Forgotten)
        {
            Forget(node, path, now);
        }
        if (_paths.size() > 1 && heard.Missed)
        {
            for (const PeerTable::Peer *peer : beats.Peers().Heard())
            {
                _choice.Missed(peer->Node, path, peer->Beats, now);
            }
        }
        if (_paths.size() > 1 && (heard.State || heard.NewLife || heard.Offers))
        {
            for (const PeerTable::Peer *peer : beats.Peers().Heard())
            {
                _choice.Heard(peer->Node, path, peer->State, peer->HearsHereFirst, now);
                ShareOffers(*peer, beats, change);
            }
        }
        if (_paths.size() > 1)
        {
            for (const std::string &tool : beats.Peers().HeardTools())
            {
                _choice.Heard(tool, path, Gateway::NodeState::UP, false, now);
            }
        }
        if (heard.NewLife)
        {
            for (const PeerTable::Peer *peer : beats.Peers().Heard())
            {
                _links.HeardOf(peer->Node, peer->Incarnation);
            }
        }
        change.State |= heard.State;
        change.Offers |= heard.Offers;
        change.NewLife |= heard.NewLife;
    }

    // An announcement that has come by one path need not come by the others.
    void ShareOffers(const PeerTable::Peer &peer, Presence &beats, Heard &change)
    {
        for (const auto &path : _paths)
        {
            const PeerTable::Peer *const other = path->Beats().Peers().Find(peer.Node);
            if (other != nullptr && other != &peer)
            {
                const bool isNew = path->Beats().Adopt(peer) || beats.Adopt(*other);
                change.Offers |= isNew;
            }
        }
    }

    void Forget(const std::string &node, std::size_t path, Duration now)
    {
        const bool isKnownElsewhere =
            std::any_of(_paths.begin(), _paths.end(),
                        [&node](const auto &other) { return other->Beats().Peers().Find(node) != nullptr; });
        if (isKnownElsewhere)
        {
            _choice.Heard(node, path, Gateway::NodeState::LOST, false, now);
            return;
        }
        _choice.Forget(node);
        _subscriptions.Forget(node);
        _links.Forget(node);
        _outgoing->Forget(node);
    }

    void ChoosePaths(Heard &change, Duration now)
    {
        for (const auto &[node, came] : _links.TakeCameBy())
        {
            for (std::size_t path = 0; path < _paths.size(); ++path)
            {
                if ((came.First >> path & 1) != 0)
                {
                    _choice.CameBy(node, path, now);
                }
                if ((came.Messages >> path & 1) != 0)
                {
                    _choice.MessageCameBy(node, path, now);
                }
            }
        }
        for (const std::string &node : _links.Unanswered())
        {
            if (_choice.Unanswered(node, now))
            {
                _links.ProbeNow(node);
            }
        }
        for (const std::string &node : _choice.TakeChanged(now))
        {
            GatewayPath &path = *_paths[_choice.Of(node)];
            path.Beats().Publish(node);
            path.SubscriptionsAdded(now);
            _links.PathChanged(node);
            change.State = change.Offers = true;
        }
        const bool tellsHeard = _choice.TakeFirstHeardChanged() || change.NewLife;
        for (std::size_t path = 1; path < _paths.size() && tellsHeard; ++path)
        {
            _paths[path]->Beats().SetFirstHeard(_choice.FirstHeardOn(path));
        }
    }

    // Compares the announcements with the subscriptions.
    void MatchSubscriptions()
    {
        for (const PeerTable::Peer *peer : _subscriptions.OnOffers(*_peers))
        {
            for (const auto &path : _paths)
            {
                path->SetWanted(*peer, _subscriptions.StatesWanted(*peer));
            }
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
        _isOpen = true;
        _openedAt = Now();
        // Cyclone DDS checks keys only in the first session of a process.
        for (const bool withKeys : {true, false})
        {
            for (const auto &path : _paths)
            {
                if (path->HasKeys() == withKeys)
                {
                    path->Join();
                }
            }
        }
        for (const auto &path : _paths)
        {
            path->Open();
        }
        // Programs that are no nodes have no beats that tell by which path they are reached.
        _foreign.Open(_paths.front()->Session(), _manager, _openedAt);
        for (const auto &path : _paths)
        {
            path->Begin();
        }
        _forwards = _workspace.AddQueueForwarder(_config.Name, _outgoing);
        if (!_forwards)
        {
            throw NameTaken();
        }
    }

    void SetExplored(Duration now)
    {
        _exploredAt = now;
        _exploration.SetNodes(*_peers, _problemTexts, _workspace.GetClock().Now());
    }

    // Serves the requests of FleetExplorer.
    void Explore(const Heard &change, Duration now)
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
            const PeerTable::Peer *peer = _peers->Find(wanted.Node);
            if (peer != nullptr && peer->State != Gateway::NodeState::LOST)
            {
                static_cast<void>(PathOf(wanted.Node).Types().Want(wanted, now));
            }
        }
        bool any = false;
        for (const SubscribeRule &rule : requests.Subscriptions)
        {
            try
            {
                any |= _subscriptions.Add(rule);
            }
            catch (const TransportError &error)
            {
                Log({"subscribe " + rule.Message + ": " + error.what()});
            }
        }
        if (any)
        {
            MatchSubscriptions();
            for (const auto &path : _paths)
            {
                path->SubscriptionsAdded(now);
            }
        }
        if (requests.LookedFor)
        {
            std::vector<const TransportSession *> sessions;
            for (const auto &path : _paths)
            {
                sessions.push_back(&path->Session());
            }
            _exploration.FindSubscribers(*requests.LookedFor, sessions);
        }
    }

    RabitHandlerThread *Handlers() const { return _handlers.get(); }
    GatewayPath &PathOf(const std::string &node) { return *_paths[_choice.Of(node)]; }

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
        for (const PeerTable::Peer *peer : _peers->Heard())
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
        ReportPublications(fleet);
        fleet.links = _outgoing->Status();
        fleet.inbound = _links.InboundStatus();
        fleet.forgotten = _peers->Forgotten();
        fleet.crowded_out = _peers->CrowdedOut() + _subscriptions.CrowdedOut() + _links.CrowdedOut();
        fleet.malformed = _links.Malformed();
        FleetReport::FillNodes(*_peers, now, fleet);
        _problemTexts.Fill(*_peers, fleet);
        for (const auto &path : _paths)
        {
            fleet.malformed += path->Beats().Malformed() + path->Types().Malformed();
        }
        ReportAir(fleet, now);
        FleetReport::AddNameProblems(*_peers, fleet);
        AddProblems(now, fleet);
        _foreign.Report(now, fleet);
        OtherGateways::AddSharedNodes(_workspace, _config.Name, fleet);
        const std::vector<LinkStrain> strains = _strains.Look(fleet, *_peers, now);
        for (const auto &path : _paths)
        {
            path->Beats().SetStrains(strains);
        }
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
        for (const auto &path : _paths)
        {
            path->Beats().SetProblems(_config.Tool ? ProblemCount() : ProblemCount{count, _lasted.Digest});
        }
        for (const PeerTable::Peer *peer : _peers->Heard())
        {
            const TypeQuestions::Wanted problems{peer->Node, "",
                                                 NodeReports::NameOf(NodeReports::Kind::Problems)};
            if (!_problemTexts.Lacks(*peer))
            {
                PathOf(peer->Node).Beats().TypesLacking().LetGo(problems);
            }
            else if (MatchesAny(_config.ProblemsOf, peer->Node))
            {
                // If too many texts are wanted, the next post asks again.
                static_cast<void>(PathOf(peer->Node).Types().Want(problems, now));
            }
        }
    }

    void ReportPublications(Gateway::Fleet &fleet) const
    {
        for (const TopicPublisher &publisher : _paths.front()->Publishers())
        {
            fleet.publications.push_back(publisher.Status());
        }
        for (std::size_t path = 1; path < _paths.size(); ++path)
        {
            for (std::size_t i = 0; i < fleet.publications.size(); ++i)
            {
                PathReport::Add(_paths[path]->Publishers()[i].Status(), fleet.publications[i]);
            }
        }
    }

    void ReportAir(Gateway::Fleet &fleet, Duration now)
    {
        if (_paths.size() == 1)
        {
            fleet.air = _paths.front()->Report(fleet, now);
            return;
        }
        std::vector<std::string> names;
        for (const auto &path : _paths)
        {
            names.push_back(path->Name());
            Gateway::PathStatus &status = fleet.paths.emplace_back();
            status.path = path->Name();
            status.air = path->Report(fleet, now);
            PathReport::Add(status.air, fleet.air);
        }
        PathReport::FillNodes(*_peers, _choice, names, now, fleet);
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
            if (const PeerTable::Peer *peer = _peers->Find(node))
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
        for (const auto &path : _paths)
        {
            path->AddProblems(fleet, now);
        }
        for (const TopicPublisher &publisher : _paths.front()->Publishers())
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
              Diagnosis::OfSubscriptions(_subscriptions, *_peers, now - _openedAt, now),
              _outgoing->Problems(), _links.Problems(), _slow.Problems(now)})
        {
            fleet.problems.insert(fleet.problems.end(), problems.begin(), problems.end());
        }
    }

    const GatewayConfig &_config;  // the manager's
    GatewayManager &_manager;
    RabitWorkspace &_workspace;
    const bool _isStepped;
    IncarnationStore _incarnations;
    OriginTable _origins;
    RemoteQueues _remote;
    HandlerWatch _slow{_workspace.GetClock()};
    // Calls the program's own handlers of data from other nodes. Null where the network is stepped.
    const std::unique_ptr<RabitHandlerThread> _handlers{
        !_isStepped ? std::make_unique<RabitHandlerThread>(&_slow) : nullptr};
    LinkDriver _links;
    const std::shared_ptr<OutgoingQueues> _outgoing;
    const std::uint64_t _incarnation;
    const SourceClock _source;
    Subscriptions _subscriptions;
    PathChoice _choice;
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
    bool _isOpen = false;
    std::vector<std::unique_ptr<GatewayPath>> _paths;
    std::optional<PeersOverPaths> _peers;
};

std::vector<std::shared_ptr<Transport>> TransportsOf(
    const GatewayConfig &config,
    const std::function<std::shared_ptr<Transport>(const std::string &name)> &make)
{
    std::vector<std::shared_ptr<Transport>> transports;
    for (const GatewayConfig &path : PathConfigsOf(config))
    {
        transports.push_back(make(path.Transport));
    }
    return transports;
}

GatewayManager::GatewayManager(const GatewayConfig &config, std::shared_ptr<Transport> transport)
    : GatewayManager(config, std::move(transport), *RabitWorkspace::GetWorkspace())
{
}

GatewayManager::GatewayManager(const GatewayConfig &config, std::shared_ptr<Transport> transport,
                               RabitWorkspace &workspace, RandomSource random)
    : GatewayManager(config,
                     std::vector<std::shared_ptr<Transport>>(std::max<std::size_t>(config.Paths.size(), 1),
                                                             std::move(transport)),
                     workspace, std::move(random))
{
}

GatewayManager::GatewayManager(const GatewayConfig &config,
                               std::vector<std::shared_ptr<Transport>> transports, RabitWorkspace &workspace,
                               RandomSource random)
    : RabitManager(config.Name, workspace),
      _config(config),
      _transports(Checked(std::move(transports), std::max<std::size_t>(config.Paths.size(), 1))),
      _random(std::move(random)),
      _exploration(std::make_unique<Exploration>(WakeUpHandler())),
      _parts(std::make_unique<Parts>(_config, _transports, *this, _random, *_exploration))
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
    _exploration->SetServed(true);
    if (!_parts || !_parts->IsOpen())
    {
        _parts.reset();
        _parts = std::make_unique<Parts>(_config, _transports, *this, _random, *_exploration);
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
    _exploration->SetServed(false);
    if (_parts)
    {
        _parts->Close();
    }
}

}  // namespace Rabit
