// The manager of the ground program.
#pragma once

#include "Rules.h"

#include <rabit/RabitManager.h>
#include <rabit/RabitRequests.h>
#include <rabit/gateway/Claims.h>
#include <rabit/gateway/FleetValues.h>

#include <algorithm>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <iostream>
#include <limits>
#include <memory>
#include <string>

namespace Formation
{

// Sends the formation back and forth, and prints what becomes of it. Takes LeadReply in its queue.
class Director : public Rabit::RabitManager
{
public:
    Director(int aircraft, double legM, double spacingM, Rabit::GatewayConfig &config,
             Rabit::RabitWorkspace &workspace, std::ostream &out = std::cout)
        : RabitManager("Director", workspace),
          _aircraft(aircraft),
          _legM(legM),
          _spacingM(spacingM),
          _goal(legM),
          _out(out),
          _claims(config)
    {
        SetPeriodSec(0.2);
        SetWakeupBetweenTurns(true);  // replies are handled at once
    }
    void ExecuteUnitOfWork() final
    {
        TakeReplies();
        if (!IsTurn())
            return;
        LookForCollisions();
        const std::string leader = LeaderThatIsHeard();
        if (leader.empty())
            return;
        if (leader != _leader)
        {
            _out << "leader " << (_leader = leader) << std::endl;
            _accepted = false;  // the former leader may have told nobody of its goal
        }
        if (_accepted && std::abs(PlaceOf(*_poses.Of(leader)) - SlotOf(leader, _spacingM) - _goal) < 2)
        {
            _out << "reached " << _goal.real() << " m, closest " << _closestM << " m" << std::endl;
            _closestM = std::numeric_limits<double>::infinity();
            _goal = _legM - _goal;
            _accepted = false;
        }
        if (!_accepted && _requests.NumberOfOpen() == 0)
            Send(leader + "/Leadership");
    }

private:
    void Send(const std::string &queue)
    {
        auto lead = std::make_shared<Lead>();
        lead->id = _requests.NextId();
        lead->reply_to = "ground/Director";
        lead->north_m = _goal.real();
        lead->east_m = _goal.imag();
        _requests.Send(queue, lead);
    }
    void TakeReplies()
    {
        std::shared_ptr<Rabit::RabitMessage> message;
        while (GetManagerMessageQueue()->GetMessage(message))
            if (const auto reply = std::dynamic_pointer_cast<const LeadReply>(message))
                _requests.Take(reply->id, reply);
        for (const auto &request : _requests.TakeEnded())
        {
            // 0: declined. A former leader has a lower fence than a later one.
            const std::uint64_t fence = request.Answer ? request.Answer->fence : 0;
            _accepted = request.Queue == _leader + "/Leadership" && fence > 0 && fence >= _fence;
            _fence = std::max(_fence, fence);
            _out << request.Queue << ": " << (_accepted ? "accepted" : ToString(request.End)) << std::endl;
        }
    }
    // Empty while there is none, it is not heard, or not all aircraft have come yet.
    std::string LeaderThatIsHeard()
    {
        const auto heard = _poses.YoungerThan(1);
        _aircraft = heard.size() >= static_cast<std::size_t>(_aircraft) ? 0 : _aircraft;
        const std::string leader = _claims.Leader();
        return _aircraft == 0 && heard.contains(leader) ? leader : "";
    }
    void LookForCollisions()
    {
        _poses.Fetch();
        const auto poses = _poses.YoungerThan(0.3);
        for (const auto &[one, pose] : poses)
            for (const auto &[other, there] : poses)
                if (one != other)
                    _closestM = std::min(_closestM, std::abs(PlaceOf(*pose) - PlaceOf(*there)));
    }

    int _aircraft;  // to wait for; 0: all came
    const double _legM;
    const double _spacingM;
    Vector _goal;
    std::ostream &_out;
    Rabit::Claims _claims;
    Rabit::FleetValues<Pose> _poses{*this, "Pose"};
    Rabit::RabitRequests<LeadReply> _requests{*this, std::chrono::seconds(3)};
    std::string _leader;
    std::uint64_t _fence = 0;  // the highest one of a leader
    bool _accepted = false;
    double _closestM = std::numeric_limits<double>::infinity();  // of two aircraft, on the way to this goal
};

}  // namespace Formation
