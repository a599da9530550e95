#include "queues/IncomingQueues.h"

#include <algorithm>
#include <utility>

#include "names/TypeDefinition.h"

namespace Rabit
{

IncomingQueues::IncomingQueues(const std::vector<AcceptRule> &rules, RabitWorkspace &workspace,
                               const std::function<void()> &wake, std::size_t quicklyDecoded,
                               bool keepsReceived)
    : _workspace(workspace), _quicklyDecoded(quicklyDecoded), _keepsReceived(keepsReceived)
{
    for (const AcceptRule &rule : rules)
    {
        _accepted.try_emplace(rule.Queue, rule, workspace, wake);
    }
}

std::shared_ptr<void> IncomingQueues::Decode(const Undecoded &message) const
{
    const AcceptedQueue &queue = _accepted.at(message.Queue);
    return std::make_shared<AcceptedQueue::Decoded>(
        queue.Decode(message.Type, message.Owner->View().first(message.Size)));
}

bool IncomingQueues::Accepts(std::string_view source, std::string_view queue)
{
    const auto found = _accepted.find(queue);
    const bool accepts = found != _accepted.end() && found->second.AcceptsFrom(source);
    if (!accepts)
    {
        _unwanted.Note({std::string("accept ").append(queue), std::string(source),
                        std::string(source) + " sends messages to queue `" + std::string(queue) +
                            "`, which accepts none of it: they are refused"},
                       _workspace.GetClock().Monotonic());
    }
    return accepts;
}

bool IncomingQueues::AcceptsType(std::string_view queue, std::string_view type) const
{
    const auto found = _accepted.find(queue);
    return found != _accepted.end() && found->second.AcceptsType(type);
}

LocalQueueResult IncomingQueues::Deliver(const LinkDelivery &delivery)
{
    const auto found = _accepted.find(delivery.Queue);
    if (found == _accepted.end())
    {
        return LocalQueueResult::Unknown;
    }
    AcceptedQueue &accepted = found->second;
    LocalQueueResult result = LocalQueueResult::Full;
    if (delivery.Prepared)
    {
        result = accepted.Deliver(*std::static_pointer_cast<AcceptedQueue::Decoded>(delivery.Prepared),
                                  delivery.Redelivered);
    }
    else if (delivery.Payload.size() <= _quicklyDecoded)
    {
        result = accepted.Deliver(accepted.Decode(delivery.Type, delivery.Payload), delivery.Redelivered);
    }
    else if (!accepted.AcceptsType(delivery.Type))
    {
        result = LocalQueueResult::WrongType;  // it need not wait for room
    }
    else if (accepted.Room() > 0)
    {
        _undecoded.push_back({.Source = std::string(delivery.Source),
                              .Queue = std::string(delivery.Queue),
                              .Type = std::string(delivery.Type),
                              .SenderLife = delivery.SenderLife,
                              .Number = delivery.Number,
                              .Owner = delivery.Owner ? delivery.Owner : LinkBytes::CopyOf(delivery.Payload),
                              .Size = delivery.Payload.size()});
        return LocalQueueResult::Later;
    }
    if (result == LocalQueueResult::Ok && _keepsReceived)
    {
        _received.push_back({std::string(delivery.Source), std::string(delivery.Queue),
                             std::string(SplitLinkTypeName(delivery.Type).Type),
                             LinkBytes::CopyOf(delivery.Payload)});
    }
    if (result == LocalQueueResult::Ok &&
        std::find(_delivered.begin(), _delivered.end(), accepted.Local()) == _delivered.end())
    {
        _delivered.push_back(accepted.Local());
    }
    return result;
}

std::size_t IncomingQueues::Room(std::string_view queue) const
{
    const auto found = _accepted.find(queue);
    return found == _accepted.end() ? 0 : found->second.Room();
}

void IncomingQueues::Find(const std::function<void(const std::string &queue)> &changed)
{
    for (auto &[name, queue] : _accepted)
    {
        const bool isOther = queue.Find();
        if (queue.TakeRoomCame() || isOther)
        {
            changed(name);
        }
    }
}

std::vector<Gateway::Problem> IncomingQueues::Problems() const
{
    std::vector<Gateway::Problem> problems = _unwanted.Problems(_workspace.GetClock().Monotonic());
    for (const auto &[name, queue] : _accepted)
    {
        if (!queue.Problem().empty())
        {
            problems.push_back({"accept " + name, "", queue.Problem()});
        }
    }
    return problems;
}

}  // namespace Rabit
