// Wakes a thread of Python, or an event loop, from threads that know nothing of Python.
#pragma once

#include <pybind11/pybind11.h>

#include <atomic>
#include <functional>
#include <optional>

namespace Rabit::Python
{

// Wakes threads of Python in Wait, and one event loop, which waits until Fd is readable. Each kind has an
// eventfd (eventfd(2)) of its own, so that none takes a wake-up from the other. It is made when it is first
// needed, and written to only while somebody waits.
//
// The event loop: take Fd, Arm, look once more whether there is something, wait until Fd is readable, then
// Drain.
class Waitable
{
public:
    // With the GIL. Throws std::system_error if the process has no more file descriptors.
    int Fd();
    void Arm() { _loop.Arm(); }
    void Drain() { _loop.Drain(); }
    // Any thread; takes a microsecond, and no lock.
    void Notify();
    // Like Notify, and from now on Fd stays readable, and Wait never sleeps.
    void Close();
    // Waits without the GIL until `isReady` (called with the GIL) returns true. False after so many seconds
    // (Seconds.h); empty: waits for ever. Signals are handled meanwhile, so Ctrl-C ends it with
    // KeyboardInterrupt.
    bool Wait(std::optional<double> seconds, const std::function<bool()> &isReady);

private:
    class Event
    {
    public:
        Event() = default;
        ~Event();
        Event(const Event &) = delete;
        Event &operator=(const Event &) = delete;

        // Negative if the process has no more file descriptors: Wait then looks five times a second.
        int Fd();
        void Arm() { _isArmed = true; }
        void Notify();
        void Drain();
        void Close();

    private:
        void Write();

        std::atomic<int> _fd{-1};  // none yet; nobody waits
        std::atomic<bool> _isArmed{false};
        std::atomic<bool> _isClosed{false};
    };

    Event _threads;
    Event _loop;
};

}  // namespace Rabit::Python
