#include "PlanGoto.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace Ground
{
namespace
{
constexpr double DistanceM = 50;
constexpr float SpeedMps = 10;
constexpr double MeridianDegreeM = 111195;  // of latitude
constexpr double GoldenAngleRad =
    std::numbers::pi * (3 - 2.2360679775);  // turns that never repeat: 137.5 degrees
constexpr double RadPerDeg = std::numbers::pi / 180;
}  // namespace

Uav::Goto PlanGoto(const Uav::Pose &pose, std::uint32_t id)
{
    const double bearing = std::fmod(id * GoldenAngleRad, 2 * std::numbers::pi);
    const double metresPerDegreeEast =
        MeridianDegreeM * std::max(std::cos(pose.latitude_deg * RadPerDeg), 1e-6);
    Uav::Goto command;
    command.id = id;
    command.latitude_deg =
        std::clamp(pose.latitude_deg + DistanceM * std::cos(bearing) / MeridianDegreeM, -90.0, 90.0);
    command.longitude_deg =
        std::remainder(pose.longitude_deg + DistanceM * std::sin(bearing) / metresPerDegreeEast, 360.0);
    command.altitude_m = std::clamp(pose.altitude_m + (id % 3 - 1.0) * 5.0, 20.0, 5000.0);
    command.speed_mps = SpeedMps;
    return command;
}

}  // namespace Ground
