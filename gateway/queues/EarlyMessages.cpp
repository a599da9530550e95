#include "queues/EarlyMessages.h"

#include <utility>

namespace Rabit
{

EarlyMessages::Added EarlyMessages::Add(Message message, const Knows &knows)
{
    const std::lock_guard lock(_mutex);
    const auto found = _waiting.find(message.Node);
    if (found == _waiting.end() && knows(message.Node))
    {
        return Added::NotNeeded;
    }
    const std::size_t bytes = message.Payload->Size();
    if (_messages >= MostMessages || bytes > MostBytes - _bytes)
    {
        return Added::TooMany;
    }
    _bytes += bytes;
    ++_messages;
    std::deque<Message> &waiting = found == _waiting.end() ? _waiting[message.Node] : found->second;
    waiting.push_back(std::move(message));
    return Added::Waits;
}

void EarlyMessages::Release(Duration now, const Knows &knows,
                            const std::function<void(const Message &)> &take)
{
    for (const std::string &node : Nodes())
    {
        const bool isKnown = knows(node);
        ReleaseOf(
            node,
            [isKnown, now](const Message &message) { return isKnown || now - message.Since >= LongestWait; },
            take);
    }
}

void EarlyMessages::ReleaseAll(const std::function<void(const Message &)> &take, const std::string &node)
{
    for (const std::string &one : node.empty() ? Nodes() : std::vector{node})
    {
        ReleaseOf(
            one, [](const Message &) { return true; }, take);
    }
}

void EarlyMessages::Visit(const std::function<void(const Message &)> &visit) const
{
    const std::lock_guard lock(_mutex);
    for (const auto &[node, messages] : _waiting)
    {
        for (const Message &message : messages)
        {
            visit(message);
        }
    }
}

std::vector<std::string> EarlyMessages::Nodes() const
{
    const std::lock_guard lock(_mutex);
    std::vector<std::string> nodes;
    for (const auto &[node, messages] : _waiting)
    {
        nodes.push_back(node);
    }
    return nodes;
}

void EarlyMessages::ReleaseOf(const std::string &node, const std::function<bool(const Message &)> &isDue,
                              const std::function<void(const Message &)> &take)
{
    for (std::unique_lock lock(_mutex);;)
    {
        const auto found = _waiting.find(node);
        if (found == _waiting.end())
        {
            return;
        }
        if (found->second.empty())
        {
            _waiting.erase(found);
            return;
        }
        if (!isDue(found->second.front()))
        {
            return;
        }
        const Message message = std::move(found->second.front());
        found->second.pop_front();
        lock.unlock();
        take(message);
        lock.lock();
        // Only now: a message that is sent meanwhile must not overtake this one.
        _bytes -= message.Payload->Size();
        --_messages;
    }
}

}  // namespace Rabit
