#include "Flight.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace Swarm
{
namespace
{
constexpr double GravityMps2 = 9.80665;

GeoPoint OnCircle(const Pattern &circle, double bearingRad)
{
    return Moved(circle.Centre,
                 {circle.RadiusM * std::cos(bearingRad), circle.RadiusM * std::sin(bearingRad), 0});
}

// The motion on a circle that long after passing its northernmost point, or after the given bearing.
Motion Circling(const Pattern &circle, double startBearingRad, double seconds)
{
    const double bearing = startBearingRad + seconds * circle.SpeedMps / circle.RadiusM;
    const double course = bearing + std::numbers::pi / 2;  // clockwise
    Motion motion;
    motion.Position = OnCircle(circle, bearing);
    motion.NorthMps = circle.SpeedMps * std::cos(course);
    motion.EastMps = circle.SpeedMps * std::sin(course);
    motion.RollRad = std::atan(circle.SpeedMps * circle.SpeedMps / (circle.RadiusM * GravityMps2));
    motion.YawRad = WrapRad(course);
    return motion;
}
}  // namespace

Motion Flight::At(double seconds)
{
    if (!_leg)
    {
        _phase = _track ? FlightPhase::Track : FlightPhase::Pattern;
        return _track ? _track->At(seconds) : Circling(_pattern, 0, seconds);
    }
    const double flown = seconds - _leg->StartS;
    if (flown >= _leg->DurationS)
    {
        _phase = FlightPhase::Hold;
        return Circling(_leg->Hold, _leg->HoldBearingRad, flown - _leg->DurationS);
    }
    _phase = FlightPhase::Goto;
    Motion motion;
    motion.Position = Interpolate(_leg->From, _leg->To, flown / _leg->DurationS);
    motion.NorthMps = _leg->Way.NorthM / _leg->DurationS;
    motion.EastMps = _leg->Way.EastM / _leg->DurationS;
    motion.DownMps = -_leg->Way.UpM / _leg->DurationS;
    motion.YawRad = std::atan2(_leg->Way.EastM, _leg->Way.NorthM);
    return motion;
}

void Flight::FlyTo(const GeoPoint &point, double speedMps, double seconds)
{
    Leg leg;
    leg.From = At(seconds).Position;
    leg.Hold = {point, HoldRadiusM, std::min(speedMps, MaxHoldSpeedMps)};
    const Offset fromPoint = Between(point, leg.From);
    leg.HoldBearingRad = std::atan2(fromPoint.EastM, fromPoint.NorthM);
    leg.To = OnCircle(leg.Hold, leg.HoldBearingRad);
    leg.Way = Between(leg.From, leg.To);
    leg.StartS = seconds;
    leg.DurationS = leg.Way.LengthM() / speedMps;
    _leg = leg;
    _phase = leg.DurationS > 0 ? FlightPhase::Goto : FlightPhase::Hold;
}

}  // namespace Swarm
