#pragma once

#include <rabit/RabitClock.h>
#include <rabit/RabitHandlerThread.h>

#include <chrono>
#include <cstddef>
#include <map>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "gateway.idl.h"

namespace Rabit
{

// Tells which of the program's own handlers take long: the handlers of other messages from the network wait
// for them. Thread-safe; calls only the clock.
class HandlerWatch final : public RabitHandlerThread::Watch
{
public:
    using Duration = std::chrono::nanoseconds;

    // Handlers that take less are no problem.
    static constexpr Duration Slow = std::chrono::seconds(1);
    // A row stays for 10 s after its handler has returned: people can read it, and the log, which waits for
    // 2 s, tells it.
    static constexpr Duration Memory = std::chrono::seconds(10);
    // At most so many rows of handlers that have returned: the newest ones.
    static constexpr std::size_t MostRows = 16;

    // The clock, which must outlive the object, is read as monotonic time.
    explicit HandlerWatch(const RabitClock &clock) : _clock(clock) {}

    void Begins(const std::string &subject) override;
    void Returned() override;
    std::vector<Gateway::Problem> Problems(Duration now) const;

private:
    struct Call
    {
        std::string Subject;
        Duration Since{0};
    };
    struct Past
    {
        Duration Took{0};
        Duration ReturnedAt{0};
    };

    const RabitClock &_clock;
    mutable std::mutex _mutex;
    std::optional<Call> _running;       // guarded by _mutex, like _past
    std::map<std::string, Past> _past;  // by subject
};

}  // namespace Rabit
