#pragma once

#include "../Geo.h"
#include "uav.idl.h"

#include <string>

namespace Swarm
{

// The reason to decline that point, or the whole area, as one line for a person: how far outside of the fence
// it is. Empty if it is inside, or if there is no fence.
std::string WhyOutside(const Uav::Geofence &fence, const GeoPoint &point);
std::string WhyOutside(const Uav::Geofence &fence, const Uav::SearchArea &area);

}  // namespace Swarm
