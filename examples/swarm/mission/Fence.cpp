#include "Fence.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>

namespace Swarm
{
namespace
{
// Negative inside. A fence that is no circle, as one with NaN, encloses nothing.
double MetresOutside(const Uav::Geofence &fence, const GeoPoint &point)
{
    const Offset way =
        Between({fence.latitude_deg, fence.longitude_deg, 0}, {point.LatitudeDeg, point.LongitudeDeg, 0});
    const double outside = way.LengthM() - fence.radius_m;
    return std::isnan(outside) ? INFINITY : outside;
}

std::string Text(const Uav::Geofence &fence, double outsideM)
{
    if (fence.radius_m == 0 || outsideM <= 0)
        return "";
    std::array<char, 96> text{};
    const bool far = outsideM >= 1000;
    std::snprintf(text.data(), text.size(),
                  far ? "%.1f km outside of the geofence" : "%.0f m outside of the geofence",
                  far ? outsideM / 1000 : std::max(1.0, outsideM));
    return text.data();
}
}  // namespace

std::string WhyOutside(const Uav::Geofence &fence, const GeoPoint &point)
{
    return Text(fence, MetresOutside(fence, point));
}

std::string WhyOutside(const Uav::Geofence &fence, const Uav::SearchArea &area)
{
    const GeoPoint middle{area.latitude_deg, area.longitude_deg, 0};
    double farthest = 0;
    for (const double north : {-0.5, 0.5})
        for (const double east : {-0.5, 0.5})
            farthest = std::max(
                farthest, MetresOutside(fence, Moved(middle, {north * static_cast<double>(area.north_m),
                                                              east * static_cast<double>(area.east_m), 0})));
    return Text(fence, farthest);
}

}  // namespace Swarm
