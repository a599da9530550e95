#include "PositionCheck.h"

#include "NumberText.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace Ground
{
namespace
{
constexpr double MetresPerDegree = 6371008.8 * std::numbers::pi / 180;
constexpr double NoFixDeg = 0.001;
constexpr double FastestMps = 400;          // faster than any of these aircraft
constexpr double LongestReplayStepS = 600;  // between two poses; more is a wrong clock
constexpr double MarginMps = 30;            // of the speed, for wind and turns between two poses
constexpr double MarginM = 250;             // for the error of a receiver, and of the age of a pose

bool HasNoFix(const Uav::Pose &pose)
{
    return std::abs(pose.latitude_deg) <= NoFixDeg && std::abs(pose.longitude_deg) <= NoFixDeg;
}

// A speed that is no number allows no way of its own.
double SpeedOf(const Uav::Pose &pose)
{
    const double speed =
        std::hypot(static_cast<double>(pose.velocity_north_mps), static_cast<double>(pose.velocity_east_mps),
                   static_cast<double>(pose.velocity_down_mps));
    return std::isfinite(speed) ? std::min(speed, FastestMps) : 0;
}

double MetresBetween(const Uav::Pose &from, const Uav::Pose &to)
{
    const double east = std::remainder(to.longitude_deg - from.longitude_deg, 360.0) *
                        std::cos(from.latitude_deg * std::numbers::pi / 180);
    return std::hypot((to.latitude_deg - from.latitude_deg) * MetresPerDegree, east * MetresPerDegree,
                      to.altitude_m - from.altitude_m);
}

std::string MetresText(double metres)
{
    return metres < 10'000 ? Format("%.0f m", metres) : Format("%.0f km", metres / 1000);
}
}  // namespace

std::string WhyImpossible(const Uav::Pose &pose)
{
    std::string problem = Common::WhyNot("latitude", pose.latitude_deg, Common::LatitudeDeg);
    if (problem.empty())
        problem = Common::WhyNot("longitude", pose.longitude_deg, Common::LongitudeDeg);
    if (problem.empty())
        problem = Common::WhyNot("altitude", pose.altitude_m, PositionCheck::AltitudeM);
    return problem;
}

std::string PositionCheck::Look(const Uav::Pose &pose, double nowS)
{
    std::string problem = WhyImpossible(pose);
    if (!problem.empty() || HasNoFix(pose))
        return problem;
    const Seen now{pose, nowS};
    const bool hasRestarted = _good && pose.number < _good->Pose.number;
    if (_good && !hasRestarted)
        problem = WhyTooFar(*_good, now);
    if (problem.empty())
    {
        _good = now;
        _doubted.reset();
        return "";
    }
    if (!_doubted || !WhyTooFar(*_doubted, now).empty())
        _doubtedSinceS = nowS;
    _doubted = now;
    if (nowS - _doubtedSinceS < JumpBelievedS)
        return problem;
    _good = now;
    _doubted.reset();
    return "";
}

// By the clock of the aircraft if that is more: a recording may be played faster than it was flown.
double PositionCheck::SecondsBetween(const Seen &from, const Seen &to)
{
    const double here = std::max(0.0, to.AtS - from.AtS);
    const double there = to.Pose.gps_time_s - from.Pose.gps_time_s;
    return there > here && there <= LongestReplayStepS ? there : here;
}

// The reason why the aircraft cannot have flown that way; empty if it can.
std::string PositionCheck::WhyTooFar(const Seen &from, const Seen &to)
{
    const double seconds = SecondsBetween(from, to);
    const double metres = MetresBetween(from.Pose, to.Pose);
    const double speed = std::max(SpeedOf(from.Pose), SpeedOf(to.Pose));
    if (metres <= MarginM + seconds * (2 * speed + MarginMps))
        return "";
    return "it jumped " + MetresText(metres) + " in " + Format("%.1f s", seconds);
}

}  // namespace Ground
