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

Motion Flight::Way::At(double seconds) const
{
    const Offset way = Between(From, To);
    Motion motion;
    motion.Position = Interpolate(From, To, (seconds - StartS) / DurationS);
    motion.NorthMps = way.NorthM / DurationS;
    motion.EastMps = way.EastM / DurationS;
    motion.DownMps = -way.UpM / DurationS;
    motion.YawRad = std::atan2(way.EastM, way.NorthM);
    return motion;
}

Motion Flight::Holding(double seconds) const
{
    return Circling(_leg->Hold, _leg->HoldBearingRad, seconds - _leg->There.StartS - _leg->There.DurationS);
}

// The track moves on meanwhile: aims at where it will be on arrival, found by trying the last duration again.
Flight::Way Flight::WayBackToTrack(double startS) const
{
    constexpr int rounds = 8;
    Way back;
    back.From = Holding(startS).Position;
    back.StartS = startS;
    for (int round = 0; round < rounds; ++round)
    {
        back.To = _track->At(startS + back.DurationS).Position;
        back.DurationS = Between(back.From, back.To).LengthM() / _leg->Hold.SpeedMps;
    }
    back.To = _track->At(startS + back.DurationS).Position;
    return back;
}

Motion Flight::At(double seconds)
{
    if (_leg && _track && !_leg->Back && _leg->There.IsOver(seconds - BackToTrackAfterS))
        _leg->Back = WayBackToTrack(_leg->There.StartS + _leg->There.DurationS + BackToTrackAfterS);
    if (_leg && _leg->Back && _leg->Back->IsOver(seconds))
        _leg.reset();
    if (!_leg)
    {
        _phase = _track ? FlightPhase::Track : FlightPhase::Pattern;
        return _track ? _track->At(seconds) : Circling(_pattern, 0, seconds);
    }
    if (_leg->Back)
    {
        _phase = FlightPhase::Track;
        return _leg->Back->At(seconds);
    }
    if (_leg->There.IsOver(seconds))
    {
        _phase = FlightPhase::Hold;
        return Holding(seconds);
    }
    _phase = FlightPhase::Goto;
    return _leg->There.At(seconds);
}

void Flight::FlyTo(const GeoPoint &point, double speedMps, double seconds)
{
    Leg leg;
    leg.There.From = At(seconds).Position;
    leg.Hold = {point, HoldRadiusM, std::min(speedMps, MaxHoldSpeedMps)};
    const Offset fromPoint = Between(point, leg.There.From);
    leg.HoldBearingRad = std::atan2(fromPoint.EastM, fromPoint.NorthM);
    leg.There.To = OnCircle(leg.Hold, leg.HoldBearingRad);
    leg.There.StartS = seconds;
    leg.There.DurationS = Between(leg.There.From, leg.There.To).LengthM() / speedMps;
    _phase = leg.There.DurationS > 0 ? FlightPhase::Goto : FlightPhase::Hold;
    _leg = leg;
}

}  // namespace Swarm
