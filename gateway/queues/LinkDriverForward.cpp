// What LinkDriver does with a message of a local manager for a queue of another node. Any thread.
#include <rabit/idl/MessageTypeRegistry.h>

#include <algorithm>

#include "names/NamePattern.h"
#include "names/TypeDefinition.h"
#include "queues/LinkDriver.h"

namespace Rabit
{
namespace
{

LinkOptions OptionsOf(const SendRule &rule)
{
    LinkOptions options;
    options.Capacity = rule.Capacity;
    options.CapacityBytes = rule.CapacityBytes;
    options.Expire = rule.Expire;
    options.Window = rule.Window;
    options.RedeliverInDoubt = rule.RedeliverInDoubt;
    return options;
}

void Begin(const std::shared_ptr<RabitQueueReceipt> &receipt, std::size_t messages)
{
    if (receipt)
    {
        receipt->Begin(static_cast<std::uint32_t>(messages));
    }
}

}  // namespace

bool LinkDriver::Handles(const std::string &queueName) const
{
    return queueName.find('/') != std::string::npos;
}

LinkPayload LinkDriver::Encode(const MessageType &type, const RabitMessage &message) const
{
    const std::shared_ptr<LinkBytes> payload = _payloads->Make(type.SerializedSize(message));
    const bool encoded = type.Serialize(message, payload->Writable()) == payload->Size();
    return encoded ? payload : nullptr;
}

bool LinkDriver::Forward(const std::string &queueName, const std::shared_ptr<RabitMessage> &message,
                         const std::shared_ptr<RabitQueueReceipt> &receipt)
{
    const std::size_t slash = queueName.find('/');
    const std::string node = queueName.substr(0, slash);
    const std::string queue = queueName.substr(slash + 1);
    if (node == _config.Node)
    {
        const bool added = _workspace.DeliverToQueue(queue, message) == QueueAddResult::Ok;
        Begin(receipt, 1);
        return Settle(receipt, added ? QueueOutcome::Delivered : QueueOutcome::Refused);
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

bool LinkDriver::ForwardToAll(const std::string &queue, const MessageType &type, const LinkPayload &payload,
                              const Receipt &receipt)
{
    const std::vector<std::string> nodes =
        _remote.LiveNodesAccepting(queue, type.Name(), DefinitionHash(type));
    if (nodes.empty())
    {
        Begin(receipt, 1);
        return Refuse("*", queue, QueueAcceptance::UnknownNode,
                      "no live node accepts `" + type.Name() + "` for `" + queue + "`", receipt);
    }
    {
        const std::lock_guard lock(_mutex);
        _refusals.Forgive({"*", queue});
    }
    Begin(receipt, nodes.size());
    bool all = true;
    for (const std::string &node : nodes)
    {
        all = ForwardTo(node, queue, type, payload, receipt) && all;
    }
    return all;
}

bool LinkDriver::ForwardTo(const std::string &node, const std::string &queue, const MessageType &type,
                           const LinkPayload &payload, const Receipt &receipt)
{
    const RemoteQueues::Answer answer = _remote.Ask(node, queue, type.Name(), DefinitionHash(type));
    if (answer.What != QueueAcceptance::Accepted)
    {
        return Refuse(node, queue, answer.What, answer.Reason, receipt);
    }
    LinkEnqueued enqueued;
    bool sooner = false;
    News news;
    {
        const std::lock_guard lock(_mutex);
        ConfigureOnce(node, queue);
        enqueued = _links->Enqueue(node, queue, type.Name(), payload, Now());
        if (enqueued.Accepted())
        {
            _refusals.Forgive({node, queue});
            if (receipt)
            {
                _receipts.emplace(enqueued.Id, receipt);
            }
            sooner = ServeBy(enqueued.Due);
        }
        news = TakeNews();
    }
    Tell(news);  // to accept one may mean to find that others have expired
    if (!enqueued.Accepted())
    {
        return Settle(receipt, QueueOutcome::Refused);
    }
    if (sooner)
    {
        _wake();
    }
    return true;
}

void LinkDriver::ConfigureOnce(const std::string &node, const std::string &queue)
{
    if (!_configured[node].insert(queue).second)
    {
        return;
    }
    const auto rule = std::find_if(
        _config.Send.begin(), _config.Send.end(),
        [&node, &queue](const SendRule &candidate)
        { return MatchesPattern(candidate.To, node) && MatchesPattern(candidate.Queue, queue); });
    if (rule != _config.Send.end())
    {
        _links->Configure(node, queue, OptionsOf(*rule), Now());
    }
}

bool LinkDriver::Refuse(const std::string &node, const std::string &queue, QueueAcceptance verdict,
                        const std::string &reason, const Receipt &receipt)
{
    {
        const std::lock_guard lock(_mutex);
        _refusals.Add({node, queue}, verdict, reason);
    }
    return Settle(receipt, QueueOutcome::Refused);
}

}  // namespace Rabit
