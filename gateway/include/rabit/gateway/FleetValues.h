#pragma once

#include <rabit/RabitManager.h>
#include <rabit/RabitTimer.h>

#include <chrono>
#include <limits>
#include <map>
#include <memory>
#include <string>
#include <typeinfo>
#include <utility>

namespace Rabit
{

// The newest value of one message of each other node, for a node that subscribes to it from several:
//
//     Rabit::FleetValues<Uav::Pose> _poses{*this, "Pose"};  // uav1/Pose, uav2/Pose, ...
//     ...
//     _poses.Fetch();
//     for (const auto &[node, pose] : _poses.YoungerThan(0.5))
//         std::cout << node << ' ' << pose->latitude_deg << ' ' << pose->GetAgeSeconds() << '\n';
//
// Each message `X/Pose` of that type in the workspace counts as the one of a node X. So give a message of the
// program's own a name without `/`.
//
// Values of a node that is gone stay. Their age grows, and Gateway/Fleet has the state of the node.
// Not thread-safe: for the manager's unit of work.
template <typename T>
class FleetValues
{
public:
    // By node. The messages belong to this object.
    using Values = std::map<std::string, const T *>;

    // New nodes are looked for with this period.
    static constexpr std::chrono::seconds LookPeriod{1};

    enum class Wake
    {
        No,
        OnEach  // the manager is woken by each value, from the first look at its node on
    };

    // The manager must outlive the object, as a member of it does.
    FleetValues(RabitManager &manager, const std::string &message, Wake wake = Wake::No)
        : _manager(manager), _ending(std::string("/").append(message)), _wake(wake)
    {
    }

    // Fetches the newest value of each node. Returns whether any is new.
    bool Fetch()
    {
        if (_looks.IsDue(_manager))
        {
            Look();
        }
        bool any = false;
        for (const auto &[node, message] : _messages)
        {
            any = message->FetchMessage() || any;
        }
        return any;
    }
    // As of the last Fetch: the values of all nodes that ever posted one.
    Values All() const { return YoungerThan(std::numeric_limits<double>::infinity()); }
    // Those posted less than so many seconds ago, by the age that the gateway knows.
    Values YoungerThan(double seconds) const
    {
        Values values;
        for (const auto &[node, message] : _messages)
        {
            if (message->WasPosted() && message->GetAgeSeconds() < seconds)
            {
                values.emplace(node, message.get());
            }
        }
        return values;
    }
    // Null if that node never posted one.
    const T *Of(const std::string &node) const
    {
        const auto found = _messages.find(node);
        return found != _messages.end() && found->second->WasPosted() ? found->second.get() : nullptr;
    }

private:
    void Look()
    {
        for (const MessageInfo &info : _manager.GetWorkspace().GetListOfMessages())
        {
            if (info.Type != typeid(T) || info.Name.size() <= _ending.size() ||
                info.Name.compare(info.Name.size() - _ending.size(), _ending.size(), _ending) != 0)
            {
                continue;
            }
            const std::string node = info.Name.substr(0, info.Name.size() - _ending.size());
            if (node.find('/') != std::string::npos || _messages.count(node) != 0)
            {
                continue;
            }
            auto message = std::make_shared<T>();
            if (!_manager.AddPublishSubscribeMessage(info.Name, message))
            {
                continue;
            }
            if (_wake == Wake::OnEach)
            {
                _manager.WakeUpManagerOnMessagePost(message);
            }
            _messages.emplace(node, std::move(message));
        }
    }

    RabitManager &_manager;
    const std::string _ending;
    const Wake _wake;
    RabitTimer _looks{LookPeriod};
    std::map<std::string, std::shared_ptr<T>> _messages;
};

}  // namespace Rabit
