#include "Airframe.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace Swarm
{
namespace
{
constexpr double GravityMps2 = 9.80665;
constexpr double StepS = 0.02;
constexpr double TurnPerRad = 1.0;    // turn rate for each radian that the course is wrong, 1/s
constexpr double FieldSteepness = 2;  // of the vector field near the circle
constexpr double ClimbPerM = 0.5;     // climb rate for each metre that the height is wrong, 1/s
constexpr double SlowestTurnMps = 3;  // below this speed it turns as at this speed

double Towards(double from, double to, double mostChange)
{
    return from + std::clamp(to - from, -mostChange, mostChange);
}
}  // namespace

Airframe::Airframe(const Motion &start, const Circle &circle)
    : _circle(circle),
      _wayThereMps(circle.SpeedMps),
      _position(start.Position),
      _yawRad(start.YawRad),
      _rollRad(std::clamp(start.RollRad, -MaxBankRad, MaxBankRad)),
      _speedMps(std::hypot(start.NorthMps, start.EastMps)),
      _climbMps(-start.DownMps)
{
    if (_speedMps > 1)
        _yawRad = std::atan2(start.EastMps, start.NorthMps);
}

void Airframe::FlyTo(const Circle &circle, double speedMps)
{
    _circle = circle;
    _wayThereMps = speedMps;
}

void Airframe::Advance(double seconds)
{
    while (seconds > 0)
    {
        Step(std::min(seconds, StepS));
        seconds -= StepS;
    }
}

Motion Airframe::Now() const
{
    Motion motion;
    motion.Position = _position;
    motion.NorthMps = _speedMps * std::cos(_yawRad);
    motion.EastMps = _speedMps * std::sin(_yawRad);
    motion.DownMps = -_climbMps;
    motion.RollRad = _rollRad;
    motion.PitchRad = std::atan2(_climbMps, std::max(_speedMps, SlowestTurnMps));
    motion.YawRad = WrapRad(_yawRad);
    return motion;
}

bool Airframe::IsOnCircle() const
{
    const Offset way = Between(_circle.Centre, _position);
    return std::hypot(way.NorthM, way.EastM) < _circle.RadiusM * 1.3;
}

// From afar straight towards the middle, near the circle along the vector field.
double Airframe::WantedTurnRadps(const Offset &fromCentre, double distanceM) const
{
    const double bearing = std::atan2(fromCentre.EastM, fromCentre.NorthM);
    double course = bearing + std::numbers::pi;
    double turn = 0;
    if (distanceM < 2 * _circle.RadiusM)
    {
        course =
            bearing + std::numbers::pi / 2 + std::atan(FieldSteepness * (distanceM / _circle.RadiusM - 1));
        turn = _speedMps / _circle.RadiusM;
    }
    return turn + TurnPerRad * WrapRad(course - _yawRad);
}

// The highest speed from which it can still slow down for the circle.
double Airframe::WantedSpeedMps(double distanceM) const
{
    const double onCircle = std::min(_circle.SpeedMps, _wayThereMps);
    const double brakingM = std::max(0.0, distanceM - 2 * _circle.RadiusM);
    return std::min(_wayThereMps, std::sqrt(onCircle * onCircle + 2 * MaxAccelerationMps2 * brakingM));
}

void Airframe::Step(double seconds)
{
    const Offset fromCentre = Between(_circle.Centre, _position);
    const double distance = std::hypot(fromCentre.NorthM, fromCentre.EastM);
    const double turnSpeed = std::max(_speedMps, SlowestTurnMps);
    const double wantedBank = std::clamp(
        std::atan(WantedTurnRadps(fromCentre, distance) * turnSpeed / GravityMps2), -MaxBankRad, MaxBankRad);
    _rollRad = Towards(_rollRad, wantedBank, MaxRollRateRadps * seconds);
    _speedMps = Towards(_speedMps, WantedSpeedMps(distance), MaxAccelerationMps2 * seconds);
    const double climb = std::clamp(-ClimbPerM * fromCentre.UpM, -MaxClimbMps, MaxClimbMps);
    _climbMps = Towards(_climbMps, climb, MaxClimbChangeMps2 * seconds);
    _yawRad = WrapRad(_yawRad + GravityMps2 * std::tan(_rollRad) / turnSpeed * seconds);
    _position = Moved(_position, {_speedMps * std::cos(_yawRad) * seconds,
                                  _speedMps * std::sin(_yawRad) * seconds, _climbMps * seconds});
}

}  // namespace Swarm
