#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "SimulatedFleet.h"

namespace Rabit
{

// Nodes under simulated time that post a pose ten times a second and send each other notes. Records, with its
// time, each state of presence that a node shows, and each pose and note that arrives.
class WatchedFleet
{
public:
    using Duration = std::chrono::nanoseconds;
    // The node that shows or sends, and the node that is shown or receives.
    using Pair = std::pair<std::string, std::string>;

    static constexpr Duration Step = std::chrono::milliseconds(10);
    static constexpr Duration PosePeriod = std::chrono::milliseconds(100);

    struct Arrival
    {
        Duration At{0};
        Duration Delay{0};
    };

    // The record of one node about another one: states shown, poses and notes.
    struct Watch
    {
        std::vector<std::pair<Duration, std::string>> States;
        std::vector<Arrival> Poses;
        std::vector<Arrival> Notes;  // at the receiver
        std::uint64_t Accepted = 0;
        std::uint32_t Newest = 0;  // note at the receiver
        Duration Period{0};        // between two notes; 0: none
        Duration Next{0};
    };

    // `names`: all nodes that may ever be there.
    explicit WatchedFleet(std::vector<std::string> names) : _names(std::move(names)) {}

    // Starts a node, or a new life of it without memory of earlier ones.
    SimulatedNode &Start(const std::string &name, const std::function<void(GatewayConfig &)> &change = {})
    {
        GatewayConfig config;
        config.Node = name;
        config.Publish.push_back({.Message = "Pose", .Type = "Uav::Pose", .Qos = QosProfile::Telemetry});
        config.Subscribe.push_back({.Message = "Pose", .Type = "Uav::Pose"});
        config.Accept.push_back({.Queue = "Notes", .Types = {"Uav::Goto"}});
        if (change)
        {
            change(config);
        }
        SimulatedNode &node = Nodes.Add(config, 1.4e9 + std::chrono::duration<double>(Now()).count());
        Member &member = _members[name];
        member = {};
        member.Node = &node;
        member.Notes = &node.AddIdleManager("Notes");
        member.Pose = node.Register<Uav::Pose>("Pose");
        for (const std::string &other : _names)
        {
            if (other != name)
            {
                member.Others[other] = node.Register<Uav::Pose>(other + "/Pose");
                Of(name, other).States.clear();
            }
        }
        return node;
    }

    void StartAll(const std::function<void(GatewayConfig &)> &change = {})
    {
        for (const std::string &name : _names)
        {
            Start(name, change);
        }
    }

    void Kill(const std::string &name)
    {
        Nodes.Kill(name);
        _members.erase(name);
    }

    // From now on `from` sends `to` so many notes a second; or one in each period, 0 ends it.
    void Send(const std::string &from, const std::string &to, int perSecond)
    {
        SendEach(from, to, perSecond == 0 ? Duration(0) : Duration(std::chrono::seconds(1)) / perSecond);
    }
    void SendEach(const std::string &from, const std::string &to, Duration period)
    {
        Of(from, to).Period = period;
        Of(from, to).Next = Now();
    }

    void RunFor(Duration duration)
    {
        for (const Duration end = Now() + duration; Now() < end;)
        {
            for (auto &[name, member] : _members)
            {
                Act(name, member);
            }
            Nodes.RunFor(Step);
            for (auto &[name, member] : _members)
            {
                Look(name, member);
            }
        }
    }

    Duration Now() const { return Nodes.Network.Now(); }
    Watch &Of(const std::string &node, const std::string &other) { return _watches[{node, other}]; }
    SimulatedNode &operator[](const std::string &name) { return *_members.at(name).Node; }

    // Returns the states that `node` showed of `other`, from its first UP after `since` on.
    std::vector<std::string> StatesSince(const std::string &node, const std::string &other,
                                         Duration since = Duration(0))
    {
        std::vector<std::string> states;
        for (const auto &[at, state] : Of(node, other).States)
        {
            if (at >= since && (state == "UP" || !states.empty()))
            {
                states.push_back(state);
            }
        }
        return states;
    }

    // Returns the time from `since` until `node` showed `other` in that state; Duration::max() if it never
    // did.
    Duration Until(const std::string &node, const std::string &other, const std::string &state,
                   Duration since)
    {
        for (const auto &[at, shown] : Of(node, other).States)
        {
            if (at >= since && shown == state)
            {
                return at - since;
            }
        }
        return Duration::max();
    }

