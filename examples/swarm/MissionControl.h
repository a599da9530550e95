#pragma once

#include "Schedule.h"
#include "uav.idl.h"

#include <rabit/RabitManager.h>

#include <chrono>
#include <cstddef>
#include <deque>
#include <memory>
#include <string>

namespace Swarm
{

// Why the aircraft will not obey this command; empty if it will.
std::string WhyNot(const Uav::Goto &command);

// Takes commands from outside and answers each of them: the manager `MissionControl`.
//
// Queue:   MissionControl takes Uav::Goto. What can be flown goes on as a Uav::Course to the queue Autopilot,
//          and the answer, a Uav::CommandAck, to the queue that the command names in reply_to, on whatever
//          node that is.
// Posts:   MissionState (Uav::MissionState), when it changes and every second.
// Fetches: Pose and FlightMode of the Autopilot.
//
// The gateway does the rest of the way: an answer that it has accepted arrives. One that it refuses (because
// it has not yet heard of the other node, or too much waits for it already) is kept here and tried again, for
// 30 seconds.
class MissionControl : public Rabit::RabitManager
{
public:
    static constexpr std::chrono::seconds StatePeriod{1};
    static constexpr std::chrono::milliseconds RetryPeriod{200};
    static constexpr std::chrono::seconds KeepAnswers{30};
    static constexpr std::size_t MaxKeptAnswers = 1000;

    // `node` is the name of this aircraft, which goes into its answers.
    MissionControl(std::string node,
                   Rabit::RabitWorkspace &workspace = *Rabit::RabitWorkspace::GetWorkspace());

    void ExecuteUnitOfWork() final;

private:
    struct Answer
    {
        std::string To;
        std::shared_ptr<Uav::CommandAck> Ack;
        std::chrono::nanoseconds Since;
    };

    void TakeCommands(std::chrono::nanoseconds now);
    void Obey(const std::shared_ptr<Uav::Goto> &command, std::chrono::nanoseconds now);
    void SendAnswers(std::chrono::nanoseconds now);
    void PostState(std::chrono::nanoseconds now);
    std::string StateText() const;

    const std::string _node;
    Schedule _stateTimes{StatePeriod};
    std::deque<Answer> _answers;  // not yet accepted for sending
    std::size_t _answersGivenUp = 0;
    std::shared_ptr<Uav::Pose> _pose = std::make_shared<Uav::Pose>();
    std::shared_ptr<Uav::FlightMode> _mode = std::make_shared<Uav::FlightMode>();
    std::shared_ptr<Uav::MissionState> _state = std::make_shared<Uav::MissionState>();
};

}  // namespace Swarm
