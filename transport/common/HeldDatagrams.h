#pragma once

#include <cstddef>
#include <deque>
#include <functional>
#include <mutex>
#include <utility>

namespace Rabit
{

// The datagrams of a sample that wait for their turn (TransportWriter::WriteHeld). While a Scope lives, the
// backend's output offers each datagram that its thread sends to Scope::Keep, and leaves out what that takes.
// The first one is not taken: it goes at once.
//
// Any thread. Nothing is sent with the lock held. Bounded by the largest sample: there is one at a time.
class HeldDatagrams
{
public:
    static constexpr std::size_t IpAndUdp = 20 + 8;

    // The datagrams that this thread sends until the end of the scope belong to a sample.
    class Scope
    {
    public:
        explicit Scope(HeldDatagrams &held) : _held(held) { _ofThread = this; }
        ~Scope() { _ofThread = nullptr; }
        Scope(const Scope &) = delete;
        Scope &operator=(const Scope &) = delete;

        // Returns whether `send` is kept, to be called later, instead of the datagram being sent now. To be
        // called by the thread of the scope.
        template <typename Send>
        bool Keep(std::size_t bytesOnAir, Send &&send)
        {
            if (std::exchange(_isFirst, false))
            {
                return false;
            }
            const std::lock_guard lock(_held._mutex);
            _held._held.emplace_back(bytesOnAir, std::forward<Send>(send));
            return true;
        }

    private:
        HeldDatagrams &_held;
        bool _isFirst = true;
    };
    // Null: what this thread sends goes at once.
    static Scope *OfThisThread() { return _ofThread; }

    // Of the next one; 0: there is none.
    std::size_t NextBytes() const
    {
        const std::lock_guard lock(_mutex);
        return _held.empty() ? 0 : _held.front().first;
    }
    // Returns false if there was none.
    bool SendNext()
    {
        std::function<void()> send;
        {
            const std::lock_guard lock(_mutex);
            if (_held.empty())
            {
                return false;
            }
            send = std::move(_held.front().second);
            _held.pop_front();
        }
        send();
        return true;
    }
    void SendAll()
    {
        while (SendNext())
        {
        }
    }

private:
    static inline thread_local Scope *_ofThread = nullptr;

    mutable std::mutex _mutex;
    std::deque<std::pair<std::size_t, std::function<void()>>> _held;
};

}  // namespace Rabit
