#include "queues/OutgoingQueues.h"

#include <rabit/idl/MessageTypeRegistry.h>

#include <map>
#include <utility>

#include "names/TypeDefinition.h"

namespace Rabit
{
namespace
{

void Begin(const std::shared_ptr<RabitQueueReceipt> &receipt, std::size_t messages)
{
    if (receipt)
    {
        receipt->Begin(static_cast<std::uint32_t>(messages));
    }
}

// Node and queue.
std::pair<std::string, std::string> Split(const std::string &queueName)
{
    const std::size_t slash = queueName.find('/');
    return {queueName.substr(0, slash), queueName.substr(slash + 1)};
}

// Returns false.
bool RefuseAtCall(const std::shared_ptr<RabitQueueReceipt> &receipt, const std::string &reason)
{
    if (receipt)
    {
        receipt->Refuse(reason);
    }
    return false;
}

}  // namespace

OutgoingQueues::OutgoingQueues(const std::string &ownNode, RabitWorkspace &workspace,
                               const RemoteQueues &remote, LinkDriver &links, std::shared_ptr<GatewayTap> tap)
    : _ownNode(ownNode), _workspace(workspace), _remote(remote), _links(links), _tap(std::move(tap))
{
}

bool OutgoingQueues::Handles(const std::string &queueName) const
{
    return queueName.find('/') != std::string::npos;
}

LinkPayload OutgoingQueues::Encode(const MessageType &type, const RabitMessage &message) const
{
    const std::shared_ptr<LinkBytes> payload = _payloads->Make(type.SerializedSize(message));
    const bool encoded = type.Serialize(message, payload->Writable()) == payload->Size();
    return encoded ? payload : nullptr;
}

bool OutgoingQueues::Forward(const std::string &queueName, const std::shared_ptr<RabitMessage> &message,
                             const std::shared_ptr<RabitQueueReceipt> &receipt)
{
    const auto [node, queue] = Split(queueName);
    if (node == _ownNode)
    {
        const QueueAddResult added = _workspace.DeliverToQueue(queue, message);
        Begin(receipt, 1);
        if (added != QueueAddResult::Ok)
        {
            return RefuseAtCall(receipt, RefusalReasonOf(added, queue));
        }
        if (receipt)
        {
            receipt->Settle(QueueOutcome::Delivered);
        }
        return true;
    }
    const MessageType *type = MessageTypeRegistry::Of(*message);
    if (type == nullptr)
    {
        Begin(receipt, 1);
        return Refuse(node, queue, QueueAcceptance::WrongType,
                      "the message is of a type that was not made from IDL", receipt);
    }
    const LinkPayload payload = Encode(*type, *message);
    if (!payload)
    {
        Begin(receipt, 1);
        return Refuse(node, queue, QueueAcceptance::WrongType,
                      "the message does not fit its IDL type `" + type->Name() +
                          "`: a bounded string or sequence is too long",
                      receipt);
    }
    if (node == "*")
    {
        return ForwardToAll(queue, *type, payload, receipt);
    }
    Begin(receipt, 1);
    return ForwardTo(node, queue, *type, payload, receipt);
}

std::vector<std::string> OutgoingQueues::Known(const std::string &queueName,
                                               const RabitMessage &message) const
{
    const auto [node, queue] = Split(queueName);
    std::vector<std::string> known;
    if (node == "*")
    {
        const MessageType *type = MessageTypeRegistry::Of(message);
        if (type != nullptr)
        {
            known = _remote.LiveNodesFor(queue, type->Name(), DefinitionHash(*type)).Accepting;
        }
        for (std::string &name : known)
        {
            name += "/" + queue;
        }
    }
    else if (node == _ownNode || _remote.Knows(node))
    {
        known.push_back(queueName);
    }
    return known;
}

void OutgoingQueues::TakenElsewhere(const std::string &queueName)
{
    const auto [node, queue] = Split(queueName);
    _refusals.Forgive(node, queue);
}

bool OutgoingQueues::ForwardToAll(const std::string &queue, const MessageType &type,
                                  const LinkPayload &payload, const Receipt &receipt)
{
    const RemoteQueues::LiveNodes nodes = _remote.LiveNodesFor(queue, type.Name(), DefinitionHash(type));
    if (nodes.Accepting.empty() && nodes.NotAnnounced.empty())
    {
        Begin(receipt, 1);
        // No such queue anywhere is no problem: `*` names no node that must be there.
        RemoteQueues::Answer answer = _remote.WhyNoneAccepts(queue, type.Name(), DefinitionHash(type));
        const std::string reason = "no live node accepts `" + type.Name() + "` for `" + queue + "`";
        TellRefused("*", queue, type, payload, reason);
        const std::string problem = answer.Reason.empty() ? "" : reason + ": " + answer.Reason;
        _refusals.Add("*", queue, answer.What, problem, _workspace.GetClock().Monotonic());
        return RefuseAtCall(receipt, problem.empty() ? reason : problem);
    }
    if (!nodes.Accepting.empty())
    {
        _refusals.Forgive("*", queue);
    }
    Begin(receipt, nodes.Accepting.size() + nodes.NotAnnounced.size());
    bool all = true;
    // A node that has not announced itself refuses, with its reason: a caller must not take it for one that
    // has no such queue.
    for (const std::vector<std::string> *names : {&nodes.Accepting, &nodes.NotAnnounced})
    {
        for (const std::string &node : *names)
        {
            all = ForwardTo(node, queue, type, payload, receipt) && all;
        }
    }
    return all;
}

bool OutgoingQueues::ForwardTo(const std::string &node, const std::string &queue, const MessageType &type,
                               const LinkPayload &payload, const Receipt &receipt)
{
    const RemoteQueues::Answer answer = _remote.Ask(node, queue, type.Name(), DefinitionHash(type));
    if (answer.What != QueueAcceptance::Accepted)
    {
        TellRefused(node, queue, type, payload, answer.Reason);
        return Refuse(node, queue, answer.What, answer.Reason, receipt);
    }
    const LinkRefusal refusal = _links.Enqueue(node, queue, LinkTypeName(type), payload, receipt);
    if (refusal != LinkRefusal::None)
    {
        const std::string reason(ToString(refusal));
        TellRefused(node, queue, type, payload, reason);
        if (refusal == LinkRefusal::TooLarge)
        {
            return Refuse(node, queue, QueueAcceptance::WrongType, "the message is " + reason, receipt);
        }
        return RefuseAtCall(receipt, reason);  // counted by the link
    }
    _refusals.Forgive(node, queue);
    return true;
}

void OutgoingQueues::TellRefused(const std::string &node, const std::string &queue, const MessageType &type,
                                 const LinkPayload &payload, const std::string &reason) const
{
    if (_tap)
    {
        _tap->Refused({node, queue, type.Name(), 0, payload->View()}, reason);
    }
}

bool OutgoingQueues::Refuse(const std::string &node, const std::string &queue, QueueAcceptance acceptance,
                            const std::string &reason, const Receipt &receipt)
{
    _refusals.Add(node, queue, acceptance, reason, _workspace.GetClock().Monotonic());
    return RefuseAtCall(receipt, reason);
}

// The announcement that tells why may have come after the outcome.
void OutgoingQueues::NoteRefusedThere()
{
    for (const LinkDriver::Refused &refused : _links.TakeRefusedThere())
    {
        const LinkTypeParts parts = SplitLinkTypeName(refused.Type);
        const std::string type(parts.Type);
        const RemoteQueues::Answer answer = _remote.Ask(refused.Node, refused.Queue, type, parts.Definition);
        const bool isKnown = answer.What != QueueAcceptance::Accepted &&
                             answer.What != QueueAcceptance::UnknownNode &&
                             answer.What != QueueAcceptance::NotAnnounced;
        _refusals.Tell(refused.Node, refused.Queue, answer.What,
                       "messages of `" + type + "` that waited for " + refused.Node + " were refused there" +
                           (isKnown ? ": " + answer.Reason : ""),
                       _workspace.GetClock().Monotonic());
    }
}

std::vector<Gateway::Problem> OutgoingQueues::Problems()
{
    NoteRefusedThere();
    return _refusals.Problems(_workspace.GetClock().Monotonic());
}

std::vector<Gateway::LinkStatus> OutgoingQueues::Status() const
{
    std::map<RefusalCounts::LinkName, Gateway::LinkStatus> rows;
    for (Gateway::LinkStatus &row : _links.OutboundStatus())
    {
        RefusalCounts::LinkName name{row.node, row.queue};
        rows.emplace(std::move(name), std::move(row));
    }
    _refusals.Report(rows);
    std::vector<Gateway::LinkStatus> status;
    for (auto &[name, row] : rows)
    {
        row.node = name.first;
        row.queue = name.second;
        status.push_back(std::move(row));
    }
    return status;
}

}  // namespace Rabit
