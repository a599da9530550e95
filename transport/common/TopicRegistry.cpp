#include "common/TopicRegistry.h"

#include <rabit/base/Assert.h>

#include <set>
#include <vector>

namespace Rabit
{

namespace
{

constexpr std::size_t MaxName = 255;

void CheckName(const char *what, const std::string &name)
{
    if (name.empty() || name.size() > MaxName || name.find('\0') != std::string::npos)
    {
        throw TransportError(std::string("a ") + what +
                             " name must have 1 to 255 bytes and no zero byte: \"" + name + "\"");
    }
}

}  // namespace

TopicRegistry::Use::Use(TopicRegistry &registry, const TopicDescription &topic)
    : _registry(registry), _topic(topic.Name)
{
    registry.Open(topic);
}

void TopicRegistry::Open(const TopicDescription &topic)
{
    CheckName("topic", topic.Name);
    CheckName("type", topic.TypeName);
    std::vector<RemoteEndpoint> others;
    {
        const std::lock_guard lock(_mutex);
        auto &open = _open.try_emplace(topic.Name, OpenTopic{topic.TypeName}).first->second;
        if (open.Type != topic.TypeName)
        {
            throw TransportError("topic " + topic.Name + " is open in this session with type " + open.Type +
                                 ", so it cannot be opened with type " + topic.TypeName);
        }
        if (++open.Count == 1)
        {
            for (const auto &[id, remote] : _remote)
            {
                if (remote.Topic == topic.Name && remote.Type != topic.TypeName)
                {
                    others.push_back(remote);
                }
            }
        }
    }
    for (const auto &other : others)
    {
        _log->InconsistentType(topic.Name, topic.TypeName, other.Type, other.Node);
    }
}

void TopicRegistry::Close(const std::string &topic)
{
    const std::lock_guard lock(_mutex);
    const auto open = _open.find(topic);
    RABIT_ASSERT(open != _open.end());
    if (--open->second.Count == 0)
    {
        _open.erase(open);
    }
}

void TopicRegistry::RemoteAppeared(const RemoteEndpoint &endpoint)
{
    std::string ours;
    {
        const std::lock_guard lock(_mutex);
        const bool isNew = _remote.insert_or_assign(endpoint.Id, endpoint).second;
        const auto open = _open.find(endpoint.Topic);
        if (isNew && open != _open.end() && open->second.Type != endpoint.Type)
        {
            ours = open->second.Type;
        }
    }
    if (!ours.empty())
    {
        _log->InconsistentType(endpoint.Topic, ours, endpoint.Type, endpoint.Node);
    }
}

std::vector<RemoteEndpoint> TopicRegistry::RemoteOn(const std::string &topic) const
{
    const std::lock_guard lock(_mutex);
    std::vector<RemoteEndpoint> found;
    for (const auto &[id, remote] : _remote)
    {
        if (remote.Topic == topic)
        {
            found.push_back(remote);
        }
    }
    return found;
}

std::vector<std::string> TopicRegistry::RemoteTopics() const
{
    const std::lock_guard lock(_mutex);
    std::set<std::string> topics;
    for (const auto &[id, remote] : _remote)
    {
        topics.insert(remote.Topic);
    }
    return {topics.begin(), topics.end()};
}

void TopicRegistry::RemoteGone(const WriterId &endpoint)
{
    const std::lock_guard lock(_mutex);
    _remote.erase(endpoint);
}

void TopicRegistry::ForgetRemote()
{
    const std::lock_guard lock(_mutex);
    _remote.clear();
}

}  // namespace Rabit
