#include "queues/IncomingQueues.h"

#include <algorithm>
#include <utility>

namespace Rabit
{

IncomingQueues::IncomingQueues(const std::vector<AcceptRule> &rules, RabitWorkspace &workspace,
                               const std::function<void()> &wake)
{
    for (const AcceptRule &rule : rules)
    {
        _accepted.try_emplace(rule.Queue, rule, workspace, wake);
    }
}

void IncomingQueues::Decode(const LinkData &data, DecodedMessages &messages) const
{
    const auto queue = _accepted.find(data.Queue);
    if (queue == _accepted.end())
    {
        return;
    }
    for (const LinkItem &item : data.Items)
    {
        if ((item.Flags & LinkFlagSkip) == 0)
        {
            messages.push_back({item.Payload.data(), queue->second.Decode(item.Type, item.Payload)});
        }
    }
}

void IncomingQueues::Offer(std::span<const Decoded> messages)
{
    _offered = messages;
}

// The links consume messages in the order of the datagram, and may leave out some.
AcceptedQueue::Decoded IncomingQueues::TakeOffered(const AcceptedQueue &queue, std::string_view type,
                                                   std::span<const std::uint8_t> payload)
{
    while (!_offered.empty())
    {
        const Decoded &next = _offered.front();
        _offered = _offered.subspan(1);
        if (next.Payload == payload.data())
        {
            return next.What;
        }
    }
    return queue.Decode(type, payload);
}

LocalQueueResult IncomingQueues::Deliver(std::string_view source, std::string_view queue,
                                         std::string_view type, std::span<const std::uint8_t> payload,
                                         bool redelivered)
{
    const auto found = _accepted.find(queue);
    if (found == _accepted.end() || !found->second.AcceptsFrom(source))
    {
        return LocalQueueResult::Unknown;
    }
    AcceptedQueue &accepted = found->second;
    const LocalQueueResult result = accepted.Deliver(TakeOffered(accepted, type, payload), redelivered);
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
    return found == _accepted.end() ? 1 : found->second.Room();
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
    std::vector<Gateway::Problem> problems;
    for (const auto &[name, queue] : _accepted)
    {
        if (!queue.Problem().empty())
        {
            Gateway::Problem problem;
            problem.subject = "accept " + name;
            problem.reason = queue.Problem();
            problems.push_back(problem);
        }
    }
    return problems;
}

}  // namespace Rabit
