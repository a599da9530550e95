#include "MavlinkVehicle.h"

#include <rabit/RabitLog.h>

#include <array>
#include <cmath>
#include <numbers>
#include <string>
#include <utility>

namespace Swarm
{
namespace
{

constexpr double DegreesE7 = 1e7;
// Positions come about ten times a second; polling five times as often keeps them fresh.
constexpr int PollMSec = 20;
// Limit of reads in one unit of work, so that a flood on the channel does not keep the manager from its
// other work.
constexpr int MostReads = 200;

}  // namespace

MavlinkVehicle::MavlinkVehicle(std::unique_ptr<ByteChannel> channel) : _channel(std::move(channel))
{
    if (!_channel)
    {
        throw std::invalid_argument("MavlinkVehicle needs a channel");
    }
}

void MavlinkVehicle::Start(Time now)
{
    _startedAt = now;
}

std::optional<Motion> MavlinkVehicle::Update(Time now)
{
    std::array<std::uint8_t, 4096> buffer;
    for (int reads = 0; reads < MostReads; ++reads)
    {
        const std::size_t size = _channel->Receive(buffer, now);
        if (size == 0)
        {
            break;
        }
        _parser.Add(std::span(buffer).first(size));
        while (const auto frame = _parser.Next())
        {
            Take(*frame, now);
        }
    }
    if (_heartbeats.IsDue(now))
    {
        Send(MavlinkHeartbeat{.Type = MavlinkHeartbeat::TypeOnboardController,
                              .Autopilot = MavlinkHeartbeat::AutopilotInvalid,
                              .SystemStatus = MavlinkHeartbeat::StatusActive}
                 .Encode());
    }
    if (_target && IsHeard(now) && _targets.IsDue(now))
    {
        SendTarget(now);
    }
    return std::exchange(_news, false) ? std::optional<Motion>(_motion) : std::nullopt;
}

void MavlinkVehicle::Take(const MavlinkFrame &frame, Time now)
{
    if (const auto heartbeat = MavlinkHeartbeat::Decode(frame))
    {
        TakeHeartbeat(frame, *heartbeat, now);
    }
    if (frame.System != _system || frame.Component != _component)
    {
        return;
    }
    if (const auto attitude = MavlinkAttitude::Decode(frame))
    {
        _motion.RollRad = attitude->Roll;
        _motion.PitchRad = attitude->Pitch;
        _motion.YawRad = attitude->Yaw;
    }
    else if (const auto position = MavlinkGlobalPosition::Decode(frame))
    {
        TakePosition(*position);
    }
}

void MavlinkVehicle::TakeHeartbeat(const MavlinkFrame &frame, const MavlinkHeartbeat &heartbeat, Time now)
{
    if (heartbeat.Autopilot == MavlinkHeartbeat::AutopilotInvalid)
    {
        return;  // a camera, a gimbal, a ground station
    }
    if (!_system)
    {
        _system = frame.System;
        _component = frame.Component;
        Rabit::RabitLog::Write(Rabit::RabitLogLevel::Info,
                               "autopilot: heard MAVLink system " + std::to_string(frame.System));
    }
    if (frame.System == _system && frame.Component == _component)
    {
        _heardAt = now;
    }
}

void MavlinkVehicle::TakePosition(const MavlinkGlobalPosition &position)
{
    _motion.Position = {position.LatitudeE7 / DegreesE7, position.LongitudeE7 / DegreesE7,
                        position.AltitudeMm / 1e3};
    _motion.NorthMps = position.NorthCmps / 100.0;
    _motion.EastMps = position.EastCmps / 100.0;
    _motion.DownMps = position.DownCmps / 100.0;
    _positionKnown = true;
    _news = true;
}

std::string MavlinkVehicle::NotReady(Time now) const
{
    return IsHeard(now) ? "" : "no autopilot is heard";
}

void MavlinkVehicle::FlyTo(const GeoPoint &point, double /*speedMps*/, Time now)
{
    if (IsHeard(now))
    {
        _target = point;
        _targets = Rabit::RabitTimer(std::chrono::milliseconds(500));
    }
}

void MavlinkVehicle::SendTarget(Time now)
{
    MavlinkPositionTarget target;
    target.TimeSinceBootMs = static_cast<std::uint32_t>(
        std::chrono::duration_cast<std::chrono::milliseconds>(now - _startedAt).count());
    target.LatitudeE7 = static_cast<std::int32_t>(std::lround(_target->LatitudeDeg * DegreesE7));
    target.LongitudeE7 = static_cast<std::int32_t>(std::lround(_target->LongitudeDeg * DegreesE7));
    target.AltitudeM = static_cast<float>(_target->AltitudeM);
    target.TargetSystem = *_system;
    target.TargetComponent = _component;
    Send(target.Encode());
}

void MavlinkVehicle::Send(MavlinkFrame frame)
{
    frame.Sequence = _sequence++;
    frame.System = _system.value_or(1);  // a companion is a component of the aircraft
    frame.Component = OwnComponent;
    static_cast<void>(_channel->Send(EncodeMavlink(frame)));  // lost frames are sent again
}

Uav::FlightPhase MavlinkVehicle::Phase() const
{
    if (!_target)
    {
        return Uav::FlightPhase::FLIGHT_IDLE;
    }
    const bool there = _positionKnown && Between(_motion.Position, *_target).LengthM() < ArrivedM;
    return there ? Uav::FlightPhase::FLIGHT_HOLD : Uav::FlightPhase::FLIGHT_COURSE;
}

int MavlinkVehicle::DelayMSec(Time /*now*/) const
{
    return PollMSec;
}

}  // namespace Swarm
