#pragma once

#include <rabit/RabitManager.h>
#include <rabit/RabitWorkspace.h>

#include <chrono>
#include <memory>
#include <vector>

namespace Rabit
{

// Owns managers and runs them, each on its own thread.
//
// While Run is active, SIGINT and SIGTERM have all running reactors of the process shut down in order; a
// second such signal ends the process at once, as if there were no handler. Signals that the program handles
// or ignores itself are left alone, and SetHandleSignals(false) switches the whole off.
//
// Threads: ShutdownAllManagers may be called from any thread; the rest belongs to the thread that owns the
// reactor. Several reactors may run at once, in one workspace or in several, without disturbing each other.
class RabitReactor
{
public:
    RabitReactor();
    // For managers of another workspace than the default one.
    explicit RabitReactor(RabitWorkspace &workspace);
    // Shuts down and joins managers that still run, then destroys all in the reverse order of addition.
    ~RabitReactor();
    // A reactor that was moved from is empty and must not be used. Must not be moved while it runs.
    RabitReactor(RabitReactor &&other) noexcept;
    RabitReactor &operator=(RabitReactor &&other) noexcept;

    // Null is ignored. Throws std::invalid_argument if the manager belongs to another workspace, and
    // std::logic_error while the reactor runs.
    void AddManager(std::unique_ptr<RabitManager> manager);
    // Starts all managers in the order of addition and returns when all have shut down; then forgets the
    // names that they registered. May be called again, also with further managers added: the names come back.
    // Throws std::logic_error if it is running already, std::system_error if a thread cannot be started
    // (those already started are shut down first).
    void Run();
    // Has all managers of this reactor shut down. Before Run: Run will return after their Startup and
    // Shutdown.
    void ShutdownAllManagers();
    // Whether Run reacts to SIGINT and SIGTERM; it does unless told otherwise. Not while it runs.
    void SetHandleSignals(bool handle);
    // A manager that was told to shut down and has not ended after this time, because a step of it does not
    // return, is named in the log, as a warning, while Run goes on waiting for it; again each time that twice
    // as long has passed. 5 s unless set; at least 1 ms. Not while it runs.
    void SetPatience(std::chrono::nanoseconds patience);

private:
    struct State;
    State &StateOrThrow() const;
    std::unique_ptr<State> _state;
};

}  // namespace Rabit
