#pragma once

#include "Names.h"
#include "OtherAircraft.h"
#include "mission/Answers.h"
#include "mission/Mission.h"
#include "uav.idl.h"

#include <rabit/RabitManager.h>
#include <rabit/RabitTimer.h>

#include <chrono>
#include <cstdint>
#include <memory>
#include <string>

namespace Swarm
{

// Controls the mission of the aircraft: the manager `MissionControl`. Class Mission decides; this class
// gives it the data, and carries out its decisions.
//
// Queue:   MissionControl takes Uav::Goto, Uav::GoHome and Uav::Search, and answers with Uav::CommandAck to
//          the queue that the command names in reply_to; and from the other aircraft Uav::TargetReport and
//          Uav::Validation.
// Fetches: SearchArea and Geofence of the ground station; Pose, FlightMode, Health and Targets of this
//          aircraft; Pose and Findings of the others.
// Posts:   MissionState (Uav::MissionState) and Findings (Uav::Findings), when they change and every second.
// Sends:   Uav::Course to the queue Autopilot; TargetReport and Validation to the queue MissionControl of
//          other aircraft.
class MissionControl : public Rabit::RabitManager, private MissionOutput
{
public:
    static constexpr std::chrono::seconds StatePeriod{1};
    static constexpr std::chrono::milliseconds ActPeriod{200};

    // `ground` is the node of the ground station whose SearchArea and Geofence are used.
    MissionControl(const Names &names, const std::string &ground = "ground", const Floor &floor = Floor(),
                   Rabit::RabitWorkspace &workspace = *Rabit::RabitWorkspace::GetWorkspace());

    void Startup() final;
    void ExecuteUnitOfWork() final;

private:
    // The same reason is logged once in this time.
    static constexpr std::chrono::seconds LogDeclineAgain{10};

    std::uint32_t Fly(const GeoPoint &point, float speedMps) override;
    void Answer(const std::string &replyTo, const Uav::CommandAck &ack) override;
    bool Send(const std::string &aircraft, const Uav::TargetReport &report) override;
    bool Send(const std::string &aircraft, const Uav::Validation &validation) override;

    Situation LookAround();
    void TakeFence();
    void TakeArea();
    void Warn(const std::string &problem);
    void TakeMessages();
    void PostState();

    const Names _names;
    const bool _hasFloor;
    Mission _mission;
    Answers _answers;
    OtherAircraft _others;
    Rabit::RabitTimer _acts{ActPeriod};
    Rabit::RabitTimer _stateTimes{StatePeriod};
    std::uint32_t _courses = 0;
    std::string _loggedDecline;
    std::chrono::nanoseconds _loggedDeclineAt{0};
    std::shared_ptr<Uav::Geofence> _fence = std::make_shared<Uav::Geofence>();
    std::shared_ptr<Uav::SearchArea> _area = std::make_shared<Uav::SearchArea>();
    std::shared_ptr<Uav::Pose> _pose = std::make_shared<Uav::Pose>();
    std::shared_ptr<Uav::FlightMode> _mode = std::make_shared<Uav::FlightMode>();
    std::shared_ptr<Uav::Health> _health = std::make_shared<Uav::Health>();
    std::shared_ptr<Uav::Targets> _targets = std::make_shared<Uav::Targets>();
    std::shared_ptr<Uav::MissionState> _state = std::make_shared<Uav::MissionState>();
    std::shared_ptr<Uav::Findings> _findings = std::make_shared<Uav::Findings>();
};

}  // namespace Swarm
