// rabit send: sends queue messages, and reports their outcomes.
#include <rabit/RabitQueueReceipt.h>
#include <rabit/dynamic/DynamicMessage.h>
#include <rabit/idl/NearestWord.h>

#include <algorithm>
#include <memory>
#include <optional>

#include "Command.h"
#include "FleetSession.h"
#include "FleetType.h"
#include "InputLines.h"
#include "Offers.h"
#include "names/ListedNames.h"
#include "names/NamePattern.h"

namespace Rabit::Tool
{
namespace SendParts
{
namespace
{

struct Options
{
    CommonOptions Common;
    std::string Address;
    std::string Type;
    std::string Value;
    double Expire = 0.0;
};

struct Destination
{
    std::string Node;  // `*`: all
    std::string Queue;
};

std::optional<Destination> Split(const std::string &address)
{
    const std::size_t slash = address.find('/');
    if (slash == 0 || slash == std::string::npos || slash + 1 == address.size())
    {
        return std::nullopt;
    }
    return Destination{address.substr(0, slash), address.substr(slash + 1)};
}

const Gateway::AcceptedQueue *FindQueue(const FleetSession::Node &node, const std::string &queue)
{
    if (!node.Offers || node.State == Gateway::NodeState::LOST)
    {
        return nullptr;
    }
    const auto &all = node.Offers->accepts;
    const auto found =
        std::find_if(all.begin(), all.end(),
                     [&queue](const Gateway::AcceptedQueue &accepted) { return accepted.queue == queue; });
    return found == all.end() ? nullptr : &*found;
}

bool IsMeant(const Destination &to, const FleetSession::Node &node)
{
    return to.Node == "*" || to.Node == node.Name;
}

// A node that accepts the type in the queue, and its definition of the type.
struct Taker
{
    std::string Node;
    std::uint64_t Definition = 0;
};
std::vector<Taker> TakersOf(const Destination &to, const std::string &type,
                            const std::vector<FleetSession::Node> &nodes)
{
    std::vector<Taker> takers;
    for (const FleetSession::Node &node : nodes)
    {
        const Gateway::AcceptedQueue *queue = IsMeant(to, node) ? FindQueue(node, to.Queue) : nullptr;
        if (queue == nullptr)
        {
            continue;
        }
        for (const Gateway::QueueType &taken : queue->types)
        {
            if (taken.type == type)
            {
                takers.push_back({node.Name, taken.definition});
            }
        }
    }
    return takers;
}

// Says why no node takes the message, with the nearest right word.
std::string WhyNobody(const Destination &to, const std::string &type, const FleetSession &session)
{
    const std::vector<FleetSession::Node> nodes = session.Nodes();
    std::vector<std::string> queues;
    std::vector<std::string> types;
    bool any = false;
    bool anyQueue = false;
    for (const FleetSession::Node &node : nodes)
    {
        if (!IsMeant(to, node) || node.State == Gateway::NodeState::LOST)
        {
            continue;
        }
        any = true;
        if (!node.Offers)
        {
            return "no announcement of " + node.Name + " has come";
        }
        for (const Gateway::AcceptedQueue &accepted : node.Offers->accepts)
        {
            queues.push_back(accepted.queue);
        }
        if (const Gateway::AcceptedQueue *queue = FindQueue(node, to.Queue))
        {
            anyQueue = true;
            for (const Gateway::QueueType &taken : queue->types)
            {
                types.push_back(taken.type);
            }
        }
    }
    if (!any)
    {
        return session.NoSuchNode(to.Node);
    }
    if (!anyQueue)
    {
        return "`" + to.Node + "` accepts no queue `" + to.Queue + "`" + NearestWordHint(to.Queue, queues);
    }
    return "`" + to.Node + "/" + to.Queue + "` does not take `" + type + "`, but " + ListedNames(types) +
           NearestWordHint(type, types);
}

// True if the message can name a queue for the receiver's answer (`reply_to`, as with RabitRequests), and
// names none.
bool AsksNoAnswer(const DynamicMessage &message)
{
    const Json value = Json::parse(message.ToJson(), nullptr, false);
    const auto queue = value.find("reply_to");
    return queue != value.end() && queue->is_string() && queue->get<std::string>().empty();
}

// Sends one message and waits for its outcome.
class Sender
{
public:
    Sender(const Options &options, FleetSession &session, Wakeup &wakeup,
           std::shared_ptr<const DynamicType> type)
        : _options(options), _session(session), _wakeup(wakeup), _type(std::move(type))
    {
    }

    // Returns true if it was delivered.
    bool Send(const std::string &json)
    {
        auto message = std::make_shared<DynamicMessage>(_type);
        const std::string misfit = message->SetJson(json);
        if (!misfit.empty())
        {
            Output::Talk(misfit);
            return Tell("refused", misfit);
        }
        auto receipt = std::make_shared<RabitQueueReceipt>();
        if (!_session.Workspace().AddMessageToQueue(_options.Address, message, receipt))
        {
            const std::string reason = receipt->RefusalReason();
            Output::Talk("refused" + (reason.empty() ? "" : ": " + reason));
            return Tell("refused", reason);
        }
        RabitConnection settled = receipt->ConnectOutcomeKnown([this] { _session.Notify(); });
        const double end = _options.Expire > 0.0 ? _options.Expire + 1.0 : _options.Common.Wait;
        _session.WaitUntil(_session.Seconds() + end,
                           [&receipt] { return receipt->Outcome() != QueueOutcome::Pending; });
        settled.Disconnect();
        if (receipt->Outcome() == QueueOutcome::Pending)
        {
            const std::string reason = _wakeup.IsInterrupted() ? "interrupted" : "no answer in time";
            Output::Talk("in doubt: " + reason);
            return Tell("in doubt", reason);
        }
        if (receipt->Outcome() == QueueOutcome::Delivered && !_toldOfNoAnswer && AsksNoAnswer(*message))
        {
            _toldOfNoAnswer = true;
            Output::Talk("`reply_to` is empty: the receiver tells nobody whether it does what it was sent");
        }
        const std::string outcome = ToString(receipt->Outcome());
        return Tell(outcome, "") && receipt->Outcome() == QueueOutcome::Delivered;
    }

