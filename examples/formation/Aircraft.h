// The three managers of an aircraft.
#pragma once

#include "Rules.h"

#include <rabit/RabitManager.h>
#include <rabit/gateway/Claims.h>
#include <rabit/gateway/FleetValues.h>
#include <rabit/gateway/SharedTable.h>

#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>

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

// Keeps the place in the formation, 10 times a second: fetches the poses of all, posts Wish.
class Keeper : public Rabit::RabitManager
{
public:
    Keeper(const Settings &settings, Rabit::GatewayConfig &config, Rabit::RabitWorkspace &workspace)
        : RabitManager("Keeper", workspace),
          _node(config.Node),
          _settings(settings),
          _claims(config),
          _table(config)
    {
        AddPublishSubscribeMessage("Pose", _pose);
        AddPublishSubscribeMessage("Wish", _wish);
        SetPeriodSec(0.1);
    }
    void ExecuteUnitOfWork() final
    {
        _pose->FetchMessage();
        _poses.Fetch();
        std::map<std::string, Other> others;
        for (const auto &[node, pose] : _poses.All())
            others[node] = {*pose, pose->GetAgeSeconds()};
        // This aircraft leads only while it holds the claim; of others it knows what it has heard.
        const Leader leader{_claims.IsLeader() ? _node : _claims.Leader(),
                            GoalOf(_table.Text("goal").value_or(""))};
        const Vector wanted = Decide(_node, *_pose, leader, others, _settings);
        _wish->north_mps = wanted.real();
        _wish->east_mps = wanted.imag();
        _wish->PostMessage();
    }

private:
    const std::string _node;
    const Settings _settings;
    Rabit::Claims _claims;
    Rabit::SharedTable _table;
    Rabit::FleetValues<Pose> _poses{*this, "Pose"};
    std::shared_ptr<Pose> _pose = std::make_shared<Pose>();
    std::shared_ptr<Pose> _wish = std::make_shared<Pose>();
};

// Asks for the lead, which at most one aircraft has. Takes Lead in its queue while it leads. The goal is in
// the shared table, so that the next leader knows it.
class Leadership : public Rabit::RabitManager
{
public:
    Leadership(Rabit::GatewayConfig &config, Rabit::RabitWorkspace &workspace)
        : RabitManager("Leadership", workspace), _claims(config), _table(config)
    {
        SetPeriodSec(0.2);
        SetWakeupBetweenTurns(true);  // orders are handled at once
        _claims.BeLeader();
    }
    void ExecuteUnitOfWork() final
    {
        TakeOrders();
        const std::string leader = _claims.Leader();
        if (leader == _leader)
            return;
        WriteLog(Rabit::RabitLogLevel::Info,
                 leader.empty() ? "no leader: this aircraft holds its position" : leader + " leads");
        _leader = leader;
    }

private:
    void TakeOrders()
    {
        std::shared_ptr<Rabit::RabitMessage> message;
        while (GetManagerMessageQueue()->GetMessage(message))
            if (const auto *const lead = dynamic_cast<const Lead *>(message.get()))
            {
                const std::optional<std::uint64_t> fence = _claims.FenceOf(Rabit::Claims::Leadership);
                auto reply = std::make_shared<LeadReply>();
                reply->id = lead->id;
                if (fence && _table.Write("goal", TextOf({lead->north_m, lead->east_m})).empty())
                    reply->fence = *fence;
                AddMessageToQueue(lead->reply_to, reply);
            }
    }

    Rabit::Claims _claims;
    Rabit::SharedTable _table;
    std::string _leader;  // of which it has told; empty: none
};

}  // namespace Formation
