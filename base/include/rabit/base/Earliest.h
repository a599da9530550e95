#pragma once

#include <initializer_list>
#include <optional>

namespace Rabit
{

// The earliest of several times; empty: none is set.
template <typename Time>
std::optional<Time> Earliest(std::initializer_list<std::optional<Time>> times)
{
    std::optional<Time> earliest;
    for (const auto &time : times)
    {
        earliest = time && (!earliest || *time < *earliest) ? time : earliest;
    }
    return earliest;
}

// True if the time is set, and not after `now`.
template <typename Time>
bool IsBy(const std::optional<Time> &time, const Time &now)
{
    return time && *time <= now;
}

}  // namespace Rabit
