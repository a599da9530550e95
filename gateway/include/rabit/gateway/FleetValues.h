#pragma once

#include <rabit/RabitLog.h>
#include <rabit/RabitManager.h>
#include <rabit/RabitTimer.h>
#include <rabit/gateway/Fleet.h>
#include <rabit/idl/NearestWord.h>

#include <algorithm>
#include <chrono>
#include <limits>
#include <map>
#include <memory>
#include <string>
#include <typeinfo>
#include <utility>
#include <vector>

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
// Values of a node that is gone stay. Their age grows, and Gateway/Fleet has the state of the node
// (Gateway::FindNode).
//
// If no node's value came within 5 s while another node is UP, a warning says so once, with the reason: the
// problem that the gateway has with its `subscribe` entry, another class, or no such entry, with the message
// that was perhaps meant.
// Not thread-safe: for the manager's unit of work.
template <typename T>
class FleetValues
{
public:
    // By node. The messages belong to this object.
    using Values = std::map<std::string, const T *>;

    // New nodes are looked for with this period.
    static constexpr std::chrono::seconds LookPeriod{1};
    static constexpr int LooksBeforeWarning = 5;

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
            WarnIfNoneCame();
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
    bool EndsRight(const std::string &name) const
    {
        return name.size() > _ending.size() &&
               name.compare(name.size() - _ending.size(), _ending.size(), _ending) == 0;
    }
    void Look()
    {
        for (const MessageInfo &info : _manager.GetWorkspace().GetListOfMessages())
        {
            if (info.Type != typeid(T) || !EndsRight(info.Name))
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

    void WarnIfNoneCame()
    {
        if (_looksInVain > LooksBeforeWarning || !_messages.empty())
        {
            _fleet.reset();
            return;
        }
        if (!_fleet)
        {
            _fleet = std::make_shared<Gateway::Fleet>();
            if (!_manager.AddPublishSubscribeMessage("Gateway/Fleet", _fleet))
            {
                _looksInVain = LooksBeforeWarning + 1;
                return;
            }
        }
        _fleet->FetchMessage();
        if (std::none_of(_fleet->nodes.begin(), _fleet->nodes.end(),
                         [](const auto &node) { return node.state == Gateway::NodeState::UP; }))
        {
            _looksInVain = 0;
        }
        else if (++_looksInVain > LooksBeforeWarning)
        {
            _manager.WriteLog(RabitLogLevel::Warning, "other nodes are heard, and no `*" + _ending +
                                                          "` of its class came in 5 s: " + WhyNone());
        }
    }
    // Fleet has a problem of each `subscribe` entry by which nothing comes.
    std::string WhyNone() const
    {
        for (const Gateway::Problem &problem : _fleet->problems)
        {
            if (problem.subject == "subscribe " + _ending.substr(1))
            {
                return problem.reason;
            }
        }
        for (const MessageInfo &info : _manager.GetWorkspace().GetListOfMessages())
        {
            if (EndsRight(info.Name) && info.Type != typeid(T))
            {
                return "`" + info.Name + "` is of another class";
            }
        }
        return "a `subscribe` entry of the gateway's configuration brings it" + Hint();
    }
    std::string Hint() const
    {
        std::vector<std::string> names;
        for (const MessageInfo &info : _manager.GetWorkspace().GetListOfMessages())
        {
            const std::size_t slash = info.Name.find('/');
            if (slash != std::string::npos && slash > 0 && info.Type != typeid(Gateway::Fleet))
            {
                names.push_back(info.Name.substr(slash + 1));
            }
        }
        std::sort(names.begin(), names.end());
        names.erase(std::unique(names.begin(), names.end()), names.end());
        const std::string hint = NearestWordHint(_ending.substr(1), names);
        return hint.rfind("; did you mean", 0) == 0 ? hint : "";
    }

    RabitManager &_manager;
    const std::string _ending;
    const Wake _wake;
    RabitTimer _looks{LookPeriod};
    std::map<std::string, std::shared_ptr<T>> _messages;
    std::shared_ptr<Gateway::Fleet> _fleet;  // only until a value has come or was warned of
    int _looksInVain = 0;                    // while another node is UP
};

}  // namespace Rabit
