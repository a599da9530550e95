// The three managers of an aircraft.
#pragma once

#include "Rules.h"

#include <rabit/RabitManager.h>
#include <rabit/gateway/Fleet.h>
#include <rabit/gateway/FleetValues.h>

#include <memory>
#include <string>
#include <utility>

namespace Formation
{

// Moves the aircraft, 50 times a second: fetches Wish, the wanted velocity, and posts Pose.
class Dynamics : public Rabit::RabitManager
{
public:
    Dynamics(const std::string &node, const Settings &settings, Rabit::RabitWorkspace &workspace)
        : RabitManager("Dynamics", workspace)
    {
        AddPublishSubscribeMessage("Wish", _wish);
        AddPublishSubscribeMessage("Pose", _pose);
        _pose->north_m = SlotOf(node, settings.SpacingM).real();
        _pose->east_m = SlotOf(node, settings.SpacingM).imag();
        SetPeriodSec(0.02);
    }
    void ExecuteUnitOfWork() final
    {
        _wish->FetchMessage();
        const bool isFresh = _wish->GetAgeSeconds() < 0.5;
        Move(*_pose, isFresh ? Vector{_wish->north_mps, _wish->east_mps} : Vector(), GetPeriodSec());
        _pose->PostMessage();
    }

private:
    std::shared_ptr<Pose> _wish = std::make_shared<Pose>();
    std::shared_ptr<Pose> _pose = std::make_shared<Pose>();
};

// Keeps the place in the formation, 10 times a second: fetches Leader and the poses of all, posts Wish.
class Keeper : public Rabit::RabitManager
{
public:
    Keeper(std::string node, const Settings &settings, Rabit::RabitWorkspace &workspace)
        : RabitManager("Keeper", workspace), _node(std::move(node)), _settings(settings)
    {
        AddPublishSubscribeMessage("Pose", _pose);
        AddPublishSubscribeMessage("Leader", _leader);
        AddPublishSubscribeMessage("Wish", _wish);
        SetPeriodSec(0.1);
    }
    void ExecuteUnitOfWork() final
    {
        _pose->FetchMessage();
        _leader->FetchMessage();
        _poses.Fetch();
        std::map<std::string, Other> others;
        for (const auto &[node, pose] : _poses.All())
            others[node] = {*pose, pose->GetAgeSeconds()};
        const Vector wanted = Decide(_node, *_pose, *_leader, others, _settings);
        _wish->north_mps = wanted.real();
        _wish->east_mps = wanted.imag();
        _wish->PostMessage();
    }

private:
    const std::string _node;
    const Settings _settings;
    Rabit::FleetValues<Pose> _poses{*this, "Pose"};
    std::shared_ptr<Pose> _pose = std::make_shared<Pose>();
    std::shared_ptr<Leader> _leader = std::make_shared<Leader>();
    std::shared_ptr<Pose> _wish = std::make_shared<Pose>();
};

// Posts Leader: of the aircraft that are UP, the one whose name comes first. Takes Lead in its queue.
class Election : public Rabit::RabitManager
{
public:
    Election(std::string node, Rabit::RabitWorkspace &workspace)
        : RabitManager("Election", workspace), _node(std::move(node))
    {
        AddPublishSubscribeMessage("Gateway/Fleet", _fleet);
        AddPublishSubscribeMessage("Leader", _leader);
        WakeUpManagerOnMessagePost(_fleet);
    }
    void ExecuteUnitOfWork() final
    {
        _fleet->FetchMessage();
        _leaders.Fetch();
        Leader now = *_leader;
        now.node = _node;
        for (const auto &node : _fleet->nodes)
            if (node.state == Rabit::Gateway::NodeState::UP && _leaders.Of(node.node) && node.node < now.node)
                now.node = node.node;
        // The goal of the leader is that of all, so that the next leader knows it.
        if (const Leader *const led = _leaders.Of(now.node); led && led->node == now.node)
            now = *led;
        TakeOrders(now);
        if (now.node != _leader->node)
            WriteLog(Rabit::RabitLogLevel::Info, now.node + " leads");
        if (now == *_leader)
            return;
        *_leader = now;
        _leader->PostMessage();
    }

private:
    void TakeOrders(Leader &now)
    {
        std::shared_ptr<Rabit::RabitMessage> message;
        while (GetManagerMessageQueue()->GetMessage(message))
            if (const auto *const lead = dynamic_cast<const Lead *>(message.get()))
            {
                if (now.node == _node)
                {
                    now.has_goal = true;
                    now.north_m = lead->north_m;
                    now.east_m = lead->east_m;
                }
                auto reply = std::make_shared<LeadReply>();
                reply->id = lead->id;
                reply->leader = now.node;
                AddMessageToQueue(lead->reply_to, reply);
            }
    }

    const std::string _node;
    Rabit::FleetValues<Leader> _leaders{*this, "Leader", Rabit::FleetValues<Leader>::Wake::OnEach};
    std::shared_ptr<Rabit::Gateway::Fleet> _fleet = std::make_shared<Rabit::Gateway::Fleet>();
    std::shared_ptr<Leader> _leader = std::make_shared<Leader>();
};

}  // namespace Formation
