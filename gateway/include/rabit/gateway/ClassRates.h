#pragma once

#include <rabit/gateway/Fleet.h>

#include <array>

namespace Rabit
{

// The rate of each traffic class in Gateway::AirStatus, in the order of TrafficClass.
struct ClassRate
{
    const char *Name;
    double Gateway::AirStatus::*Value;
};
inline constexpr std::array<ClassRate, 5> ClassRates = {{{"presence", &Gateway::AirStatus::presence},
                                                         {"command", &Gateway::AirStatus::command},
                                                         {"state", &Gateway::AirStatus::state},
                                                         {"telemetry", &Gateway::AirStatus::telemetry},
                                                         {"bulk", &Gateway::AirStatus::bulk}}};

}  // namespace Rabit
