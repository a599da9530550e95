// rabit send: sends queue messages, and reports their outcomes.
#include <rabit/RabitQueueReceipt.h>
#include <rabit/base/ListedNames.h>
#include <rabit/dynamic/DynamicMessage.h>
#include <rabit/gateway/NamePattern.h>
#include <rabit/idl/NearestWord.h>

#include <algorithm>
#include <memory>
#include <optional>
#include <utility>

#include "Command.h"
#include "FleetSession.h"
#include "FleetType.h"
#include "InputLines.h"
#include "JsonText.h"
#include "Offers.h"
#include "Replies.h"

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
    std::string Reply;   // type of the answer; empty: none is waited for
    std::string Expect;  // members that the answer must have
    std::string Idl;     // file with the type of the answer
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

// The answers that each message waits for, and what they must have.
struct Answers
{
    Replies &Queue;
    std::size_t Count = 1;
    Json Expected = Json::object();
};

// Sends one message and waits for its outcome, and for its answers.
class Sender
{
public:
    // Without `answers` it waits for none.
    Sender(const Options &options, FleetSession &session, Wakeup &wakeup,
           std::shared_ptr<const DynamicType> type, Answers *answers)
        : _options(options), _session(session), _wakeup(wakeup), _type(std::move(type)), _answers(answers)
    {
    }

    // Returns true if it was delivered, and each expected answer came.
    bool Send(const std::string &json)
    {
        auto message = std::make_shared<DynamicMessage>(_type);
        std::string misfit = message->SetJson(json);
        if (misfit.empty() && _answers != nullptr)
        {
            misfit = _answers->Queue.Ask(*message);
        }
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
        const std::string outcome = ToString(receipt->Outcome());
        if (receipt->Outcome() != QueueOutcome::Delivered)
        {
            return Tell(outcome, "");
        }
        if (_answers != nullptr)
        {
            return TellAnswers(outcome, *message);
        }
        if (!_toldOfNoAnswer && AsksNoAnswer(*message))
        {
            _toldOfNoAnswer = true;
            Output::Talk("`reply_to` is empty: the receiver tells nobody whether it does what it was sent");
        }
        return Tell(outcome, "");
    }

    bool IsRead() const { return _isRead; }

private:
    // Returns true if it was delivered.
    bool Tell(const std::string &outcome, const std::string &reason)
    {
        Json row = RowOf(outcome, reason);
        if (_answers != nullptr)
        {
            row["answers"] = Json::array();
        }
        _isRead = _options.Common.Json ? Output::Object(row) : Output::Line(outcome);
        return outcome == "delivered";
    }

    bool TellAnswers(const std::string &outcome, const DynamicMessage &message)
    {
        if (!_options.Common.Json)
        {
            _isRead = Output::Line(outcome);
        }
        const std::vector<Json> came =
            _answers->Queue.WaitFor(message, _answers->Count, _options.Common.Wait);
        const bool isExpected =
            std::all_of(came.begin(), came.end(),
                        [this](const Json &answer) { return Reply::Has(answer, _answers->Expected); });
        std::string reason;
        if (came.size() < _answers->Count)
        {
            reason = std::to_string(_answers->Count - came.size()) + " of " +
                     std::to_string(_answers->Count) + " answers did not come" +
                     (_wakeup.IsInterrupted() ? ": interrupted" : " in time");
        }
        else if (!isExpected)
        {
            reason = "an answer is not as expected";
        }
        if (!reason.empty())
        {
            Output::Talk(reason);
        }
        if (_options.Common.Json)
        {
            Json row = RowOf(outcome, reason);
            row["answers"] = came;
            _isRead = Output::Object(row);
        }
        for (std::size_t i = 0; i < came.size() && !_options.Common.Json; ++i)
        {
            _isRead = Output::Line(JsonText(came[i]));
        }
        return reason.empty();
    }

    Json RowOf(const std::string &outcome, const std::string &reason) const
    {
        return {{"to", _options.Address}, {"type", _type->Name()}, {"outcome", outcome}, {"reason", reason}};
    }

