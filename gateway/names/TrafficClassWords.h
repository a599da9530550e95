#pragma once

#include <rabit/gateway/TrafficClass.h>

#include <algorithm>
#include <cstddef>
#include <iterator>
#include <string>
#include <vector>

namespace Rabit
{

// The words of the traffic classes that a configuration may choose: all between the first and the last.
inline std::vector<std::string> TrafficClassWords()
{
    std::vector<std::string> words;
    static_assert(!MayBeChosen(TrafficClass::Presence) && !MayBeChosen(TrafficClass::Foreign) &&
                  static_cast<std::size_t>(TrafficClass::Foreign) + 1 == TrafficClassCount);
    std::transform(TrafficClasses.begin() + 1, TrafficClasses.end() - 1, std::back_inserter(words),
                   [](const TrafficClassInfo &traffic) { return traffic.Name; });
    return words;
}

// The class of the word at that index.
inline TrafficClass ChosenClass(std::size_t index)
{
    return static_cast<TrafficClass>(index + 1);
}

}  // namespace Rabit
