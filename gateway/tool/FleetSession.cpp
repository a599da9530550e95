#include "FleetSession.h"

#include <rabit/RabitLog.h>
#include <rabit/base/NaturalOrder.h>
#include <rabit/gateway/ConfigError.h>
#include <rabit/gateway/GatewayManager.h>
#include <rabit/transport/TransportFactory.h>

#include <algorithm>

#include "Offers.h"
#include "Output.h"
#include "RosNodes.h"
#include "SafeText.h"
#include "doctor/MachineChecks.h"
#include "doctor/NetworkChecks.h"
#include "doctor/NetworkTrial.h"

namespace Rabit::Tool
{

namespace
{

// Seconds in which nodes that do not save on beats are heard.
constexpr double Everybody = 1.5;
// Seconds in which NetworkTrial calls nodes with keys, and they answer.
constexpr double AnswersToCalls = 2.2;
// Seconds that are added for answers: a node may be answering others.
constexpr double Answers = 3.0;

// Two nodes of one name disturb each other, and so does a tool with the name of a node. With keys the name is
// bound to a certificate that no node has.
void CheckOwnName(const GatewayConfig &config, const CommonOptions &options, Wakeup &wakeup)
{
    if (!config.Tool || SomePathHasKeys(config) || config.Node != options.Node.Node)
    {
        return;
    }
    CommonOptions listening = options;
    listening.Node.Node.clear();
    GatewayConfig listener = config;
    listener.Node = ConfigOf(listening).Node;
    listener.Tool->AsksOf = {listener.Node};
    FleetSession session(listener, listening, wakeup);
    const auto isTaken = [&] { return !session.TakenOf({config.Node}).empty(); };
    bool isFree = !session.WaitUntil(std::min(Everybody, options.Wait), isTaken);
    isFree = isFree && !session.WaitUntil(
                           std::min(Offers::SecondsToHearEverybody(session.Nodes()), options.Wait), isTaken);
    if (!isFree)
    {
        throw std::runtime_error(NameIsTaken(config.Node));
    }
}

}  // namespace

FleetSession::FleetSession(const GatewayConfig &config, const CommonOptions &options, Wakeup &wakeup,
                           const std::function<void(FleetSession &)> &prepare)
    : _config(config), _options(options), _wakeup(wakeup)
{
    CheckOwnName(config, options, wakeup);
    _start = std::chrono::steady_clock::now();
    // The commands themselves report the gateway's warnings where they matter, so these are logged only with
    // --verbose.
    RabitLog::SetLevel(options.Verbose ? RabitLogLevel::Warning : RabitLogLevel::Error);
    if (prepare)
    {
        prepare(*this);
    }
    try
    {
        auto gateway =
            std::make_unique<GatewayManager>(config, TransportsOf(config, MakeTransport), _workspace);
        _explorer = &gateway->Explorer();
        _reactor.AddManager(std::move(gateway));
    }
    catch (const JoinError &error)
    {
        const bool isOfFiles = error.Setting() == "security" || error.Setting() == "backend_config";
        throw NetworkError(error.what(), !isOfFiles);
    }
    _explorer->SetOnChange([this] { _wakeup.Notify(); });
    _workspace.AddPublishSubscribeMessage(FleetMessageNameOf(config), _fleet);
    _fleet->GetGlobalPublishSubscribeMessageRef()->ConnectSomethingPublished(
        RabitQuickHandler([this] { _wakeup.Notify(); }));
    _reactor.SetHandleSignals(false);
    _runner = std::thread([this] { _reactor.Run(); });
}

FleetSession::~FleetSession()
{
    _reactor.ShutdownAllManagers();
    _runner.join();
}

std::vector<FleetSession::Node> FleetSession::Nodes() const
{
    std::vector<Node> nodes = _explorer->Nodes();
    std::sort(nodes.begin(), nodes.end(),
              [](const Node &one, const Node &other) { return NaturalOrder()(one.Name, other.Name); });
    return nodes;
}

Gateway::Fleet FleetSession::Fleet() const
{
    _fleet->FetchMessage();
    Gateway::Fleet fleet = *_fleet;
    std::sort(fleet.nodes.begin(), fleet.nodes.end(),
              [](const Gateway::NodeStatus &one, const Gateway::NodeStatus &other)
              { return NaturalOrder()(one.node, other.node); });
    std::erase_if(fleet.problems,
                  [](const Gateway::Problem &problem) { return problem.subject == RosNodes::Problem; });
    return fleet;
}

bool FleetSession::WaitUntil(double seconds, const std::function<bool()> &holds)
{
    const auto length = std::chrono::duration<double>(seconds);
    return _wakeup.WaitUntil(_start + std::chrono::duration_cast<std::chrono::steady_clock::duration>(length),
                             holds);
}

bool FleetSession::WaitForOffers(const std::string &pattern, const std::function<bool()> &holds)
{
    // With --wait the user asks to wait for nodes that are yet to come.
    const bool mayCome = _options.IsWaitGiven;
    WaitUntilDecided(
        [&] { return holds() || Offers::AreAllThere(Nodes(), pattern, !mayCome && IsEverybodyHeard()); });
    return holds();
}

bool FleetSession::WaitUntilDecided(const std::function<bool()> &isDecided)
{
    // The nodes that are heard meanwhile may announce longer periods.
    bool hasEnded = false;
    for (double until = 0.0; !hasEnded && until < _options.Wait;)
    {
        const double everybody = Offers::SecondsToHearEverybody(Nodes());
        until = everybody > until ? std::min(everybody, _options.Wait) : _options.Wait;
        hasEnded = WaitUntil(until, isDecided);
    }
    return hasEnded;
}

void FleetSession::WaitForEverybody(const std::function<bool()> &isWhole)
{
    const auto ends = [&] { return IsAnybodyThere() && isWhole(); };
    WaitUntil(_options.IsWaitGiven ? std::min(Everybody, _options.Wait) : Everybody,
              [&] { return !_options.IsWaitGiven && IsFleetKnown() && ends(); });
    if (!WaitUntil(_options.Wait, ends) && !_options.IsWaitGiven && IsAnybodyThere())
    {
        WaitUntil(std::max(Seconds(), _options.Wait) + Answers, ends);
    }
}

bool FleetSession::IsEverybodyHeard() const
{
    return Seconds() >= Offers::SecondsToHearEverybody(Nodes()) || IsFleetKnown();
}

bool FleetSession::IsFleetKnown() const
{
    return Offers::DoAllHearTheSame(Nodes());
}

std::string FleetSession::NoSuchNode(const std::string &pattern) const
{
    return Offers::NoSuchNode(pattern, Nodes(), Seconds());
}

std::string FleetSession::TakenOf(const std::vector<std::string> &names) const
{
    std::vector<std::string> there = _explorer->Tools();
    for (const Node &node : Nodes())
    {
        if (node.State != Gateway::NodeState::LOST)
        {
            there.push_back(node.Name);
        }
    }
    const auto taken = std::find_first_of(names.begin(), names.end(), there.begin(), there.end());
    return taken == names.end() ? "" : *taken;
}

std::string NameIsTaken(const std::string &name)
{
    return "there is a node `" + name + "`; two of one name would disturb each other";
}

std::map<std::string, FleetExplorer::Subscribers> FleetSession::SubscribersOf(
    const std::vector<std::string> &messages)
{
    constexpr double limit = 2.0;  // the gateway answers at once, unless something is wrong with it
    _explorer->LookForSubscribers(messages);
    WaitUntil(Seconds() + limit, [this] { return _explorer->FoundSubscribers().has_value(); });
    auto found = _explorer->FoundSubscribers().value_or(std::map<std::string, FleetExplorer::Subscribers>());
    for (auto &[message, subscribers] : found)
    {
        std::sort(subscribers.Nodes.begin(), subscribers.Nodes.end(), NaturalOrder());
    }
    return found;
}

double FleetSession::Seconds() const
{
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - _start).count();
}

