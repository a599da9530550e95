#include "Flight.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace Swarm
{
namespace
{
// At the northernmost point of the circle.
Motion StartOf(const Circle &circle)
{
    constexpr double gravityMps2 = 9.80665;
    Motion motion;
    motion.Position = Moved(circle.Centre, {circle.RadiusM, 0, 0});
    motion.EastMps = circle.SpeedMps;
    motion.YawRad = std::numbers::pi / 2;
    motion.RollRad = std::atan(circle.SpeedMps * circle.SpeedMps / (circle.RadiusM * gravityMps2));
    return motion;
}
}  // namespace

Flight::Flight(const Circle &pattern)
    : _pattern(pattern),
      _airframe(Airframe(StartOf(pattern), pattern)),
      _phase(Uav::FlightPhase::FLIGHT_PATTERN)
{
}

Motion Flight::CatchUp::At(double seconds) const
{
    const double u = (seconds - StartS) / DurationS;
    const Offset way = Between(From.Position, To.Position);
    // Along each axis: the way to go, and the velocities at both ends.
    const auto place = [&](double distance, double v0, double v1) {
        return distance * u * u * (3 - 2 * u) +
               DurationS * (v0 * u * (1 - u) * (1 - u) - v1 * u * u * (1 - u));
    };
    const auto velocity = [&](double distance, double v0, double v1)
    { return distance / DurationS * 6 * u * (1 - u) + v0 * (1 - u) * (1 - 3 * u) - v1 * u * (2 - 3 * u); };
    Motion motion;
    motion.Position = Moved(From.Position, {place(way.NorthM, From.NorthMps, To.NorthMps),
                                            place(way.EastM, From.EastMps, To.EastMps),
                                            place(way.UpM, -From.DownMps, -To.DownMps)});
    motion.NorthMps = velocity(way.NorthM, From.NorthMps, To.NorthMps);
    motion.EastMps = velocity(way.EastM, From.EastMps, To.EastMps);
    motion.DownMps = -velocity(way.UpM, -From.DownMps, -To.DownMps);
    motion.YawRad = std::atan2(motion.EastMps, motion.NorthMps);
    return motion;
}

// The track moves on meanwhile, so the point of arrival is found iteratively, with the last duration.
Flight::CatchUp Flight::WayToTrack(const Motion &from, double startS) const
{
    constexpr int rounds = 8;
    constexpr double leastS = 1;
    CatchUp way{from, _track->At(startS), startS, leastS};
    for (int round = 0; round < rounds; ++round)
    {
        way.DurationS = std::max(leastS, Between(from.Position, way.To.Position).LengthM() / CatchUpSpeedMps);
        way.To = _track->At(startS + way.DurationS);
    }
    return way;
}

Motion Flight::At(double seconds)
{
    if (_airframe)
    {
        _airframe->Advance(seconds - _nowS);
        _nowS = seconds;
        if (_phase == Uav::FlightPhase::FLIGHT_COURSE && _airframe->IsOnCircle())
            _phase = Uav::FlightPhase::FLIGHT_HOLD;
        return _airframe->Now();
    }
    _nowS = seconds;
    if (_catchUp && _catchUp->IsOver(seconds))
        _catchUp.reset();
    return _catchUp ? _catchUp->At(seconds) : _track->At(seconds);
}

void Flight::FlyTo(const GeoPoint &point, double speedMps, double seconds)
{
    const Motion now = At(seconds);
    const Circle hold{point, HoldRadiusM, std::min(speedMps, MaxHoldSpeedMps)};
    if (!_airframe)
        _airframe.emplace(now, hold);
    _airframe->FlyTo(hold, speedMps);
    _catchUp.reset();
    _phase = _airframe->IsOnCircle() ? Uav::FlightPhase::FLIGHT_HOLD : Uav::FlightPhase::FLIGHT_COURSE;
}

void Flight::Release(double seconds)
{
    const Motion now = At(seconds);
    if (!_track)
    {
        _airframe->FlyTo(_pattern, MaxHoldSpeedMps);
        _phase = Uav::FlightPhase::FLIGHT_PATTERN;
        return;
    }
    if (!_airframe)
        return;  // flies the track, or catches up with it
    _catchUp = WayToTrack(now, seconds);
    _airframe.reset();
    _phase = Uav::FlightPhase::FLIGHT_RECORDING;
}

}  // namespace Swarm
