#pragma once

#include <rabit/gateway/Fleet.h>
#include <rabit/gateway/TrafficClass.h>

#include <array>
#include <cstddef>

namespace Rabit
{

struct ClassRate
{
    const char *Name;
    double Gateway::AirStatus::*Value;
};

// The rate of each traffic class in Gateway::AirStatus, in the order of TrafficClass.
inline constexpr auto ClassRates = []
{
    using Gateway::AirStatus;
    constexpr std::array fields = {&AirStatus::presence,  &AirStatus::command, &AirStatus::state,
                                   &AirStatus::telemetry, &AirStatus::bulk,    &AirStatus::foreign};
    static_assert(fields.size() == TrafficClassCount);
    std::array<ClassRate, TrafficClassCount> rates{};
    for (std::size_t i = 0; i < rates.size(); ++i)
    {
        rates[i] = {TrafficClasses[i].Name, fields[i]};
    }
    return rates;
}();

}  // namespace Rabit
