#pragma once

#include <rabit/gateway/TrafficClass.h>

#include <algorithm>
#include <cstddef>
#include <iterator>
#include <string>
#include <vector>

namespace Rabit
{

// The words of the traffic classes that a configuration may choose: all but the first, `presence`.
inline std::vector<std::string> TrafficClassWords()
{
    std::vector<std::string> words;
    std::transform(TrafficClasses.begin() + 1, TrafficClasses.end(), std::back_inserter(words),
                   [](const TrafficClassInfo &traffic) { return traffic.Name; });
    return words;
}

// The class of the word at that index.
inline TrafficClass ChosenClass(std::size_t index)
{
    return static_cast<TrafficClass>(index + 1);
}

}  // namespace Rabit
