#pragma once

#include <chrono>
#include <cstddef>
#include <string>
#include <vector>

namespace Rabit
{

// Logs the managers that were told to shut down and have not ended, and those that hang: once after
// `patience`, and again each time the wait has doubled. A hang is logged if two looks in a row see it: after
// the process was stopped and goes on (SIGSTOP, SIGCONT), the first look sees a step that had no time to end.
// For the one thread that waits for them.
class HangWatch
{
public:
    using Clock = std::chrono::steady_clock;

    HangWatch(std::size_t managers, std::chrono::nanoseconds patience);

    // Called now and then for each manager. `step` names the step that it is in; null
    // between two steps. `hangsFor`: it has been there for this long, which is too long; 0: it is not.
    void Look(std::size_t manager, const std::string &name, bool toldToShutDown, const char *step,
              std::chrono::nanoseconds hangsFor, Clock::time_point now);

private:
    struct Watched
    {
        bool Told = false;
        Clock::time_point Since{};
        std::chrono::nanoseconds NextReport{0};
        std::chrono::nanoseconds NextHang{0};
        bool Hangs = false;  // as of the last look
    };
    void LookAtHang(Watched &watched, const std::string &name, const char *step,
                    std::chrono::nanoseconds hangsFor) const;

    const std::chrono::nanoseconds _patience;
    std::vector<Watched> _watched;
};

}  // namespace Rabit
