#include "queues/IncomingQueues.h"

#include <algorithm>
#include <utility>

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

IncomingQueues::Decoded IncomingQueues::Decode(const Undecoded &message) const
{
    Decoded decoded{.Source = message.Source, .Queue = message.Queue, .Size = message.Size, .What = {}};
    const auto queue = _accepted.find(message.Queue);
    if (queue != _accepted.end())
    {
        decoded.What = queue->second.Decode(message.Type, message.Owner->View().first(message.Size));
    }
    return decoded;
}

LocalQueueResult IncomingQueues::Deliver(std::string_view source, std::string_view queue,
                                         std::string_view type, std::span<const std::uint8_t> payload,
                                         const LinkPayload &owner, bool redelivered)
{
    const auto found = _accepted.find(queue);
    if (found == _accepted.end())
    {
        return LocalQueueResult::Unknown;
    }
    if (!found->second.AcceptsFrom(source))
    {
        _unwanted.Refused(source, queue, _workspace.GetClock().Monotonic());
        return LocalQueueResult::Unknown;
    }
    AcceptedQueue &accepted = found->second;
    LocalQueueResult result = LocalQueueResult::Full;
    if (_offered != nullptr && _offered->Source == source && _offered->Queue == queue &&
        _offered->Size == payload.size())
    {
        result = accepted.Deliver(std::exchange(_offered, nullptr)->What, redelivered);
    }
    else if (payload.size() <= _quicklyDecoded)
    {
        result = accepted.Deliver(accepted.Decode(type, payload), redelivered);
    }
    else if (accepted.Room() > 0)
    {
        _undecoded.push_back({std::string(source), std::string(queue), std::string(type),
                              owner ? owner : LinkBytes::CopyOf(payload), payload.size()});
        return LocalQueueResult::Later;
    }
    if (result == LocalQueueResult::Ok && _keepsReceived)
    {
        _received.push_back(
            {std::string(source), std::string(queue), std::string(type), LinkBytes::CopyOf(payload)});
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
    std::vector<Gateway::Problem> problems = _unwanted.Problems(_workspace.GetClock().Monotonic());
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
