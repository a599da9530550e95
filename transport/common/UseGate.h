// Lets many threads use an object, and one thread change it while nobody uses it. Users never wait for a
// change: as soon as one is wanted, they are turned away.
#pragma once

#include <condition_variable>
#include <mutex>

namespace Rabit
{

class UseGate
{
public:
    // Keeps the object unchanged while it lives, if Allowed().
    class Use
    {
    public:
        explicit Use(UseGate &gate) : _gate(gate), _allowed(gate.Enter()) {}
        ~Use()
        {
            if (_allowed)
            {
                _gate.Leave();
            }
        }
        Use(const Use &) = delete;
        Use &operator=(const Use &) = delete;
        bool Allowed() const { return _allowed; }

    private:
        UseGate &_gate;
        const bool _allowed;
    };

    // Its constructor waits for the current users. While it lives, the object has no user. Only one at a
    // time.
    class Change
    {
    public:
        explicit Change(UseGate &gate) : _gate(gate)
        {
            std::unique_lock lock(_gate._mutex);
            _gate._changing = true;
            _gate._event.wait(lock, [this] { return _gate._users == 0; });
        }
        ~Change()
        {
            const std::lock_guard lock(_gate._mutex);
            _gate._changing = false;
        }
        Change(const Change &) = delete;
        Change &operator=(const Change &) = delete;

    private:
        UseGate &_gate;
    };

private:
    bool Enter()
    {
        const std::lock_guard lock(_mutex);
        if (_changing)
        {
            return false;
        }
        ++_users;
        return true;
    }
    void Leave()
    {
        bool last = false;
        {
            const std::lock_guard lock(_mutex);
            last = --_users == 0 && _changing;
        }
        if (last)
        {
            _event.notify_all();
        }
    }

    std::mutex _mutex;
    std::condition_variable _event;
    int _users = 0;          // guarded by _mutex
    bool _changing = false;  // guarded by _mutex
};

}  // namespace Rabit
