// Commands from the ground station and the health monitor.
#include "Fence.h"
#include "Mission.h"
#include "WhyNot.h"

#include <rabit/SystemTimeClock.h>

#include <utility>

namespace Swarm
{
namespace
{
// Text within the bound of MissionState.
std::string TextOf(const Uav::TargetName &name)
{
    constexpr std::size_t longest = 64;
    const std::string number = std::string("/").append(std::to_string(name.number));
    return name.aircraft.substr(0, longest - number.size()) + number;
}

// As HH:MM:SS.
std::string UtcOf(double gpsTimeS)
{
    return Rabit::SystemTimeClock::GetSystemTimeClock()->GetUTCTimeStringFromGpsTimeStamp(gpsTimeS).substr(
        11);
}
}  // namespace

Mission::Mission(std::string aircraft, MissionOutput &output, const Floor &floor)
    : _aircraft(aircraft), _output(output), _floor(floor), _book(std::move(aircraft))
{
}

void Mission::Update(Situation situation)
{
    _now = std::move(situation);
    if (!_home && _now.Position)
        _home = _now.Position;
    if (_now.Flight.phase == Uav::FlightPhase::FLIGHT_RECORDING)
        _hasTrack = true;
    if (_homeByItself && !_now.WantsHome)
    {
        _why += " (until " + UtcOf(_now.GpsTimeS) + " UTC)";
        _homeByItself = false;
    }
    _book.Follow(_now.Targets, _target);
}

std::string Mission::Take(const Uav::SearchArea &area)
{
    if (_area && area.number < _area->number)
        return "";
    _heardArea = area;
    JudgeArea();
    if (!_areaDeclined.empty())
        return _areaDeclined;
    _area = area;
    _mower.reset();
    if (_mode == Uav::MissionMode::MISSION_SEARCH)
        _mode = Uav::MissionMode::MISSION_TRANSIT;
    return "";
}

void Mission::JudgeArea()
{
    _areaDeclined = WhyNot(*_heardArea);
    if (_areaDeclined.empty())
        _areaDeclined = _floor.WhyTooLow(_heardArea->altitude_m);
    if (_areaDeclined.empty())
        _areaDeclined = WhyOutside(_fence, *_heardArea);
}

std::string Mission::Take(const Uav::Geofence &fence)
{
    if (fence == _fence)
        return "";
    _fence = fence;
    if (!_heardArea)
        return "";
    if (_area != _heardArea)
        return Take(Uav::SearchArea(*_heardArea));  // it was declined; it may be inside now
    JudgeArea();                                    // a search in that area goes on
    return _areaDeclined;
}

std::string Mission::WhyNotNow(bool mayBeTired) const
{
    if (!_now.Flight.not_ready.empty())
        return _now.Flight.not_ready;
    if (!mayBeTired && _now.BatteryPercent < LowBatteryPercent)
        return "the battery is low";
    return "";
}

template <typename Message>
void Mission::Decline(const Message &command, const std::string &reason)
{
    Uav::CommandAck ack;
    ack.id = command.id;
    ack.node = _aircraft;
    ack.stage = Uav::CommandStage::COMMAND_DECLINED;
    ack.reason = reason;
    _output.Answer(command.reply_to, ack);
    _declined = reason;
    _declinedS = _now.NowS;
}

// Ends the previous command and target, and begins this command.
template <typename Message>
void Mission::Accept(const Message &command, Uav::MissionMode mode)
{
    Finish(Uav::CommandStage::COMMAND_REPLACED, command.id == 0 ? "it goes home" : "", command.id);
    LeaveTarget(command.id == 0 ? "it goes home" : "it was commanded to do something else");
    _open = Command{command.id, command.reply_to};
    Uav::CommandAck ack;
    ack.id = command.id;
    ack.node = _aircraft;
    ack.stage = Uav::CommandStage::COMMAND_ACCEPTED;
    _output.Answer(command.reply_to, ack);
    if (command.id != 0)
    {
        _lastCommand = command.id;
        ++_commands;
    }
    _why.clear();
    _homeByItself = false;
    _declined.clear();
    _mode = mode;
    _modeSinceS = _now.NowS;
}

// Sends the final answer to the open command.
void Mission::Finish(Uav::CommandStage stage, const std::string &reason, std::uint32_t replacedBy)
{
    if (!_open)
        return;
    Uav::CommandAck ack;
    ack.id = _open->Id;
    ack.node = _aircraft;
    ack.stage = stage;
    ack.reason = reason;
    ack.replaced_by = replacedBy;
    _output.Answer(_open->ReplyTo, ack);
    _open.reset();
}

void Mission::Take(const Uav::Goto &command)
{
    std::string reason = WhyNot(command);
    if (reason.empty())
        reason = _floor.WhyTooLow(command.altitude_m);
    const GeoPoint point{command.latitude_deg, command.longitude_deg, command.altitude_m};
    if (reason.empty())
        reason = WhyOutside(_fence, point);
    if (reason.empty())
        reason = WhyNotNow(false);
    if (reason.empty() && !Fly(point, command.speed_mps))
        reason = "the autopilot takes no commands now";
    if (!reason.empty())
        return Decline(command, reason);
    Accept(command, Uav::MissionMode::MISSION_GOTO);
    _gotoPoint = point;
    _gotoSpeedMps = command.speed_mps;
}

void Mission::Take(const Uav::Search &command)
{
    std::string reason = WhyNotNow(false);
    if (reason.empty() && !_now.Position)
        reason = "it does not know yet where it is";
    if (reason.empty() && !_areaDeclined.empty())
        reason = "search area: " + _areaDeclined;
    if (reason.empty() && !_area)
        reason = "no search area is known";
    if (!reason.empty())
        return Decline(command, reason);
    Accept(command, Uav::MissionMode::MISSION_TRANSIT);
    _mower.reset();
}

void Mission::Take(const Uav::GoHome &command)
{
    std::string reason = WhyNotNow(true);
    if (reason.empty() && !_home)
        reason = "it does not know yet where home is";
    if (reason.empty() && !Fly(WhereHomeIs(), HomeSpeedMps))
        reason = "the autopilot takes no commands now";
    if (!reason.empty())
        return Decline(command, reason);
    Accept(command, Uav::MissionMode::MISSION_HOME);
    _why = command.reason;
    _homeByItself = _now.WantsHome && command.id == 0;
    _gotoPoint = WhereHomeIs();
    _gotoSpeedMps = HomeSpeedMps;
}

// The home point, raised to the floor: the aircraft may have started on the ground.
GeoPoint Mission::WhereHomeIs() const
{
    return {_home->LatitudeDeg, _home->LongitudeDeg, _floor.Raised(_home->AltitudeM)};
}

bool Mission::HasArrived() const
{
    return _now.Flight.phase == Uav::FlightPhase::FLIGHT_HOLD && _now.Flight.course == _course.Number &&
           _course.Number != 0;
}

bool Mission::Fly(const GeoPoint &point, float speedMps)
{
    const std::uint32_t number = _output.Fly(point, speedMps);
    if (number != 0)
        _course = {point, speedMps, number, _now.NowS};
    return number != 0;
}

// Also sends the course again if the autopilot flies another one, as after a silence of the autopilot.
void Mission::FlyIfMoved(const GeoPoint &point, float speedMps)
{
    const bool moved = _course.Number == 0 || _course.SpeedMps != speedMps ||
                       Between(_course.Point, point).LengthM() > StepM;
    const bool lost = _now.Flight.course != _course.Number && _now.NowS - _course.SentS > RepeatS;
    if (moved || lost)
        Fly(point, speedMps);
}

void Mission::Act()
{
    switch (_mode)
    {
        case Uav::MissionMode::MISSION_IDLE:
            return;
        case Uav::MissionMode::MISSION_GOTO:
        case Uav::MissionMode::MISSION_HOLD:
        case Uav::MissionMode::MISSION_HOME:
            return ActOnCommand();
        case Uav::MissionMode::MISSION_TRANSIT:
        case Uav::MissionMode::MISSION_SEARCH:
            return ActOnSearch();
        case Uav::MissionMode::MISSION_CONFIRM:
            return ActOnConfirm();
        case Uav::MissionMode::MISSION_VALIDATE:
            return ActOnValidate();
        case Uav::MissionMode::MISSION_TRACK:
            return ActOnTrack();
    }
}

void Mission::ActOnCommand()
{
    FlyIfMoved(_gotoPoint, _gotoSpeedMps);
    if (!HasArrived())
        return;
    Finish(Uav::CommandStage::COMMAND_DONE, "");
    if (_mode == Uav::MissionMode::MISSION_GOTO)
    {
        _mode = Uav::MissionMode::MISSION_HOLD;
        _modeSinceS = _now.NowS;
    }
    else if (_mode == Uav::MissionMode::MISSION_HOLD && _hasTrack &&
             _now.NowS - _modeSinceS >= BackToTrackS && Fly(_gotoPoint, 0))
        _mode = Uav::MissionMode::MISSION_IDLE;
}

void Mission::Describe(Uav::MissionState &state) const
{
    state.mode = _mode;
    state.last_command = _lastCommand;
    state.commands = _commands;
    state.search_area = _area ? _area->number : 0;
    state.target.clear();
    state.partner.clear();
    if (_mode == Uav::MissionMode::MISSION_VALIDATE)
    {
        state.target = TextOf(_report.name);
        state.partner = _report.seen_by;
    }
    else if (const Uav::Finding *const finding = _book.Find(_target))
    {
        state.target = TextOf(finding->name);
        state.partner = _partner;
    }
    const bool tellsDeclined = !_declined.empty() && _now.NowS - _declinedS < DeclinedShownS;
    state.text = tellsDeclined ? "declined: " + _declined + (_why.empty() ? "" : "; " + _why) : _why;
    state.area_declined = _areaDeclined;
    state.has_floor = _floor.LowestM().has_value();
    state.floor_m = static_cast<float>(_floor.LowestM().value_or(0));
    state.has_ground = _floor.GroundM().has_value();
    state.ground_m = static_cast<float>(_floor.GroundM().value_or(0));
    state.has_home = _home.has_value();
    state.home_latitude_deg = _home ? static_cast<float>(_home->LatitudeDeg) : 0;
    state.home_longitude_deg = _home ? static_cast<float>(_home->LongitudeDeg) : 0;
}

}  // namespace Swarm
