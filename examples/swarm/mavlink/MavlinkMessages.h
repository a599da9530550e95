#pragma once

#include "MavlinkFrame.h"

#include <cstdint>
#include <optional>

namespace Swarm
{

// The messages of MAVLink's common set that an autopilot interface needs
// (https://mavlink.io/en/messages/common.html), with the units of that page.
//
// For each: Encode makes a frame (version 2, sequence number 0, sender 1/1: the caller changes these as
// needed); Decode returns nothing if the frame is of another type. Short payloads are filled up with zeros,
// as version 2 demands; longer ones (with extension fields) are cut.

// The presence of a component, sent once a second.
struct MavlinkHeartbeat
{
    static constexpr std::uint32_t Number = 0;
    static constexpr std::uint8_t Extra = 50;

    static constexpr std::uint8_t TypeOnboardController = 18;  // MAV_TYPE_ONBOARD_CONTROLLER
    static constexpr std::uint8_t AutopilotInvalid = 8;        // MAV_AUTOPILOT_INVALID: not an autopilot
    static constexpr std::uint8_t StatusActive = 4;            // MAV_STATE_ACTIVE

    std::uint32_t CustomMode = 0;
    std::uint8_t Type = 0;
    std::uint8_t Autopilot = 0;
    std::uint8_t BaseMode = 0;
    std::uint8_t SystemStatus = 0;
    std::uint8_t ProtocolVersion = 3;

    MavlinkFrame Encode() const;
    static std::optional<MavlinkHeartbeat> Decode(const MavlinkFrame &frame);
    bool operator==(const MavlinkHeartbeat &) const = default;
};

// The attitude of the aircraft, in radians and radians per second.
struct MavlinkAttitude
{
    static constexpr std::uint32_t Number = 30;
    static constexpr std::uint8_t Extra = 39;

    std::uint32_t TimeSinceBootMs = 0;
    float Roll = 0;
    float Pitch = 0;
    float Yaw = 0;
    float RollSpeed = 0;
    float PitchSpeed = 0;
    float YawSpeed = 0;

    MavlinkFrame Encode() const;
    static std::optional<MavlinkAttitude> Decode(const MavlinkFrame &frame);
    bool operator==(const MavlinkAttitude &) const = default;
};

// The position of the aircraft, estimated by the autopilot's filter.
struct MavlinkGlobalPosition
{
    static constexpr std::uint32_t Number = 33;
    static constexpr std::uint8_t Extra = 104;
    static constexpr std::uint16_t HeadingUnknown = 65535;

    std::uint32_t TimeSinceBootMs = 0;
    std::int32_t LatitudeE7 = 0;   // degrees times 10^7
    std::int32_t LongitudeE7 = 0;  // the same
    std::int32_t AltitudeMm = 0;   // above mean sea level
    std::int32_t RelativeAltitudeMm = 0;
    std::int16_t NorthCmps = 0;
    std::int16_t EastCmps = 0;
    std::int16_t DownCmps = 0;
    std::uint16_t HeadingCdeg = HeadingUnknown;  // 0 to 35999

    MavlinkFrame Encode() const;
    static std::optional<MavlinkGlobalPosition> Decode(const MavlinkFrame &frame);
    bool operator==(const MavlinkGlobalPosition &) const = default;
};

// The point for the autopilot to fly to (SET_POSITION_TARGET_GLOBAL_INT).
struct MavlinkPositionTarget
{
    static constexpr std::uint32_t Number = 86;
    static constexpr std::uint8_t Extra = 5;

    static constexpr std::uint8_t FrameGlobalInt = 5;  // MAV_FRAME_GLOBAL_INT: altitude above mean sea level
    // TypeMask: take the position alone, ignore velocities, accelerations, yaw and yaw rate.
    static constexpr std::uint16_t PositionOnly = 0x0DF8;

    std::uint32_t TimeSinceBootMs = 0;
    std::int32_t LatitudeE7 = 0;
    std::int32_t LongitudeE7 = 0;
    float AltitudeM = 0;
    float VelocityNorth = 0;
    float VelocityEast = 0;
    float VelocityDown = 0;
    float AccelerationNorth = 0;
    float AccelerationEast = 0;
    float AccelerationDown = 0;
    float Yaw = 0;
    float YawRate = 0;
    std::uint16_t TypeMask = PositionOnly;
    std::uint8_t TargetSystem = 1;
    std::uint8_t TargetComponent = 1;
    std::uint8_t CoordinateFrame = FrameGlobalInt;

    MavlinkFrame Encode() const;
    static std::optional<MavlinkPositionTarget> Decode(const MavlinkFrame &frame);
    bool operator==(const MavlinkPositionTarget &) const = default;
};

}  // namespace Swarm
