#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace Rabit
{

// Priority of the bytes that a node puts on the air, the most important first. A rule cannot choose Presence
// and Foreign.
enum class TrafficClass
{
    Presence,   // beats of the gateway itself
    Command,    // messages that somebody waits for
    State,      // values that must be known
    Telemetry,  // values that are soon replaced by newer ones
    Bulk,       // data that has time: pictures, files
    Foreign     // samples for programs that are no nodes (foreign topics)
};

struct TrafficClassInfo
{
    const char *Name;    // the word in configurations and reports
    std::int64_t Share;  // of a full channel; 0: presence has a rule of its own (air/ClassShares.h)
};

// All classes, in the order of TrafficClass. ClassRates.h has the rates that are reported.
inline constexpr std::array<TrafficClassInfo, 6> TrafficClasses = {
    {{"presence", 0}, {"command", 32}, {"state", 8}, {"telemetry", 3}, {"bulk", 2}, {"foreign", 3}}};
inline constexpr std::size_t TrafficClassCount = TrafficClasses.size();

// True if the configuration of a message or queue can choose the class.
constexpr bool MayBeChosen(TrafficClass traffic)
{
    return traffic != TrafficClass::Presence && traffic != TrafficClass::Foreign;
}

}  // namespace Rabit
