#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace Rabit
{

// Priority of the bytes that a node puts on the air, the most important first.
enum class TrafficClass
{
    Presence,   // beats of the gateway itself; a rule cannot choose it
    Command,    // messages that somebody waits for
    State,      // values that must be known
    Telemetry,  // values that are soon replaced by newer ones
    Bulk        // data that has time: pictures, files
};

struct TrafficClassInfo
{
    const char *Name;    // the word in configurations and reports
    std::int64_t Share;  // of a full channel; 0: presence has a rule of its own (air/ClassShares.h)
};

// All classes, in the order of TrafficClass. ClassRates.h has the rates that are reported.
inline constexpr std::array<TrafficClassInfo, 5> TrafficClasses = {
    {{"presence", 0}, {"command", 32}, {"state", 8}, {"telemetry", 3}, {"bulk", 2}}};
inline constexpr std::size_t TrafficClassCount = TrafficClasses.size();

}  // namespace Rabit