    bool IsRead() const { return _isRead; }

private:
    bool Tell(const std::string &outcome, const std::string &reason)
    {
        _isRead = _options.Common.Json ? Output::Object({{"to", _options.Address},
                                                         {"type", _type->Name()},
                                                         {"outcome", outcome},
                                                         {"reason", reason}})
                                       : Output::Line(outcome);
        return outcome == "delivered";
    }

    const Options &_options;
    FleetSession &_session;
    Wakeup &_wakeup;
    const std::shared_ptr<const DynamicType> _type;
    bool _isRead = true;
    bool _toldOfNoAnswer = false;
};

int Run(const Options &options, Wakeup &wakeup)
{
    const auto to = Split(options.Address);
    if (to && to->Node != "*" && options.Address.find_first_of("*?") != std::string::npos)
    {
        Output::Talk("`" + options.Address + "`: wildcards are not taken here; name one node, or `*/" +
                     to->Queue + "` for all");
        return Usage;
    }
    if (!to || !(to->Node == "*" || IsNodeName(to->Node)) || !IsMessageName(to->Queue))
    {
        Output::Talk("`" + options.Address + "` is no queue; expected NODE/QUEUE, as uav1/MissionControl");
        return Usage;
    }
    GatewayConfig config = ConfigOf(options.Common);
    config.Tool->AsksOf = {to->Node};
    SendRule rule;
    rule.Expire = std::chrono::milliseconds(static_cast<std::int64_t>(1000.0 * options.Expire));
    config.Send.push_back(rule);
    FleetSession session(config, options.Common, wakeup);
    const auto takers = [&] { return TakersOf(*to, options.Type, session.Nodes()); };
    if (to->Node == "*")
    {
        session.WaitForEverybody([&session] { return Offers::AreComplete(session.Nodes()); });
    }
    session.WaitForOffers(to->Node, [&] { return !takers().empty(); });
    if (!session.IsAnybodyThere())
    {
        return session.NobodyThere();
    }
    const std::vector<Taker> found = takers();
    if (found.empty())
    {
        Output::Talk(WhyNobody(*to, options.Type, session));
        return ProblemFound;
    }
    std::vector<std::string> holders;
    for (const Taker &taker : found)
    {
        if (taker.Definition == found.front().Definition)
        {
            holders.push_back(taker.Node);
        }
        else
        {
            Output::Talk(taker.Node + " was built with another definition of `" + options.Type +
                         "`; it gets nothing");
        }
    }
    const FleetType type = FetchType(session, holders, options.Type, found.front().Definition,
                                     session.Seconds() + options.Common.Wait);
    if (!type.Type || DynamicType::Register(type.Type) == nullptr)
    {
        Output::Talk(type.Type ? "this program has another definition of `" + options.Type + "`"
                               : type.Reason);
        return ProblemFound;
    }
    Sender sender(options, session, wakeup, type.Type);
    bool good = holders.size() == found.size();
    if (options.Value != "-")
    {
        return sender.Send(options.Value) && good ? Good : ProblemFound;
    }
    InputLines input([&session] { session.Notify(); });
    while (!wakeup.IsInterrupted() && sender.IsRead())
    {
        InputLines::Line line;
        session.WaitUntil(FleetSession::Forever, [&] { return input.Take(line); });
        if (!line.Text)
        {
            break;  // the end
        }
        good = (line.Text->empty() || sender.Send(*line.Text)) && good;
    }
    return good || !sender.IsRead() ? Good : ProblemFound;
}

}  // namespace
}  // namespace SendParts

void AddSendCommand(CLI::App &app, Chosen &chosen)
{
    using namespace SendParts;
    const auto [command, options] = AddCommand<Options>(
        app, chosen, "send", "Sends to a queue, waits for the outcome, and exits by it", &Run);
    command->add_option("QUEUE", options->Address, "uav1/MissionControl; */MissionControl: of all nodes")
        ->required();
    command->add_option("TYPE", options->Type, "As Uav::Goto")->required();
    command
        ->add_option("JSON", options->Value,
                     "The value; what it leaves out has its default. -: a line each from standard input")
        ->required();
    AddCommonOptions(*command, options->Common, 10.0);
    command->add_option("--expire", options->Expire, "Seconds after which it is not to be delivered any more")
        ->check(CLI::Range(0.1, 86400.0));
    AddExamples(*command, {"rabit send uav1/MissionControl Uav::GoHome '{}'",
                           R"(rabit send '*/MissionControl' Uav::GoHome '{"reason": "battery"}' --expire 5)",
                           "rabit send uav1/MissionControl Uav::Goto - --json"});
}

}  // namespace Rabit::Tool