    const Options &_options;
    FleetSession &_session;
    Wakeup &_wakeup;
    const std::shared_ptr<const DynamicType> _type;
    Answers *const _answers;
    bool _isRead = true;
    bool _toldOfNoAnswer = false;
};

// Waits for the nodes that take the message, and returns them.
std::vector<Taker> Meet(FleetSession &session, const Destination &to, const std::string &type)
{
    const auto takers = [&] { return TakersOf(to, type, session.Nodes()); };
    if (to.Node == "*")
    {
        session.WaitForEverybody([&session] { return Offers::AreComplete(session.Nodes()); });
    }
    session.WaitForOffers(to.Node, [&] { return !takers().empty(); });
    return takers();
}

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
    config.Tool->AsksOf = {options.Reply.empty() || !options.Idl.empty() ? to->Node : "*"};
    SendRule rule;
    rule.Expire = std::chrono::milliseconds(static_cast<std::int64_t>(1000.0 * options.Expire));
    config.Send.push_back(rule);
    auto session = std::make_unique<FleetSession>(config, options.Common, wakeup);
    const std::vector<Taker> found = Meet(*session, *to, options.Type);
    if (!session->IsAnybodyThere())
    {
        return session->NobodyThere();
    }
    if (found.empty())
    {
        Output::Talk(WhyNobody(*to, options.Type, *session));
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
    bool good = holders.size() == found.size();
    const FleetType type = FetchType(*session, holders, options.Type, found.front().Definition,
                                     session->Seconds() + options.Common.Wait);
    if (!type.Type || DynamicType::Register(type.Type) == nullptr)
    {
        Output::Talk(type.Type ? "this program has another definition of `" + options.Type + "`"
                               : type.Reason);
        return ProblemFound;
    }
    std::optional<Replies> replies;
    std::optional<Answers> answers;
    if (!options.Reply.empty())
    {
        const std::shared_ptr<const DynamicType> answer =
            Reply::TypeOf(options.Reply, options.Idl, options.Common.Wait, *session);
        Json expected = Json::object();
        const std::string misfit =
            answer && !options.Expect.empty() ? Reply::Expect(answer, options.Expect, expected) : "";
        if (!misfit.empty())
        {
            Output::Talk("--expect: " + misfit);
        }
        if (!answer || !misfit.empty())
        {
            return answer ? Usage : ProblemFound;
        }
        // Nodes send nothing to a tool, so this program is a node from here on.
        session.reset();
        config.Tool.reset();
        config.Accept.push_back({.Queue = Replies::Queue, .Types = {options.Reply}, .From = {to->Node}});
        session = std::make_unique<FleetSession>(config, options.Common, wakeup);
        replies.emplace(*session, config.Node);
        Meet(*session, *to, options.Type);
        answers.emplace(Answers{*replies, holders.size(), std::move(expected)});
    }
    Sender sender(options, *session, wakeup, type.Type, answers ? &*answers : nullptr);
    if (options.Value != "-")
    {
        return sender.Send(options.Value) && good ? Good : ProblemFound;
    }
    InputLines input([&session] { session->Notify(); });
    while (!wakeup.IsInterrupted() && sender.IsRead())
    {
        InputLines::Line line;
        session->WaitUntil(FleetSession::Forever, [&] { return input.Take(line); });
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
    CLI::Option *const reply = command->add_option(
        "--reply", options->Reply,
        "Waits for the answer too: a message of this type, as Uav::CommandAck. Prints it");
    command
        ->add_option("--expect", options->Expect,
                     "JSON: the members that the answer must have for exit code 0")
        ->needs(reply);
    command->add_option("--idl", options->Idl, "A file with the IDL of the answer, in place of asking for it")
        ->needs(reply);
    AddExamples(*command, {"rabit send uav1/MissionControl Uav::GoHome '{}'",
                           R"(rabit send '*/MissionControl' Uav::GoHome '{"reason": "battery"}' --expire 5)",
                           R"(rabit send uav1/MissionControl Uav::GoHome '{}' --reply Uav::CommandAck )"
                           R"(--expect '{"stage": "COMMAND_ACCEPTED"}')",
                           "rabit send uav1/MissionControl Uav::Goto - --json"});
}

}  // namespace Rabit::Tool
