#pragma once

#include <initializer_list>
#include <optional>

#include "rtps/Backoff.h"

namespace Rabit::Rtps
{

// The earliest of several times; empty: none is set.
inline std::optional<Backoff::TimePoint> Earliest(
    std::initializer_list<std::optional<Backoff::TimePoint>> times)
{
    std::optional<Backoff::TimePoint> earliest;
    for (const auto &time : times)
    {
        earliest = time && (!earliest || *time < *earliest) ? time : earliest;
    }
    return earliest;
}

// True if the time is set, and not after `now`.
inline bool IsBy(const std::optional<Backoff::TimePoint> &time, Backoff::TimePoint now)
{
    return time && *time <= now;
}

}  // namespace Rabit::Rtps
