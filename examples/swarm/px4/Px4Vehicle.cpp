#include "Px4Vehicle.h"

#include <rabit/RabitLog.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

namespace Swarm
{
namespace
{

namespace Command = px4_msgs::msg::VehicleCommand_Constants;
namespace Answer = px4_msgs::msg::VehicleCommandAck_Constants;
namespace Status = px4_msgs::msg::VehicleStatus_Constants;

// Positions come about ten times a second; polling five times as often keeps them fresh.
constexpr int PollMSec = 20;
// MAV_DO_REPOSITION_FLAGS_CHANGE_MODE: fly there in any present mode.
constexpr float ChangeMode = 1;
constexpr std::uint8_t CompanionComputer = 191;  // MAV_COMP_ID_ONBOARD_COMPUTER

std::string NameOf(std::uint8_t result)
{
    switch (result)
    {
        case Answer::VEHICLE_CMD_RESULT_TEMPORARILY_REJECTED:
            return "rejected for now";
        case Answer::VEHICLE_CMD_RESULT_DENIED:
            return "denied";
        case Answer::VEHICLE_CMD_RESULT_UNSUPPORTED:
            return "not supported";
        case Answer::VEHICLE_CMD_RESULT_FAILED:
            return "failed";
        default:
            return "result " + std::to_string(result);
    }
}

// PX4 publishes positions before it has a valid one. Older versions have no flags for that.
template <typename GlobalPosition>
bool IsKnown(const GlobalPosition &position)
{
    bool known = std::isfinite(position.lat) && std::isfinite(position.lon) && std::isfinite(position.alt);
    if constexpr (requires { position.lat_lon_valid &&position.alt_valid; })
    {
        known = known && position.lat_lon_valid && position.alt_valid;
    }
    return known;
}

bool IsVelocityKnown(const px4_msgs::msg::VehicleLocalPosition &local)
{
    return std::isfinite(local.vx) && std::isfinite(local.vy) && std::isfinite(local.vz);
}

void Register(Rabit::RabitWorkspace &workspace, const std::string &name,
              std::shared_ptr<Rabit::RabitMessage> message)
{
    if (!workspace.AddPublishSubscribeMessage(name, std::move(message)))
    {
        throw std::logic_error("the message " + name + " is of another type");
    }
}

}  // namespace

Px4Vehicle::Px4Vehicle(Rabit::RabitWorkspace &workspace)
{
    Register(workspace, "Px4/Status", _status);
    Register(workspace, "Px4/Position", _position);
    Register(workspace, "Px4/LocalPosition", _local);
    Register(workspace, "Px4/Attitude", _attitude);
    Register(workspace, "Px4/Ack", _answer);
    Register(workspace, "Px4/Command", _command);
}

bool Px4Vehicle::IsHeard() const
{
    return _status->GetAgeSeconds() <= SilentAfterS;
}

bool Px4Vehicle::IsArmed() const
{
    return _status->arming_state == Status::ARMING_STATE_ARMED;
}

std::optional<Motion> Px4Vehicle::Update(Time now)
{
    _status->FetchMessage();
    TakeAnswer(now);
    if (_awaitsAnswer && _attempts > 0 && IsHeard() && _repeats.IsDue(now))
    {
        SendCommand(now);
    }
    const bool came = _position->FetchMessage() && _position->WasPosted();
    if (came)
    {
        _hasPosition = IsKnown(*_position);
    }
    TakeMotion();
    return came && _hasPosition ? std::optional(_motion) : std::nullopt;
}

void Px4Vehicle::TakeMotion()
{
    if (_hasPosition)
    {
        _motion.Position = {_position->lat, _position->lon, static_cast<double>(_position->alt)};
    }
    if (_local->FetchMessage() && IsVelocityKnown(*_local))
    {
        _motion.NorthMps = static_cast<double>(_local->vx);
        _motion.EastMps = static_cast<double>(_local->vy);
        _motion.DownMps = static_cast<double>(_local->vz);
    }
    if (_attitude->FetchMessage())
    {
        const double w = static_cast<double>(_attitude->q[0]);
        const double x = static_cast<double>(_attitude->q[1]);
        const double y = static_cast<double>(_attitude->q[2]);
        const double z = static_cast<double>(_attitude->q[3]);
        _motion.RollRad = std::atan2(2 * (w * x + y * z), 1 - 2 * (x * x + y * y));
        _motion.PitchRad = std::asin(std::clamp(2 * (w * y - z * x), -1.0, 1.0));
        _motion.YawRad = std::atan2(2 * (w * z + x * y), 1 - 2 * (y * y + z * z));
    }
}

void Px4Vehicle::TakeAnswer(Time now)
{
    if (!_answer->FetchMessage() || !_awaitsAnswer || _answer->command != Command::VEHICLE_CMD_DO_REPOSITION)
    {
        return;
    }
    _awaitsAnswer = false;
    if (_answer->result == Answer::VEHICLE_CMD_RESULT_ACCEPTED)
    {
        return;
    }
    _target.reset();
    _refusal = "PX4 refused the point: " + NameOf(_answer->result);
    _refusedAt = now;
    Rabit::RabitLog::Write(Rabit::RabitLogLevel::Warning, "autopilot: " + _refusal);
}

std::string Px4Vehicle::NotReady(Time now) const
{
    if (!IsHeard())
    {
        return "no PX4 is heard on DDS";
    }
    if (!IsArmed())
    {
        return "PX4 is not armed";
    }
    if (!_hasPosition || _position->GetAgeSeconds() > SilentAfterS)
    {
        return "PX4 has no position";
    }
    return !_refusal.empty() && now - _refusedAt < RefusalShown ? _refusal : "";
}

void Px4Vehicle::FlyTo(const GeoPoint &point, double speedMps, Time now)
{
    if (!NotReady(now).empty())
    {
        return;
    }
    _target = point;
    _speedMps = speedMps;
    _awaitsAnswer = true;
    _attempts = MostAttempts;
    _repeats = Rabit::RabitTimer(std::chrono::seconds(1));
    _refusal.clear();
}

void Px4Vehicle::SendCommand(Time now)
{
    --_attempts;
    _command->timestamp =
        static_cast<std::uint64_t>(std::chrono::duration_cast<std::chrono::microseconds>(now).count());
    _command->command = Command::VEHICLE_CMD_DO_REPOSITION;
    _command->param1 = static_cast<float>(_speedMps);
    _command->param2 = ChangeMode;
    _command->param4 = std::numeric_limits<float>::quiet_NaN();  // any yaw
    _command->param5 = _target->LatitudeDeg;
    _command->param6 = _target->LongitudeDeg;
    _command->param7 = static_cast<float>(_target->AltitudeM);
    _command->target_system = _status->system_id;
    _command->target_component = _status->component_id;
    _command->source_system = _status->system_id;
    _command->source_component = CompanionComputer;
    _command->from_external = true;
    _command->PostMessage();
}

void Px4Vehicle::Release(Time /*now*/)
{
    _target.reset();
    _awaitsAnswer = false;
}

Uav::FlightPhase Px4Vehicle::Phase() const
{
    if (!_target || !IsArmed())
    {
        return Uav::FlightPhase::FLIGHT_IDLE;
    }
    return Between(_motion.Position, *_target).LengthM() < ArrivedM ? Uav::FlightPhase::FLIGHT_HOLD
                                                                    : Uav::FlightPhase::FLIGHT_COURSE;
}

int Px4Vehicle::DelayMSec(Time /*now*/) const
{
    return PollMSec;
}

}  // namespace Swarm
