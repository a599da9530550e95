#include "Geo.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace Swarm
{
namespace
{
constexpr double EarthRadiusM = 6371008.8;  // mean radius of WGS84
constexpr double MetresPerDegree = EarthRadiusM * std::numbers::pi / 180.0;

double WrapDeg(double angle)
{
    return std::remainder(angle, 360.0);
}

// Kept from 0, so that a point at a pole has a longitude to step along.
double MetresPerDegreeOfLongitude(double latitudeDeg)
{
    return MetresPerDegree * std::max(std::cos(latitudeDeg * std::numbers::pi / 180.0), 1e-6);
}
}  // namespace

double Offset::LengthM() const
{
    return std::sqrt(NorthM * NorthM + EastM * EastM + UpM * UpM);
}

Offset Between(const GeoPoint &from, const GeoPoint &to)
{
    return {(to.LatitudeDeg - from.LatitudeDeg) * MetresPerDegree,
            WrapDeg(to.LongitudeDeg - from.LongitudeDeg) * MetresPerDegreeOfLongitude(from.LatitudeDeg),
            to.AltitudeM - from.AltitudeM};
}

GeoPoint Moved(const GeoPoint &from, const Offset &step)
{
    const double latitude = from.LatitudeDeg + step.NorthM / MetresPerDegree;
    const double longitude = from.LongitudeDeg + step.EastM / MetresPerDegreeOfLongitude(from.LatitudeDeg);
    return {std::clamp(latitude, -90.0, 90.0), WrapDeg(longitude), from.AltitudeM + step.UpM};
}

double WrapRad(double angle)
{
    return std::remainder(angle, 2 * std::numbers::pi);
}

double InterpolateRad(double from, double to, double share)
{
    return WrapRad(from + WrapRad(to - from) * share);
}

GeoPoint Interpolate(const GeoPoint &from, const GeoPoint &to, double share)
{
    return {std::lerp(from.LatitudeDeg, to.LatitudeDeg, share),
            WrapDeg(from.LongitudeDeg + WrapDeg(to.LongitudeDeg - from.LongitudeDeg) * share),
            std::lerp(from.AltitudeM, to.AltitudeM, share)};
}

}  // namespace Swarm
