#pragma once

#include <rabit/gateway/TrafficClass.h>

#include <array>
#include <cstddef>
#include <string>
#include <vector>

namespace Rabit
{

inline constexpr std::size_t TrafficClassCount = 5;

// The words that a configuration may use, in the order of the classes: all but `presence`.
inline const std::vector<std::string> TrafficClassWords = {"command", "state", "telemetry", "bulk"};

// The class of the word at that index.
inline TrafficClass ChosenClass(std::size_t index)
{
    return static_cast<TrafficClass>(index + 1);
}

}  // namespace Rabit
