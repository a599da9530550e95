#pragma once

#include <rabit/RabitClock.h>

#include <chrono>
#include <cstdint>

#include "clocks/GpsTime.h"

namespace Rabit
{

// The source time of the mirrored samples of one incarnation of a node: its wall clock as it stood when the
// incarnation began, and from then on its monotonic clock. So it looks like a wall clock to plain DDS
// programs, but never steps: a step would make earlier posts look newer or older than they are. Beats tell
// the other nodes how it differs from the wall clock. A value; any thread.
class SourceClock
{
public:
    explicit SourceClock(const RabitClock &clock)
    {
        const PostTime now = clock.Now();
        _ahead = std::chrono::nanoseconds(GpsTime::ToUtcNanoseconds(now.GpsTimeSeconds)) - now.Monotonic;
    }

    // The source time in nanoseconds since 1970 at that time of the monotonic clock.
    std::int64_t At(std::chrono::nanoseconds monotonic) const { return (monotonic + _ahead).count(); }

private:
    std::chrono::nanoseconds _ahead{0};
};

}  // namespace Rabit
