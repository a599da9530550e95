// The topics that one session has open, and the types that other sessions use for them.
#pragma once

#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <utility>
#include <vector>

#include <rabit/transport/Transport.h>
#include "common/SessionLog.h"

namespace Rabit
{

// Thread-safe.
class TopicRegistry
{
public:
    explicit TopicRegistry(std::shared_ptr<SessionLog> log) : _log(std::move(log)) {}

    // Keeps a topic open as long as it lives. The registry must outlive it.
    class Use
    {
    public:
        // Throws TransportError if the names are impossible, or if the topic is open with another type.
        Use(TopicRegistry &registry, const TopicDescription &topic);
        ~Use() { _registry.Close(_topic); }
        Use(const Use &) = delete;
        Use &operator=(const Use &) = delete;

    private:
        TopicRegistry &_registry;
        const std::string _topic;
    };

    // An endpoint of another session appeared (or announced another topic) or went. Types that differ from
    // ours are counted and logged, whichever side was there first.
    void RemoteAppeared(const RemoteEndpoint &endpoint);
    void RemoteGone(const WriterId &endpoint);
    void ForgetRemote();
    // As in TransportSession.
    std::vector<RemoteEndpoint> RemoteOn(const std::string &topic) const;
    std::vector<std::string> RemoteTopics() const;

private:
    void Open(const TopicDescription &topic);
    void Close(const std::string &topic);

    struct OpenTopic
    {
        std::string Type;
        int Count = 0;
    };
    const std::shared_ptr<SessionLog> _log;
    mutable std::mutex _mutex;
    std::map<std::string, OpenTopic> _open;      // guarded by _mutex
    std::map<WriterId, RemoteEndpoint> _remote;  // guarded by _mutex
};

}  // namespace Rabit
