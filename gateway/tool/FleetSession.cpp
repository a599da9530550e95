#include "FleetSession.h"

#include <rabit/RabitLog.h>
#include <rabit/base/NaturalOrder.h>
#include <rabit/gateway/ConfigError.h>
#include <rabit/gateway/GatewayManager.h>
#include <rabit/transport/TransportFactory.h>

#include <algorithm>
#include <iterator>
#include <set>

#include "Offers.h"
#include "Output.h"
#include "SafeText.h"
#include "doctor/MachineChecks.h"
#include "doctor/NetworkChecks.h"
#include "doctor/NetworkTrial.h"
#include "names/ListedNames.h"

namespace Rabit::Tool
{

namespace
{

// Seconds in which nodes that do not save on beats are heard.
constexpr double Everybody = 1.5;
// Seconds in which nodes without a budget announce themselves twice to a newcomer. With keys a node is heard
// only once it is authenticated, but its announcements come before.
constexpr double TwoAnnouncements = 2.2;
// Seconds that are added for handshakes: on a busy computer one takes seconds, and they go one after another.
constexpr double Handshakes = 15.0;
// Seconds that are added for answers: a node may be answering others.
constexpr double Answers = 3.0;

// Two nodes of one name disturb each other, and so does a tool with the name of a node. With keys the name is
// bound to a certificate that no node has.
void CheckOwnName(const GatewayConfig &config, const CommonOptions &options, Wakeup &wakeup)
{
    if (!config.Tool || config.Security || config.Node != options.Node.Node)
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

FleetSession::FleetSession(const GatewayConfig &config, const CommonOptions &options, Wakeup &wakeup)
    : _config(config), _options(options), _wakeup(wakeup)
{
    CheckOwnName(config, options, wakeup);
    _start = std::chrono::steady_clock::now();
    if (config.Security)
    {
        _announcements = Listen({});
    }
    // The commands themselves report the gateway's warnings where they matter, so these are logged only with
    // --verbose.
    RabitLog::SetLevel(options.Verbose ? RabitLogLevel::Warning : RabitLogLevel::Error);
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
    for (double until = 0.0; !hasEnded && until < Patience();)
    {
        const double everybody = SecondsToHearEverybody();
        until = everybody > until ? std::min(everybody, Patience()) : Patience();
        hasEnded = WaitUntil(until, isDecided);
        if (Seconds() >= _options.Wait && Underway().empty() && !IsAnybodyThere())
        {
            break;
        }
    }
    return hasEnded;
}

void FleetSession::WaitForEverybody(const std::function<bool()> &isWhole)
{
    const auto ends = [&] { return Underway().empty() && IsAnybodyThere() && isWhole(); };
    const double least = _announcements ? TwoAnnouncements : Everybody;
    WaitUntil(_options.IsWaitGiven ? std::min(least, _options.Wait) : least,
              [&] { return !_options.IsWaitGiven && IsFleetKnown() && ends(); });
    if (WaitUntil(_options.Wait, ends) || _options.IsWaitGiven)
    {
        return;
    }
    WaitUntil(Patience(), [&] { return Underway().empty(); });
    if (IsAnybodyThere())
    {
        // The busy computer of a handshake is also slow to answer.
        const double longer = _announcements ? 3.0 * Answers : Answers;
        WaitUntil(std::max(Seconds(), _options.Wait) + longer, ends);
    }
}

double FleetSession::Patience() const
{
    return _options.Wait + (_announcements && !_options.IsWaitGiven ? Handshakes : 0.0);
}

double FleetSession::SecondsToHearEverybody() const
{
    return std::max(Offers::SecondsToHearEverybody(Nodes()), _announcements ? TwoAnnouncements : 0.0);
}

bool FleetSession::IsEverybodyHeard() const
{
    return (Seconds() >= SecondsToHearEverybody() || IsFleetKnown()) && Underway().empty();
}

bool FleetSession::IsFleetKnown() const
{
    return !_announcements && Offers::DoAllHearTheSame(Nodes());
}

std::vector<std::string> FleetSession::Underway() const
{
    if (!_announcements)
    {
        return {};
    }
    const std::set<std::string> names = Doctor::NodesWithKeys(_config.Domain, _announcements->Facts());
    const std::set<std::string> heard = Heard();
    std::vector<std::string> underway;
    std::set_difference(names.begin(), names.end(), heard.begin(), heard.end(), std::back_inserter(underway));
    std::sort(underway.begin(), underway.end(), NaturalOrder());
    return underway;
}

std::set<std::string> FleetSession::Heard() const
{
    const std::vector<std::string> tools = _explorer->Tools();
    std::set<std::string> names(tools.begin(), tools.end());
    for (const Node &node : Nodes())
    {
        names.insert(node.Name);
    }
    return names;
}

bool FleetSession::TellOfUnderway() const
{
    const std::vector<std::string> names = Underway();
    if (names.empty())
    {
        return false;
    }
    Output::Talk(std::to_string(names.size()) +
                 (names.size() == 1 ? " participant is" : " participants are") +
                 " still being authenticated, or not let in: " + ListedNames(names) +
                 "; ask again, or give a longer --wait");
    return true;
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

std::unique_ptr<Doctor::NetworkTrial> FleetSession::Listen(const std::vector<int> &callIn) const
{
    return std::make_unique<Doctor::NetworkTrial>(Doctor::UsedBy(_config, Doctor::LookAtMachine().Interfaces),
                                                  std::vector<Doctor::Interface>(), _config.Node, callIn,
                                                  std::vector<int>{_config.Domain});
}

// Reports nodes with keys: such a fleet does not answer a tool without keys, but everybody can hear its
// announcements.
void FleetSession::TellOfKeys()
{
    try
    {
        const std::unique_ptr<Doctor::NetworkTrial> trial = Listen({_config.Domain});
        WaitUntil(Seconds() + TwoAnnouncements, [this] { return _wakeup.IsInterrupted(); });
        const std::vector<Doctor::Finding> findings = Doctor::OfKeys(_config, trial->Facts(), Heard());
        for (const Doctor::Finding &finding : findings)
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
