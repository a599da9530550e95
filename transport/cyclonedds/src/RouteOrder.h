#pragma once

#include <array>
#include <cstdint>
#include <tuple>

#include "VendorTraffic.h"

namespace Rabit::Cyclone
{

// An order of routes, for sets and maps of them.
struct RouteOrder
{
    bool operator()(const RabitCycloneRoute &a, const RabitCycloneRoute &b) const
    {
        const auto tupleOf = [](const RabitCycloneRoute &route)
        {
            return std::tuple(reinterpret_cast<std::uintptr_t>(route.connection),
                              std::to_array(route.address), route.port);
        };
        return tupleOf(a) < tupleOf(b);
    }
};

}  // namespace Rabit::Cyclone
