#pragma once

#include <atomic>
#include <chrono>

#include <semaphore.h>

namespace Rabit
{

// A running reactor waits here for SIGINT, SIGTERM and SIGHUP, and for its managers. While at least one
// listener handles signals, a handler is installed for each of the three signals whose disposition is the
// default. The last listener restores the default.
//
// The first signal wakes all listeners. One that comes RabitReactor::SignalRepeat after it or later ends the
// process at once.
class ShutdownSignals
{
public:
    // Without `handle`, no signal wakes this listener. The same holds, and is logged, if 64 others listen
    // already.
    explicit ShutdownSignals(bool handle);
    ~ShutdownSignals();
    ShutdownSignals(const ShutdownSignals &) = delete;
    ShutdownSignals &operator=(const ShutdownSignals &) = delete;

    // Blocks until a signal arrives or Wake is called, at most for `longest`; each ends one wait. May also
    // return spuriously.
    void WaitFor(std::chrono::nanoseconds longest);
    // From any thread.
    void Wake();
    // True if a signal arrived since construction.
    bool SignalCame() const;

    // A place that the signal handler looks at. Places are static: the handler may run at any time.
    struct Place
    {
        std::atomic<bool> InUse{false};
        std::atomic<bool> SignalCame{false};
        sem_t Semaphore{};
    };

private:
    Place _own;     // used when no signals are handled
    Place *_place;  // _own or a static one
};

}  // namespace Rabit
