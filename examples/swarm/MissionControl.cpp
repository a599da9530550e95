#include "MissionControl.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace Swarm
{
namespace
{
constexpr double MinAltitudeM = -500;
constexpr double MaxAltitudeM = 10000;
constexpr double MaxSpeedMps = 50;

Uav::MissionMode ModeOf(Uav::FlightPhase phase)
{
    switch (phase)
    {
        case Uav::FlightPhase::FLIGHT_COURSE:
            return Uav::MissionMode::MISSION_GOTO;
        case Uav::FlightPhase::FLIGHT_HOLD:
            return Uav::MissionMode::MISSION_HOLD;
        case Uav::FlightPhase::FLIGHT_IDLE:
        case Uav::FlightPhase::FLIGHT_RECORDING:
        case Uav::FlightPhase::FLIGHT_PATTERN:
            break;
    }
    return Uav::MissionMode::MISSION_IDLE;
}

// The number of the course is that of the command.
std::shared_ptr<Uav::Course> CourseOf(const Uav::Goto &command)
{
    auto course = std::make_shared<Uav::Course>();
    course->number = command.id;
    course->latitude_deg = command.latitude_deg;
    course->longitude_deg = command.longitude_deg;
    course->altitude_m = command.altitude_m;
    course->speed_mps = command.speed_mps;
    return course;
}
}  // namespace

std::string WhyNot(const Uav::Goto &command)
{
    // Written so that a NaN is refused as well.
    if (!(std::abs(command.latitude_deg) <= 90))
        return "latitude_deg is not between -90 and 90";
    if (!(std::abs(command.longitude_deg) <= 180))
        return "longitude_deg is not between -180 and 180";
    if (!(command.altitude_m >= MinAltitudeM && command.altitude_m <= MaxAltitudeM))
        return "altitude_m is not between -500 and 10000";
    if (!(command.speed_mps > 0 && command.speed_mps <= MaxSpeedMps))
        return "speed_mps is not above 0 and up to 50";
    return "";
}

MissionControl::MissionControl(std::string node, Rabit::RabitWorkspace &workspace)
    : RabitManager("MissionControl", workspace), _node(std::move(node))
{
    AddPublishSubscribeMessage("Pose", _pose);
    AddPublishSubscribeMessage("FlightMode", _mode);
    AddPublishSubscribeMessage("MissionState", _state);
    WakeUpManagerOnMessagePost(_mode);
}

void MissionControl::ExecuteUnitOfWork()
{
    const std::chrono::nanoseconds now = GetWorkspace().GetClock().Monotonic();
    TakeCommands(now);
    SendAnswers(now);
    PostState(now);
    const int delay = _stateTimes.DelayMSec(GetWorkspace().GetClock().Monotonic());
    SetWakeupTimeDelayMSec(_answers.empty() ? delay : std::min(delay, static_cast<int>(RetryPeriod.count())));
}

void MissionControl::TakeCommands(std::chrono::nanoseconds now)
{
    std::shared_ptr<Rabit::RabitMessage> message;
    while (GetManagerMessageQueue()->GetMessage(message))
        if (const auto command = std::dynamic_pointer_cast<Uav::Goto>(message))
            Obey(command, now);
}

void MissionControl::Obey(const std::shared_ptr<Uav::Goto> &command, std::chrono::nanoseconds now)
{
    std::string reason = WhyNot(*command);
    _mode->FetchMessage();
    if (reason.empty())
        reason = _mode->not_ready;
    if (reason.empty() && !AddMessageToQueue("Autopilot", CourseOf(*command)))
        reason = "the autopilot takes no commands now";
    if (reason.empty())
    {
        _state->last_command = command->id;
        ++_state->commands;
    }
    if (command->reply_to.empty())
        return;  // nobody wants an answer
    if (_answers.size() == MaxKeptAnswers)
    {
        _answers.pop_front();
        ++_answersGivenUp;
    }
    auto ack = std::make_shared<Uav::CommandAck>();
    ack->id = command->id;
    ack->node = _node;
    ack->stage = reason.empty() ? Uav::CommandStage::COMMAND_ACCEPTED : Uav::CommandStage::COMMAND_DECLINED;
    ack->reason = reason;
    _answers.push_back({command->reply_to, std::move(ack), now});
}

void MissionControl::SendAnswers(std::chrono::nanoseconds now)
{
    std::deque<Answer> kept;
    for (Answer &answer : _answers)
    {
        if (AddMessageToQueue(answer.To, answer.Ack))
            continue;
        if (now - answer.Since < KeepAnswers)
            kept.push_back(std::move(answer));
        else
            ++_answersGivenUp;
    }
    _answers = std::move(kept);
}

void MissionControl::PostState(std::chrono::nanoseconds now)
{
    _mode->FetchMessage();
    _pose->FetchMessage();
    const std::string text = StateText();
    const bool changed = _state->mode != ModeOf(_mode->phase) || _state->text != text;
    if (!_stateTimes.Due(now) && !changed)
        return;
    _state->mode = ModeOf(_mode->phase);
    _state->text = text;
    _state->poses = _pose->number;
    _state->PostMessage();
}

std::string MissionControl::StateText() const
{
    std::string text;
    if (_mode->course != 0)
        text = "command " + std::to_string(_mode->course);
    if (!_answers.empty())
        text += (text.empty() ? "" : ", ") + std::to_string(_answers.size()) + " answers wait";
    if (_answersGivenUp > 0)
        text += (text.empty() ? "" : ", ") + std::to_string(_answersGivenUp) + " answers given up";
    return text;
}

}  // namespace Swarm
