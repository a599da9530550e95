#pragma once

#include "Airframe.h"
#include "Geo.h"
#include "Track.h"
#include "uav.idl.h"

#include <optional>
#include <utility>

namespace Swarm
{

// The flight of one simulated aircraft. It flies a recorded track or its own circle. FlyTo sends it to a
// point, which it then circles; Release sends it back. It joins the track along a smooth curve, at the
// place where the track will be by then. Positions never jump, and velocities only where a track's do.
//
// The time is an argument everywhere, in seconds since the start of the flight, and must not go back.
// Not thread-safe.
class Flight
{
public:
    static constexpr double HoldRadiusM = 30;
    static constexpr double MaxHoldSpeedMps = 12;
    static constexpr double CatchUpSpeedMps = 12;

    explicit Flight(Swarm::Track track) : _track(std::move(track)), _phase(Uav::FlightPhase::FLIGHT_RECORDING)
    {
    }
    explicit Flight(const Circle &pattern);

    // The motion at that time.
    Motion At(double seconds);
    // Leaves for the point at that speed (m/s, above 0), from where the aircraft is at that time.
    void FlyTo(const GeoPoint &point, double speedMps, double seconds);
    // Leaves for the track or its own circle.
    void Release(double seconds);
    // As of the last call of At, FlyTo or Release.
    Uav::FlightPhase Phase() const { return _phase; }

private:
    // A curve from one motion to another: a cubic Hermite spline.
    struct CatchUp
    {
        Motion From;
        Motion To;
        double StartS = 0;
        double DurationS = 0;

        bool IsOver(double seconds) const { return seconds >= StartS + DurationS; }
        Motion At(double seconds) const;
    };

    CatchUp WayToTrack(const Motion &from, double startS) const;

    std::optional<Swarm::Track> _track;
    Circle _pattern;
    std::optional<Airframe> _airframe;  // none while it flies the track or catches up with it
    std::optional<CatchUp> _catchUp;
    double _nowS = 0;
    Uav::FlightPhase _phase;
};

}  // namespace Swarm
