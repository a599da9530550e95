#pragma once

#include <algorithm>
#include <cstdint>

#include "VendorTraffic.h"
#include "common/Ledger.h"

namespace Rabit::Cyclone
{

inline Rtps::Place ToPlace(const RabitCyclonePlace &place)
{
    Rtps::Place result{.Host = {}, .Port = static_cast<std::uint16_t>(place.port)};
    std::copy_n(place.address, result.Host.size(), result.Host.begin());
    return result;
}

inline RabitCyclonePlace ToCyclonePlace(const Rtps::Place &place)
{
    RabitCyclonePlace result{.address = {}, .port = place.Port};
    std::copy(place.Host.begin(), place.Host.end(), result.address);
    return result;
}

inline RabitCyclonePlace EndOf(const RabitCycloneRoute &route)
{
    RabitCyclonePlace result{.address = {}, .port = route.port};
    std::copy_n(route.address, sizeof result.address, result.address);
    return result;
}

}  // namespace Rabit::Cyclone
