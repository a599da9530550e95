#pragma once

#include <rabit/RabitManagerTrace.h>
#include <rabit/RabitWorkspace.h>

#include <atomic>
#include <chrono>
#include <cstdint>
#include <mutex>
#include <optional>
#include <string>

namespace Rabit
{
class RabitWakeup;

// The step that a manager is in, and the failure of its last one, for other threads. Shared between the
// manager and the registry of its workspace.
//
// Threads: the manager's thread writes, any thread reads. A step that succeeds costs two relaxed stores.
class ManagerProgress
{
public:
    using Step = RabitManagerTrace::Step;

    // A unit of work hangs if it takes longer than a second, and longer than two periods of its manager: it
    // has then missed a whole turn.
    static constexpr std::chrono::nanoseconds LongWork = std::chrono::seconds(1);
    static constexpr int LongPeriods = 2;
    // Startup and Shutdown may wait for hardware.
    static constexpr std::chrono::nanoseconds LongStartup = std::chrono::seconds(10);
    // A unit of work that threw counts for this long, and for two periods: a manager that messages alone wake
    // may have no later one.
    static constexpr std::chrono::nanoseconds FailureMemory = std::chrono::seconds(10);

    // As the functions of RabitManager are named.
    static const char *NameOf(Step step) noexcept;

    void Begin(Step step, std::chrono::nanoseconds now) noexcept
    {
        _present.store(now.count() * Steps + static_cast<std::int64_t>(step) + 1, std::memory_order_relaxed);
    }
    void End() noexcept { _present.store(0, std::memory_order_relaxed); }
    // The name of the present step; null between two steps.
    const char *StepName() const noexcept;

    // An exception with that text has left the step, at that time.
    void Failed(Step step, const std::string &text, std::chrono::nanoseconds now);
    // The last unit of work succeeded, the manager has ended well, or a new run begins.
    void Recovered();

    // Why the manager does not do its work; nothing if it does. A manager that never sleeps may block in its
    // unit of work.
    std::optional<ManagerTrouble> Trouble(const std::string &manager, const RabitWakeup &wakeup,
                                          std::chrono::nanoseconds now) const;

private:
    struct Present
    {
        Step What;
        std::chrono::nanoseconds Since;
    };

    static constexpr std::int64_t Steps = 4;

    std::optional<Present> Read() const noexcept;

    // The beginning of the step in nanoseconds, times Steps, and the step, counted from 1: one number, so
    // that no reader takes the beginning of another step. 0: between two steps.
    std::atomic<std::int64_t> _present{0};
    mutable std::mutex _mutex;
    std::optional<Step> _failedIn;  // guarded by _mutex, like _failure
    std::string _failure;
    std::chrono::nanoseconds _failedAt{0};
};

}  // namespace Rabit
