#pragma once

#include <functional>
#include <mutex>
#include <optional>
#include <utility>

#include "common/DueThread.h"

namespace Rabit::FastDds
{

// Announces the participant at a chosen time, on a thread of its own.
class AnnouncementTimer final : public DueThread
{
public:
    ~AnnouncementTimer() { Stop(); }  // no call is made afterwards

    void Start(std::function<void()> announce)
    {
        _announce = std::move(announce);
        DueThread::Start();
    }
    // Sets the time, in place of an earlier one. Also before Start. The vendor's locks may be held.
    void At(Clock::time_point time)
    {
        const std::lock_guard lock(_mutex);
        _at = time;
        WakeIfEarlier();
    }

private:
    std::optional<Clock::time_point> Due() override { return _at; }
    void Work(std::unique_lock<std::mutex> &lock) override
    {
        _at.reset();
        lock.unlock();
        _announce();
        lock.lock();
    }

    std::optional<Clock::time_point> _at;  // guarded by _mutex
    std::function<void()> _announce;
};

}  // namespace Rabit::FastDds
