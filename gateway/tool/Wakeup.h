#pragma once

#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <functional>
#include <mutex>
#include <thread>

namespace Rabit::Tool
{

// What the program waits with: for something to happen on another thread, a time, or Ctrl-C. One at a time,
// made before any thread is started, since it takes SIGINT, SIGTERM and SIGPIPE out of all that come.
class Wakeup
{
public:
    using Time = std::chrono::steady_clock::time_point;

    Wakeup();
    ~Wakeup();
    Wakeup(const Wakeup &) = delete;
    Wakeup &operator=(const Wakeup &) = delete;

    // Something happened; any thread.
    void Notify();
    // Whether somebody wants the program to end.
    bool IsInterrupted() const;
    // Asks `holds`, on this thread, whenever something has happened, until it says true, the time has come,
    // or somebody wants the program to end. Returns what it said last.
    bool WaitUntil(Time end, const std::function<bool()> &holds);

private:
    mutable std::mutex _mutex;
    std::condition_variable _changed;
    std::uint64_t _changes = 0;
    bool _interrupted = false;
    std::thread _signals;
};

}  // namespace Rabit::Tool
