#pragma once

#include <rabit/ManualClock.h>
#include <rabit/RabitManager.h>
#include <rabit/RabitWorkspace.h>

#include <chrono>
#include <deque>
#include <memory>
#include <optional>

namespace Rabit
{

// Runs managers without threads: on the calling thread, in a fixed order, by the workspace's clock
// (normally a ManualClock). This way whole nodes run deterministically.
//
// Managers that are due at the same time run in the order of addition. A manager that has been woken is due
// at once. A manager that does not sleep (delay 0) is due again after NoSleepStep, as time would otherwise
// stand still. A manager must not block in its unit of work.
//
// Not thread-safe. Other threads may still post, and add to queues.
class RabitSteppedReactor
{
public:
    static constexpr std::chrono::nanoseconds NoSleepStep = std::chrono::milliseconds(1);
    // More passes than this at one moment mean that managers wake each other endlessly.
    static constexpr int MaxPassesAtOneMoment = 100000;

    explicit RabitSteppedReactor(RabitWorkspace &workspace);
    // Shuts down the managers that still run, then destroys all managers in the reverse order of addition.
    ~RabitSteppedReactor();
    RabitSteppedReactor(const RabitSteppedReactor &) = delete;
    RabitSteppedReactor &operator=(const RabitSteppedReactor &) = delete;

    // As RabitReactor. A manager that is added after Start is started at once.
    void AddManager(std::unique_ptr<RabitManager> manager);
    // Runs every Startup; each first unit of work is then due at once. Throws std::logic_error if already
    // started.
    void Start();
    // When the next pass is due by the workspace's clock (now, if a manager was woken); nothing if no manager
    // runs.
    std::optional<std::chrono::nanoseconds> NextDue() const;
    // Runs all passes that are due now, those that they cause, and the Shutdown of managers that were told
    // to shut down. Returns the number of passes. Throws std::runtime_error after MaxPassesAtOneMoment.
    int RunDue();
    // Moves the clock on to `until`, stopping at each due moment on the way to run what is due. The clock
    // must be the one of the workspace. Returns the number of passes.
    int RunUntil(ManualClock &clock, std::chrono::nanoseconds until);
    int RunFor(ManualClock &clock, std::chrono::nanoseconds duration);
    // Runs one pass of a running manager of this reactor, even if it is not due; IsTurn returns `isTurn` in
    // that pass. For replaying a recording. Returns false if the manager has shut down or belongs to
    // another reactor.
    bool RunPassOf(const RabitManager &manager, bool isTurn);
    // True while any manager has not shut down yet.
    bool IsRunning() const;
    // Shuts all managers down, in order. They can be started again.
    void Stop();

private:
    struct Entry
    {
        std::unique_ptr<RabitManager> Manager;
        bool Running = false;
        bool FirstPass = false;
    };

    void StartEntry(Entry &entry);
    bool RunPass(Entry &entry, std::chrono::nanoseconds now, std::optional<bool> isTurn = std::nullopt);
    void EndEntry(Entry &entry);
    void LeaveIfAllEnded();
    std::chrono::nanoseconds DueOf(const Entry &entry) const;

    RabitWorkspace &_workspace;
    std::deque<Entry> _entries;  // stays in place when a unit of work adds managers
    bool _started = false;
    bool _anyEnded = false;  // since the last check whether all have
};

}  // namespace Rabit
