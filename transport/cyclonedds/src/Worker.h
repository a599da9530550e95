#pragma once

#include <deque>
#include <functional>
#include <mutex>
#include <optional>
#include <utility>

#include "common/DueThread.h"

namespace Rabit::Cyclone
{

// A thread that runs the given work in order. Work that has not begun when it ends is left out.
class Worker final : public DueThread
{
public:
    Worker() { Start(); }
    ~Worker() { Stop(); }

    void Post(std::function<void()> work)
    {
        const std::lock_guard lock(_mutex);
        _work.push_back(std::move(work));
        WakeIfEarlier();
    }

private:
    std::optional<Clock::time_point> Due() override
    {
        return _work.empty() ? std::nullopt : std::optional(Clock::time_point{});
    }
    void Work(std::unique_lock<std::mutex> &lock) override
    {
        const auto work = std::move(_work.front());
        _work.pop_front();
        lock.unlock();
        work();
        lock.lock();
    }

    std::deque<std::function<void()>> _work;  // guarded by _mutex
};

}  // namespace Rabit::Cyclone
