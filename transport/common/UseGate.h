#pragma once

#include <atomic>
#include <mutex>
#include <shared_mutex>

namespace Rabit
{

// Lets many threads use an object, and one thread change it while nobody uses it. Users never wait for a
// change: as soon as one is wanted, they are turned away.
class UseGate
{
public:
    // Keeps the object unchanged while it lives, if Allowed().
    class Use
    {
    public:
        explicit Use(UseGate &gate) : _lock(gate._mutex, std::defer_lock)
        {
            if (!gate._changing)
            {
                static_cast<void>(_lock.try_lock());
            }
        }
        bool Allowed() const { return _lock.owns_lock(); }

    private:
        std::shared_lock<std::shared_mutex> _lock;
    };

    // Its constructor waits for the current users. While it lives, the object has no user. Only one at a
    // time.
    class Change
    {
    public:
        explicit Change(UseGate &gate) : _gate(gate)
        {
            _gate._changing = true;
            _gate._mutex.lock();
        }
        ~Change()
        {
            _gate._changing = false;
            _gate._mutex.unlock();
        }
        Change(const Change &) = delete;
        Change &operator=(const Change &) = delete;

    private:
        UseGate &_gate;
    };

private:
    std::shared_mutex _mutex;
    std::atomic<bool> _changing{false};  // a change lasts, or waits for users
};

}  // namespace Rabit
