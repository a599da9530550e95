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
// While Run is active, SIGINT, SIGTERM and SIGHUP shut down all running reactors of the process in an orderly
// way. One that comes SignalRepeat after the first or later ends the process at once, as if there were no
// handler. Signals that the program handles or ignores itself, as after nohup, are left alone, and
// SetHandleSignals(false) switches signal handling off.
//
// Threads: ShutdownAllManagers may be called from any thread; the rest belongs to the thread that owns the
// reactor. Several reactors may run at once, in one workspace or in several, without disturbing each other.
class RabitReactor
{
public:
    // Signals that come sooner after the first are the same one. A program may get one signal twice:
    // `timeout` of coreutils sends it to its child and then to the child's process group, and a terminal
    // sends it to a shell's whole group.
    static constexpr std::chrono::milliseconds SignalRepeat{500};

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
    // Shuts down all managers of this reactor. After a call before Run, Run returns after their Startup and
    // Shutdown.
    void ShutdownAllManagers();
    // Sets whether Run reacts to SIGINT, SIGTERM and SIGHUP (default: true). Must not be called while the
    // reactor runs.
    void SetHandleSignals(bool handle);
    // If a manager has not ended this long after it was told to shut down, a warning names it. Run goes on
    // waiting for it. A manager that hangs (RabitWorkspace::GetListOfTroubledManagers) for that long is named
    // as well. A warning is repeated each time the wait has doubled. Default 5 s, at least 1 ms. Must not be
    // called while the reactor runs.
    void SetPatience(std::chrono::nanoseconds patience);

private:
    struct State;
    State &StateOrThrow() const;
    std::unique_ptr<State> _state;
};

}  // namespace Rabit
