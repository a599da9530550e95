#pragma once

#include "Geo.h"

namespace Swarm
{

// A circle to fly clockwise at a steady height.
struct Circle
{
    GeoPoint Centre;
    double RadiusM = 60;
    double SpeedMps = 8;
};

// A model of an aircraft in still air: a point that turns by banking, within limits of bank, roll rate,
// climb and acceleration. It flies straight towards a circle, slows down for it, joins it along a vector
// field, and stays on it. The field is that of Nelson, Barber, McLain and Beard ("Vector field path following
// for miniature air vehicles", IEEE Transactions on Robotics 23(3), 2007).
//
// Not thread-safe.
class Airframe
{
public:
    static constexpr double MaxBankRad = 0.61;
    static constexpr double MaxRollRateRadps = 1.0;
    static constexpr double MaxClimbMps = 3;
    static constexpr double MaxClimbChangeMps2 = 2;
    static constexpr double MaxAccelerationMps2 = 2.5;

    // Starts with that position and velocity, on its way to the circle at the circle's speed.
    Airframe(const Motion &start, const Circle &circle);

    // Sets another circle, and the speed (m/s, above 0) on the way to it.
    void FlyTo(const Circle &circle, double speedMps);
    // Advances the motion in time.
    void Advance(double seconds);
    Motion Now() const;
    // True if it has joined the circle.
    bool IsOnCircle() const;

private:
    void Step(double seconds);
    double WantedTurnRadps(const Offset &fromCentre, double distanceM) const;
    double WantedSpeedMps(double distanceM) const;

    Circle _circle;
    double _wayThereMps;
    GeoPoint _position;
    double _yawRad;
    double _rollRad;
    double _speedMps;  // over ground
    double _climbMps;
};

}  // namespace Swarm