    // Returns the time from `since` until the first of these arrived; Duration::max() if none did.
    static Duration FirstAfter(const std::vector<Arrival> &arrivals, Duration since)
    {
        const auto first = std::find_if(arrivals.begin(), arrivals.end(),
                                        [since](const Arrival &arrival) { return arrival.At > since; });
        return first == arrivals.end() ? Duration::max() : first->At - since;
    }

    // Returns the delay within which 99 % of what arrived after `since` did so.
    static Duration P99(const std::vector<Arrival> &arrivals, Duration since = Duration(0))
    {
        std::vector<Duration> delays;
        for (const Arrival &arrival : arrivals)
        {
            if (arrival.At - arrival.Delay >= since)
            {
                delays.push_back(arrival.Delay);
            }
        }
        std::sort(delays.begin(), delays.end());
        return delays.empty() ? Duration::max() : delays[delays.size() * 99 / 100];
    }

    // All notes that were accepted have arrived, each once and in order.
    void ExpectAllNotes()
    {
        for (const auto &[pair, watch] : _watches)
        {
            EXPECT_EQ(watch.Notes.size(), watch.Accepted) << pair.first << " to " << pair.second;
        }
    }

    // While a queue is closed, nothing is taken from it.
    void Close(const std::string &name, bool isClosed = true) { _members.at(name).IsClosed = isClosed; }

    SimulatedFleet Nodes;

private:
    struct Member
    {
        SimulatedNode *Node = nullptr;
        IdleManager *Notes = nullptr;
        std::shared_ptr<Uav::Pose> Pose;
        std::map<std::string, std::shared_ptr<Uav::Pose>> Others;
        Duration NextPose{0};
        bool IsClosed = false;
    };

    void Act(const std::string &name, Member &member)
    {
        if (Now() >= member.NextPose)
        {
            member.NextPose = Now() + PosePeriod;
            _posedAt.push_back(Now());
            member.Pose->number = static_cast<std::uint32_t>(_posedAt.size());
            member.Pose->PostMessage();
        }
        for (const std::string &other : _names)
        {
            Watch &watch = Of(name, other);
            while (watch.Period > Duration(0) && Now() >= watch.Next)
            {
                watch.Next += watch.Period;
                auto note = std::make_shared<Uav::Goto>();
                note->id = static_cast<std::uint32_t>(_sent.size() + 1);
                if (member.Node->Workspace.AddMessageToQueue(other + "/Notes", note))
                {
                    _sent.push_back({{name, other}, Now()});
                    ++watch.Accepted;
                }
            }
        }
    }

    void Look(const std::string &name, Member &member)
    {
        const Gateway::Fleet fleet = member.Node->Fleet();
        for (const Gateway::NodeStatus &status : fleet.nodes)
        {
            auto &states = Of(name, status.node).States;
            if (states.empty() || states.back().second != ToString(status.state))
            {
                states.emplace_back(Now(), ToString(status.state));
            }
        }
        for (auto &[other, pose] : member.Others)
        {
            if (pose->FetchMessage() && pose->WasPosted())
            {
                Of(name, other).Poses.push_back({Now(), Now() - _posedAt.at(pose->number - 1)});
            }
        }
        std::shared_ptr<RabitMessage> message;
        while (!member.IsClosed && member.Notes->GetManagerMessageQueue()->GetMessage(message))
        {
            const std::uint32_t id = dynamic_cast<const Uav::Goto &>(*message).id;
            const auto &[pair, at] = _sent.at(id - 1);
            ASSERT_EQ(pair.second, name);
            Watch &watch = _watches.at(pair);
            ASSERT_LT(watch.Newest, id) << pair.first << " to " << name << ": twice or out of order";
            watch.Newest = id;
            watch.Notes.push_back({Now(), Now() - at});
        }
    }

    const std::vector<std::string> _names;
    std::map<std::string, Member> _members;
    std::map<Pair, Watch> _watches;
    std::vector<Duration> _posedAt;                // by number of the pose
    std::vector<std::pair<Pair, Duration>> _sent;  // by id of the note
};

}  // namespace Rabit
