#pragma once

#include <chrono>
#include <condition_variable>
#include <mutex>
#include <optional>
#include <thread>

#include "common/StartThread.h"

namespace Rabit
{

// A thread that works whenever something is due. Start and Prepare throw TransportError if the thread cannot
// be started; the object is then as before.
class DueThread
{
public:
    using Clock = std::chrono::steady_clock;

    DueThread(const DueThread &) = delete;
    DueThread &operator=(const DueThread &) = delete;
    // Starts the thread, which does no work before Start: for an owner whose Start must not fail.
    void Prepare()
    {
        if (!_thread.joinable())
        {
            _thread = StartThread([this] { Run(); });
        }
    }
    // When this returns, no work is in progress and none will be done. Any number of times; not from inside
    // the work. A derived class calls it in its destructor.
    void Stop()
    {
        {
            const std::lock_guard lock(_mutex);
            _stop = true;
        }
        _changed.notify_one();
        if (_thread.joinable())
        {
            _thread.join();
        }
    }

protected:
    DueThread() = default;
    ~DueThread() = default;

    void Start()
    {
        Prepare();
        StartPrepared();
    }
    // As Start, after Prepare. Also while another thread is in Stop: it does not touch the thread itself.
    void StartPrepared()
    {
        {
            const std::lock_guard lock(_mutex);
            _started = true;
        }
        _changed.notify_one();
    }
    // The functions below require _mutex.

    bool IsStopped() const { return _stop; }
    // Wakes the thread if something is due before the time until which it sleeps.
    void WakeIfEarlier()
    {
        const auto due = Due();
        if (_sleeps && due && (!_sleepsUntil || *due < *_sleepsUntil))
        {
            _changed.notify_one();
        }
    }

    mutable std::mutex _mutex;

private:
    // When there is work; empty: never.
    virtual std::optional<Clock::time_point> Due() = 0;
    // Does the work that is due. It may unlock in between.
    virtual void Work(std::unique_lock<std::mutex> &lock) = 0;

    void Run()
    {
        std::unique_lock lock(_mutex);
        _changed.wait(lock, [this] { return _started || _stop; });
        while (!_stop)
        {
            _sleepsUntil = Due();
            if (_sleepsUntil && *_sleepsUntil <= Clock::now())
            {
                Work(lock);
                continue;
            }
            _sleeps = true;
            _sleepsUntil ? static_cast<void>(_changed.wait_until(lock, *_sleepsUntil)) : _changed.wait(lock);
            _sleeps = false;
        }
    }

    std::condition_variable _changed;
    std::optional<Clock::time_point> _sleepsUntil;  // guarded by _mutex, like those below
    bool _sleeps = false;
    bool _started = false;
    bool _stop = false;
    std::thread _thread;
};

}  // namespace Rabit
