#pragma once

#include <rabit/gateway/TrafficClass.h>

#include <cstddef>
#include <string>
#include <vector>

namespace Rabit
{

inline constexpr std::size_t TrafficClassCount = 5;

// `presence`, `command`, `state`, `telemetry`, `bulk`.
const char *WordOf(TrafficClass traffic);

// The words that a configuration may use: all but `presence`. The word at index i is that of ChosenClass(i).
const std::vector<std::string> &TrafficClassWords();
TrafficClass ChosenClass(std::size_t index);

}  // namespace Rabit
