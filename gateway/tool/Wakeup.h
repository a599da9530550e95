#pragma once

#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <functional>
#include <mutex>
#include <thread>

namespace Rabit::Tool
{

// Waits for an event on another thread, a time, or Ctrl-C. At most one at a time. Make it before any thread:
// it blocks SIGINT, SIGTERM, SIGHUP and SIGUSR2 for this thread and all later ones, and ignores SIGPIPE.
class Wakeup
{
public:
    using Time = std::chrono::steady_clock::time_point;

    Wakeup();
    ~Wakeup();
    Wakeup(const Wakeup &) = delete;
    Wakeup &operator=(const Wakeup &) = delete;

    // Reports an event; any thread.
    void Notify();
    // True if a signal asked the program to end.
    bool IsInterrupted() const;
    // Calls `holds` on this thread after each event, until it returns true, the time has come, or a signal
    // asks the program to end. Returns its last result.
    bool WaitUntil(Time end, const std::function<bool()> &holds);

private:
    mutable std::mutex _mutex;
    std::condition_variable _changed;
    std::uint64_t _changes = 0;
    bool _interrupted = false;
    std::thread _signals;
};

}  // namespace Rabit::Tool
