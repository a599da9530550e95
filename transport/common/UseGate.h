// Lets many threads use something, and one change it while nobody does.
#pragma once

#include <chrono>
#include <condition_variable>
#include <mutex>

namespace Rabit
{

class UseGate
{
public:
    // Holds the thing still while it lives, if Allowed().
    class Use
    {
    public:
        // Waits for a change under way at most that long.
        Use(UseGate &gate, std::chrono::milliseconds longest) : _gate(gate), _allowed(gate.Enter(longest)) {}
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

    // Nobody uses the thing while it lives. One at a time.
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
            {
                const std::lock_guard lock(_gate._mutex);
                _gate._changing = false;
            }
            _gate._event.notify_all();
        }
        Change(const Change &) = delete;
        Change &operator=(const Change &) = delete;

    private:
        UseGate &_gate;
    };

private:
    bool Enter(std::chrono::milliseconds longest)
    {
        std::unique_lock lock(_mutex);
        if (_changing && !_event.wait_for(lock, longest, [this] { return !_changing; }))
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
