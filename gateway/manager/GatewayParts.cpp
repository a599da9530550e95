#include "manager/GatewayParts.h"

#include <rabit/gateway/GatewayTap.h>

#include <algorithm>
#include <filesystem>
#include <limits>
#include <span>
#include <utility>

#include "clocks/GpsTime.h"
#include "manager/TransportSettingsOf.h"

namespace Rabit
{
namespace
{

using Duration = std::chrono::nanoseconds;

constexpr Duration FleetPeriod = std::chrono::seconds(1);
// Least time between two posts of Gateway/Fleet: each post takes time for every node and row.
constexpr Duration ShortestFleetGap = std::chrono::milliseconds(100);

// Name of the file that counts the incarnations of this node. Two gateways of one node count separately.
std::string CounterName(const GatewayConfig &config)
{
    return config.Name == GatewayConfig().Name ? config.Node : config.Node + "@" + config.Name;
}

std::vector<double> BudgetsOf(const GatewayConfig &config)
{
    std::vector<double> budgets;
    for (const PathRule &path : config.Paths)
    {
        budgets.push_back(path.Radio.Budget.value_or(std::numeric_limits<double>::infinity()));
    }
    return budgets;
}

const GatewayConfig &Validated(const GatewayConfig &config)
{
    ValidateGatewayConfig(config);
    return config;
}

}  // namespace

// A program has one default workspace and so one node in it, the name
// of which RunNode gives to the log; a node in another workspace may be one of several in the process.
std::string GatewayManager::Parts::LogNameOf(const GatewayConfig &config, const RabitWorkspace &workspace)
{
    const bool isOneOfSeveral = !config.Tool && &workspace != &*RabitWorkspace::GetWorkspace();
    return (isOneOfSeveral ? config.Node + ": gateway" : "gateway") +
           (config.Name == GatewayConfig().Name ? ": " : " " + config.Name + ": ");
}

GatewayManager::Parts::Parts(const GatewayConfig &config,
                             const std::vector<std::shared_ptr<Transport>> &transports,
                             GatewayManager &manager, const RandomSource &random, Exploration &exploration)
    : Parts(Closed(), config, transports, manager, random, exploration)
{
    Open();
}

GatewayManager::Parts::~Parts()
{
    _exploration.SetLinks(nullptr);
    Close();
}

void GatewayManager::Parts::Close()
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
    if (_agreement)
    {
        _agreement->Leave();
    }
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

std::chrono::nanoseconds GatewayManager::Parts::Service()
{
    const Duration now = Now();
    Heard change;
    for (std::size_t path = 0; path < _paths.size(); ++path)
    {
        const Presence::Served &served = _paths[path]->TakeIn(now);
        if (served.Change.Any())
        {
            TakeIn(path, served.Change, change);
        }
        if (_agreement && served.Any())
        {
            TakeAgreements(served);
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
    if (_agreement)
    {
        next = std::min(next, _agreement->Serve(now));
    }
    for (const auto &path : _paths)
    {
        next = std::min(next, path->Send(now));
    }
    if (_paths.size() > 1)
    {
        next = std::min(next, _nextLook);
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

GatewayManager::Parts::Parts(Closed /*tag*/, const GatewayConfig &config,
                             const std::vector<std::shared_ptr<Transport>> &transports,
                             GatewayManager &manager, const RandomSource &random, Exploration &exploration)
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
      _choice(transports.size(), BudgetsOf(config)),
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
    if (_config.Agreement)
    {
        _agreement = MakeAgreement(random);
    }
    MakePaths(transports, random);
    // Last, since what is above may throw, and this object is then not destroyed in order.
    _exploration.SetLinks(
        [this](const std::string &node, const std::string &queue, std::chrono::milliseconds expire)
        { _links.SetExpiry(node, queue, expire); });
}

std::unique_ptr<AgreementDriver> GatewayManager::Parts::MakeAgreement(const RandomSource &random)
{
    std::filesystem::path fences = _incarnations.File();
    if (!fences.empty())
    {
        fences.replace_extension(".fence");
    }
    // If the program has no Claims, the copy gets what they share; the report needs it, too.
    GatewayConfig config = _config;
    _claims.emplace(config);
    return std::make_unique<AgreementDriver>(
        config, _workspace.GetClock(), _incarnation, std::move(fences), random, _manager.WakeUpHandler(),
        Handlers(),
        AgreementDriver::Network{
            .Send =
                [this](const std::string &node, std::span<const std::uint8_t> frame)
            {
                const std::size_t path = _choice.Of(node);
                _links.SendOther(path, node, frame);
                _paths[path]->SentPast();
            },
            .PathTo = [this](const std::string &node) { return _choice.Of(node); },
            .HasRoom = [this](const std::string &node, std::size_t bytes)
            { return _paths[_choice.Of(node)]->MayTakeCopy(node, "", bytes + LinkDriver::AboutTheHeaders); },
            .GroupOf =
                [this](const std::string &node)
            {
                const PeerTable::Peer *const peer = _peers->Find(node);
                const bool isHeard =
                    peer != nullptr && peer->Agreement && peer->State != Gateway::NodeState::LOST;
                return isHeard ? std::optional(peer->Agreement->Group) : std::nullopt;
            }});
}

void GatewayManager::Parts::TakeAgreements(const Presence::Served &served)
{
    for (const Presence::Served::Agreement &told : served.Agreements)
    {
        _agreement->OnBeat(told);
    }
    _agreement->LookAt(*_peers);
}

void GatewayManager::Parts::MatchSubscriptions()
{
    for (const PeerTable::Peer *peer : _subscriptions.OnOffers(*_peers))
    {
        for (const auto &path : _paths)
        {
            path->SetWanted(*peer, _subscriptions.StatesWanted(*peer));
        }
    }
}

void GatewayManager::Parts::Open()
{
    try
    {
        OpenSession();
    }
    catch (const TransportError &error)
    {
        const std::string setting = error.Setting().empty() ? "interfaces" : error.Setting();
        throw JoinError(_config.File, LineOfSetting(_config, setting), error.what(), error.Setting());
    }
}

void GatewayManager::Parts::OpenSession()
{
    _isOpen = true;
    _openedAt = Now();
    for (const auto &path : _paths)
    {
        path->Join();
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

void GatewayManager::Parts::SetExplored(Duration now)
{
    _exploredAt = now;
    _exploration.SetNodes(*_peers, _problemTexts, _workspace.GetClock().Now());
}

void GatewayManager::Parts::Explore(const Heard &change, Duration now)
{
    // Clocks and counts change with each beat.
    if (change.State || change.Offers || change.NewLife || !_exploredAt || now - *_exploredAt >= FleetPeriod)
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

ConfigError GatewayManager::Parts::NameTaken() const
{
    return {_config.File, LineOfSetting(_config, "name"),
            "there is a gateway `" + _config.Name +
                "` in this workspace already; each needs a `name` of its own"};
}

bool GatewayManager::Parts::IsNeeded(const std::string &node) const
{
    const auto names = [&node](const std::string &name) { return name == node; };
    return std::any_of(_config.Subscribe.begin(), _config.Subscribe.end(),
                       [&names](const SubscribeRule &rule)
                       { return std::any_of(rule.From.begin(), rule.From.end(), names); }) ||
           std::any_of(_config.Send.begin(), _config.Send.end(),
                       [&names](const SendRule &rule) { return names(rule.To); }) ||
           (_config.Agreement &&
            std::any_of(_config.Agreement->Members.begin(), _config.Agreement->Members.end(), names)) ||
           _links.HasPending(node);
}

}  // namespace Rabit
