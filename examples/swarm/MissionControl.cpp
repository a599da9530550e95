#include "MissionControl.h"

#include <algorithm>
#include <limits>
#include <utility>

namespace Swarm
{
namespace
{
constexpr std::size_t MaxText = 128;  // bound of the text in MissionState
}

MissionControl::MissionControl(const Names &names, const std::string &ground, const Floor &floor,
                               Rabit::RabitWorkspace &workspace)
    : RabitManager(names.Own("MissionControl"), workspace),
      _names(names),
      _hasFloor(floor.LowestM().has_value()),
      _mission(names.Aircraft(), *this, floor),
      _others(names, *this)
{
    AddPublishSubscribeMessage(names.Of(ground, "Geofence"), _fence);
    AddPublishSubscribeMessage(names.Of(ground, "SearchArea"), _area);
    AddPublishSubscribeMessage(names.Own("Pose"), _pose);
    AddPublishSubscribeMessage(names.Own("FlightMode"), _mode);
    AddPublishSubscribeMessage(names.Own("Health"), _health);
    AddPublishSubscribeMessage(names.OwnVision("Targets"), _targets);
    AddPublishSubscribeMessage(names.Own("MissionState"), _state);
    AddPublishSubscribeMessage(names.Own("Findings"), _findings);
    WakeUpManagerOnMessagePost(_fence);
    WakeUpManagerOnMessagePost(_area);
    WakeUpManagerOnMessagePost(_mode);
    WakeUpManagerOnMessagePost(_targets);
}

void MissionControl::Startup()
{
    if (!_hasFloor)
        WriteLog(Rabit::RabitLogLevel::Warning,
                 "there is no floor: points and search areas of any height are accepted");
}

void MissionControl::ExecuteUnitOfWork()
{
    _mission.Update(LookAround());
    TakeFence();
    TakeArea();
    TakeMessages();
    _mission.Act();
    _answers.Send(GetWorkspace().GetClock().Monotonic(),
                  [&](const std::string &to, const std::shared_ptr<Uav::CommandAck> &ack)
                  { return AddMessageToQueue(to, ack); });
    PostState();
    _acts.IsDue(*this);
    Rabit::RabitTimer::SleepUntilDue(*this, {&_acts, &_stateTimes});
}

Situation MissionControl::LookAround()
{
    _pose->FetchMessage();
    _mode->FetchMessage();
    _health->FetchMessage();
    _targets->FetchMessage();
    Situation now;
    now.NowS = std::chrono::duration<double>(GetWorkspace().GetClock().Monotonic()).count();
    now.GpsTimeS = GetWorkspace().GetClock().GpsTimeSeconds();
    if (_pose->WasPosted())
        now.Position = GeoPoint{_pose->latitude_deg, _pose->longitude_deg, _pose->altitude_m};
    now.BatteryPercent =
        _health->WasPosted() ? _health->battery_percent : std::numeric_limits<float>::quiet_NaN();
    now.WantsHome = _health->WasPosted() && _health->wants_home;
    now.Flight = *_mode;
    now.Targets = *_targets;
    now.Others = _others.Poses();
    now.OthersFindings = _others.Findings();
    return now;
}

// Before the area, which may lie in the new fence alone.
void MissionControl::TakeFence()
{
    if (_fence->FetchMessage() && _fence->WasPosted())
        Warn(_mission.Take(*_fence));
}

void MissionControl::TakeArea()
{
    if (!_area->FetchMessage() || !_area->WasPosted())
        return;
    Warn(_mission.Take(*_area));
}

void MissionControl::Warn(const std::string &problem)
{
    if (!problem.empty())
        WriteLog(Rabit::RabitLogLevel::Warning,
                 "search area " + std::to_string(_area->number) + " is declined: " + problem);
}

void MissionControl::TakeMessages()
{
    std::shared_ptr<Rabit::RabitMessage> message;
    while (GetManagerMessageQueue()->GetMessage(message))
    {
        if (const auto *toPoint = dynamic_cast<const Uav::Goto *>(message.get()))
            _mission.Take(*toPoint);
        else if (const auto *search = dynamic_cast<const Uav::Search *>(message.get()))
            _mission.Take(*search);
        else if (const auto *home = dynamic_cast<const Uav::GoHome *>(message.get()))
            _mission.Take(*home);
        else if (const auto *report = dynamic_cast<const Uav::TargetReport *>(message.get()))
            _mission.Take(*report);
        else if (const auto *validation = dynamic_cast<const Uav::Validation *>(message.get()))
            _mission.Take(*validation);
    }
}

std::uint32_t MissionControl::Fly(const GeoPoint &point, float speedMps)
{
    auto course = std::make_shared<Uav::Course>();
    course->number = _courses + 1;
    course->latitude_deg = point.LatitudeDeg;
    course->longitude_deg = point.LongitudeDeg;
    course->altitude_m = point.AltitudeM;
    course->speed_mps = speedMps;
    return AddMessageToQueue(_names.Own("Autopilot"), course) ? ++_courses : 0;
}

void MissionControl::Answer(const std::string &replyTo, const Uav::CommandAck &ack)
{
    const std::chrono::nanoseconds now = GetWorkspace().GetClock().Monotonic();
    _answers.Add(replyTo, ack, now);
    // The health monitor repeats its command each second while it is declined.
    if (ack.stage != Uav::CommandStage::COMMAND_DECLINED ||
        (ack.reason == _loggedDecline && now - _loggedDeclineAt < LogDeclineAgain))
        return;
    _loggedDecline = ack.reason;
    _loggedDeclineAt = now;
    WriteLog(
        Rabit::RabitLogLevel::Warning,
        (ack.id == 0 ? "a command" : "command " + std::to_string(ack.id)) + " is declined: " + ack.reason);
}

bool MissionControl::Send(const std::string &aircraft, const Uav::TargetReport &report)
{
    return AddMessageToQueue(_names.Of(aircraft, "MissionControl"),
                             std::make_shared<Uav::TargetReport>(report));
}

bool MissionControl::Send(const std::string &aircraft, const Uav::Validation &validation)
{
    return AddMessageToQueue(_names.Of(aircraft, "MissionControl"),
                             std::make_shared<Uav::Validation>(validation));
}

void MissionControl::PostState()
{
    Uav::MissionState state = *_state;
    _mission.Describe(state);
    const std::string answers = _answers.Text();
    if (!answers.empty())
        state.text = answers + (state.text.empty() ? "" : "; ") + state.text;
    for (std::string *text : {&state.text, &state.area_declined})
        text->resize(std::min(text->size(), MaxText));
    std::vector<Uav::Finding> findings = _mission.Findings();
    const bool due = _stateTimes.IsDue(*this);
    if (due || state != *_state)
    {
        *_state = state;
        _state->poses = _pose->number;
        _state->PostMessage();
    }
    if (due || findings != _findings->items)
    {
        _findings->items = std::move(findings);
        _findings->PostMessage();
    }
}

}  // namespace Swarm
