#pragma once

#include "Geo.h"
#include "Track.h"

#include <optional>
#include <utility>

namespace Swarm
{

// What a simulated aircraft is flying.
enum class FlightPhase
{
    Idle,     // nothing of its own: somebody else flies it
    Track,    // a recorded track
    Pattern,  // circles of its own, for want of a track
    Goto,     // on the way to a commanded point
    Hold      // circling the commanded point
};

// A circle flown clockwise at a steady height.
struct Pattern
{
    GeoPoint Centre;
    double RadiusM = 60;
    double SpeedMps = 8;
};

// The flight of one simulated aircraft: a track or a pattern until it is told to go to a point, which it
// flies to in a straight line and then circles at 20 m until it is told otherwise. An aircraft with a track
// goes back to it after a while, to where the track is by then. Positions never jump.
//
// The time is an argument everywhere, in seconds since the start of the flight, and must not go back.
// Not thread-safe.
class Flight
{
public:
    static constexpr double HoldRadiusM = 20;
    static constexpr double MaxHoldSpeedMps = 10;
    static constexpr double BackToTrackAfterS = 5;

    explicit Flight(Swarm::Track track) : _track(std::move(track)) {}
    explicit Flight(const Swarm::Pattern &pattern) : _pattern(pattern) {}

    // The motion at that time.
    Motion At(double seconds);
    // Leaves for the point at that speed (m/s, above 0), from where the aircraft is at that time.
    void FlyTo(const GeoPoint &point, double speedMps, double seconds);
    // As of the last call of At or FlyTo.
    FlightPhase Phase() const { return _phase; }

private:
    // A straight way from one point to another.
    struct Way
    {
        GeoPoint From;
        GeoPoint To;
        double StartS = 0;
        double DurationS = 0;

        bool IsOver(double seconds) const { return seconds >= StartS + DurationS; }
        Motion At(double seconds) const;
    };
    // What a command makes of the flight: the way to the nearest point of the circle around the commanded
    // point, the circle, and with a track the way back to it.
    struct Leg
    {
        Way There;
        Swarm::Pattern Hold;
        double HoldBearingRad = 0;  // from the middle of the circle to where the way meets it
        std::optional<Way> Back;
    };

    Motion Holding(double seconds) const;
    Way WayBackToTrack(double startS) const;

    std::optional<Swarm::Track> _track;
    Swarm::Pattern _pattern;
    std::optional<Leg> _leg;
    FlightPhase _phase = FlightPhase::Pattern;
};

}  // namespace Swarm