// Reports nodes with keys: they answer no tool without keys of the fleet, but everybody can hear that there
// are some.
void FleetSession::TellOfKeys()
{
    try
    {
        const std::vector<Doctor::Interface> used =
            Doctor::UsedBy(_config, Doctor::LookAtMachine().Interfaces);
        const Doctor::NetworkTrial trial(used, {}, _config.Node, {_config.Domain}, {_config.Domain},
                                         Doctor::OwnSealedSessions(_config));
        WaitUntil(Seconds() + AnswersToCalls, [this] { return _wakeup.IsInterrupted(); });
        for (const Doctor::Finding &finding : Doctor::OfKeys(_config, used, trial.Facts(), IsAnybodyThere()))
        {
            Output::Talk(SafeText(finding.Text + " (" + finding.Advice + ")"));
        }
    }
    catch (const NetworkError &)
    {
        // Nothing is known about keys.
    }
}

bool FleetSession::IsTwice() const
{
    const auto problems = Fleet().problems;
    return std::any_of(problems.begin(), problems.end(),
                       [this](const Gateway::Problem &problem)
                       { return problem.subject == "node " + _config.Node; });
}

void FleetSession::TellProblems() const
{
    for (const Gateway::Problem &problem : Fleet().problems)
    {
        Output::Talk(problem.subject + ": " + problem.reason);
    }
}

int FleetSession::NobodyThere()
{
    Output::Talk("nobody was heard in domain " + std::to_string(_config.Domain) + " over " +
                 _config.Transport +
                 "; `rabit doctor` finds the reason (--domain, --interface, --wait; "
                 "docs/how_to/connect.md)");
    TellProblems();
    TellOfKeys();
    return NoNetwork;
}

const FleetSession::Node *FindNode(const std::vector<FleetSession::Node> &nodes, const std::string &node)
{
    const auto found = std::find_if(nodes.begin(), nodes.end(),
                                    [&node](const FleetSession::Node &one) { return one.Name == node; });
    return found == nodes.end() ? nullptr : &*found;
}

}  // namespace Rabit::Tool
