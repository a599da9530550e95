#pragma once

#include <chrono>
#include <string>

namespace Rabit
{

// Returns a time of 1 s and more, rounded down to one of a few steps. The text of a lasting problem does not
// change with each look then.
inline std::string RoughTime(std::chrono::nanoseconds time)
{
    int step = 1;
    for (const int next : {10, 60, 600, 3600})
    {
        step = time >= std::chrono::seconds(next) ? next : step;
    }
    return std::to_string(step) + ".0 s";
}

}  // namespace Rabit
