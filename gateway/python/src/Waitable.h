// Wakes a thread of Python, or an event loop, from threads that know nothing of Python.
#pragma once

#include <pybind11/pybind11.h>

#include <atomic>
#include <functional>
#include <optional>

namespace Rabit::Python
{

// An eventfd (eventfd(2)) that is written to only while somebody waits. The waiting side: Arm, look once
// more whether there is something, then wait until Fd is readable, then Drain.
class Waitable
{
public:
    Waitable();
    ~Waitable();
    Waitable(const Waitable &) = delete;
    Waitable &operator=(const Waitable &) = delete;

    int Fd() const { return _fd; }
    void Arm() { _armed = true; }
    // Any thread; takes a microsecond, and no lock.
    void Notify();
    void Drain();
    // Like Notify, and from now on Fd stays readable: a thread that drains it takes the end from nobody.
    void Close();
    // Waits without the GIL until `isReady` (called with the GIL) returns true. False after so many seconds;
    // empty: waits for ever. Signals are handled meanwhile, so Ctrl-C ends it with KeyboardInterrupt.
    bool Wait(std::optional<double> seconds, const std::function<bool()> &isReady);

private:
    void Write();

    const int _fd;
    std::atomic<bool> _armed{false};
    std::atomic<bool> _isClosed{false};
};

}  // namespace Rabit::Python
