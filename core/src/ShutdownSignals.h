#pragma once

#include <atomic>
#include <chrono>

#include <semaphore.h>

namespace Rabit
{

// Where a running reactor waits for SIGINT and SIGTERM, and for its managers. While at least one listener
// handles signals, a handler is installed for each of the two signals whose disposition is the default; the
// last one to go restores it.
//
// The first signal wakes all listeners and restores the default disposition, so that a second one ends the
// process at once.
class ShutdownSignals
{
public:
    // Without `handle` no signal wakes this listener. The same, and logged, if too many (64) listen already.
    explicit ShutdownSignals(bool handle);
    ~ShutdownSignals();
    ShutdownSignals(const ShutdownSignals &) = delete;
    ShutdownSignals &operator=(const ShutdownSignals &) = delete;

    // Blocks until a signal came or Wake was called, once for each, but no longer than that; may also return
    // for no reason.
    void WaitFor(std::chrono::nanoseconds longest);
    // From any thread.
    void Wake();
    // Whether a signal came since construction.
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
