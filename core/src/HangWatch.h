#pragma once

#include <chrono>
#include <cstddef>
#include <string>
#include <vector>

namespace Rabit
{

// Says in the log which managers do not end though they were told to shut down: once when the patience is
// over, and again each time that twice as long has passed. For the one thread that waits for them.
class HangWatch
{
public:
    using Clock = std::chrono::steady_clock;

    HangWatch(std::size_t managers, std::chrono::nanoseconds patience);

    // Called for each manager that has not ended, now and then. `step` is where it is in its life, null if it
    // is between two steps.
    void Look(std::size_t manager, const std::string &name, bool toldToShutDown, const char *step,
              Clock::time_point now);

private:
    struct Watched
    {
        bool Told = false;
        Clock::time_point Since{};
        std::chrono::nanoseconds NextReport{0};
    };

    const std::chrono::nanoseconds _patience;
    std::vector<Watched> _watched;
};

}  // namespace Rabit
