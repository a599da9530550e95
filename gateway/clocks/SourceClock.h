#pragma once

#include <rabit/RabitClock.h>

#include <chrono>
#include <cstdint>

#include "clocks/GpsTime.h"

namespace Rabit
{

// The time that the mirrored samples of one life of a node carry as their source time: its wall clock as it
// stood when the life began, and from then on its monotonic clock. So it looks like a wall clock to plain DDS
// programs, but never steps: were it the wall clock itself, a step would make what was posted before it look
// newer or older than it is. Beats tell the other nodes how it stands to the wall clock. A value; any thread.
class SourceClock
{
public:
    explicit SourceClock(const RabitClock &clock)
    {
        const PostTime now = clock.Now();
        _ahead = std::chrono::nanoseconds(GpsTime::ToUtcNanoseconds(now.GpsTimeSeconds)) - now.Monotonic;
    }

    // Nanoseconds since 1970 when the monotonic clock shows that.
    std::int64_t At(std::chrono::nanoseconds monotonic) const { return (monotonic + _ahead).count(); }

private:
    std::chrono::nanoseconds _ahead{0};
};

}  // namespace Rabit
