// Positions on the earth, and how an aircraft moves there.
//
// The earth is taken for flat around the start point of a calculation. Over the few kilometres that these
// aircraft fly, the error is below a metre for each kilometre.
#pragma once

namespace Swarm
{

// WGS84 degrees, metres above mean sea level.
struct GeoPoint
{
    double LatitudeDeg = 0;   // -90 to 90
    double LongitudeDeg = 0;  // -180 to 180
    double AltitudeM = 0;
};

// A step from one point to another.
struct Offset
{
    double NorthM = 0;
    double EastM = 0;
    double UpM = 0;

    double LengthM() const;
};

// Position, velocity (m/s) and attitude (rad; yaw clockwise from true north) of an aircraft.
struct Motion
{
    GeoPoint Position;
    double NorthMps = 0;
    double EastMps = 0;
    double DownMps = 0;
    double RollRad = 0;
    double PitchRad = 0;
    double YawRad = 0;
};

// The step that leads from one point to the other, the short way round across the 180th meridian.
Offset Between(const GeoPoint &from, const GeoPoint &to);
// The point that the step leads to. Latitude stops at the poles, longitude stays within -180 to 180.
GeoPoint Moved(const GeoPoint &from, const Offset &step);
// The same angle within -pi to pi.
double WrapRad(double angle);
// Between two angles, the short way round: share 0 gives the first, 1 the second. Within -pi to pi.
double InterpolateRad(double from, double to, double share);
// Between two points: share 0 gives the first, 1 the second.
GeoPoint Interpolate(const GeoPoint &from, const GeoPoint &to, double share);

}  // namespace Swarm
