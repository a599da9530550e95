#pragma once

#include <functional>
#include <mutex>
#include <optional>
#include <utility>

#include "AnnouncementRounds.h"
#include "common/DueThread.h"

namespace Rabit::Cyclone
{

// A thread that announces the participant when AnnouncementRounds says so.
class AnnouncementThread final : public DueThread
{
public:
    // Both are called on the thread, and may take the vendor's locks.
    struct Calls
    {
        std::function<bool()> IsUnheard;  // true if a peer has not shown that it knows us
        std::function<void()> Announce;
    };

    // `answerGap`, `hasCard`: see AnnouncementRounds.
    AnnouncementThread(std::chrono::milliseconds answerGap, bool hasCard)
        : _rounds(answerGap, Clock::now(), hasCard)
    {
        Prepare();
    }
    ~AnnouncementThread() { Stop(); }  // no call is made afterwards

    // To be called once, when the participant exists.
    void Start(Calls calls)
    {
        _calls = std::move(calls);
        DueThread::Start();
    }
    // A peer has appeared. Any thread; also before Start.
    void OnPeer()
    {
        const std::lock_guard lock(_mutex);
        _rounds.OnPeer(Clock::now());
        WakeIfEarlier();
    }

private:
    std::optional<Clock::time_point> Due() override { return _rounds.Due(); }
    void Work(std::unique_lock<std::mutex> &lock) override
    {
        lock.unlock();
        const bool unheard = _calls.IsUnheard();
        lock.lock();
        if (_rounds.Next(Clock::now(), unheard))
        {
            lock.unlock();
            _calls.Announce();
            lock.lock();
        }
    }

    AnnouncementRounds _rounds;  // guarded by _mutex
    Calls _calls;
};

}  // namespace Rabit::Cyclone
