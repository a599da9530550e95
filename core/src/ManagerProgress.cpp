#include "ManagerProgress.h"

#include <rabit/RabitWakeup.h>

#include <algorithm>

namespace Rabit
{

const char *ManagerProgress::NameOf(Step step) noexcept
{
    switch (step)
    {
        case Step::Startup:
            return "Startup";
        case Step::Shutdown:
            return "Shutdown";
        case Step::UnitOfWork:
            break;
    }
    return "ExecuteUnitOfWork";
}

// The remainder is that of a division that rounds down: a clock may begin below 0.
std::optional<ManagerProgress::Present> ManagerProgress::Read() const noexcept
{
    const std::int64_t present = _present.load(std::memory_order_relaxed);
    const std::int64_t step = (present % Steps + Steps) % Steps;
    if (step == 0)
    {
        return std::nullopt;
    }
    return Present{static_cast<Step>(step - 1), std::chrono::nanoseconds((present - step) / Steps)};
}

const char *ManagerProgress::StepName() const noexcept
{
    const std::optional<Present> present = Read();
    return present ? NameOf(present->What) : nullptr;
}

void ManagerProgress::Failed(Step step, const std::string &text, std::chrono::nanoseconds now)
{
    const std::lock_guard<std::mutex> lock(_mutex);
    _failedIn = step;
    _failure = text;
    _failedAt = now;
}

void ManagerProgress::Recovered()
{
    const std::lock_guard<std::mutex> lock(_mutex);
    _failedIn.reset();
    _failure.clear();
}

std::optional<ManagerTrouble> ManagerProgress::Trouble(const std::string &manager, const RabitWakeup &wakeup,
                                                       std::chrono::nanoseconds now) const
{
    if (const std::optional<Present> present = Read())
    {
        const bool isWork = present->What == Step::UnitOfWork;
        const std::chrono::nanoseconds limit =
            isWork ? std::max(LongWork, LongPeriods * wakeup.GetPeriod()) : LongStartup;
        if (now - present->Since >= limit && (!isWork || wakeup.MaySleep()))
        {
            return ManagerTrouble{manager, NameOf(present->What), now - present->Since, ""};
        }
    }
    const std::chrono::nanoseconds memory = std::max(FailureMemory, LongPeriods * wakeup.GetPeriod());
    const std::lock_guard<std::mutex> lock(_mutex);
    if (!_failedIn || (*_failedIn == Step::UnitOfWork && now - _failedAt >= memory))
    {
        return std::nullopt;
    }
    return ManagerTrouble{manager, NameOf(*_failedIn), std::chrono::nanoseconds(0), _failure};
}

}  // namespace Rabit
