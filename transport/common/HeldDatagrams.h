#pragma once

#include <rabit/base/Assert.h>

#include <cstddef>
#include <deque>
#include <functional>
#include <mutex>
#include <utility>

namespace Rabit
{

// The datagrams of a sample that wait for SendHeld (TransportWriter::WriteHeld). While a Scope lives, the
// backend's output offers each datagram that its thread sends to Scope::Keep, and does not send a datagram
// that Keep accepts. Keep refuses the first one, which goes at once.
//
// Thread-safe. Nothing is sent with the lock held. Holds at most one sample, and so at most LargestSample.
class HeldDatagrams
{
public:
    static constexpr std::size_t IpAndUdp = 20 + 8;

    // The datagrams that this thread sends until the end of the scope belong to a sample.
    class Scope
    {
    public:
        explicit Scope(HeldDatagrams &held) : _held(held)
        {
            RABIT_ASSERT(_ofThread == nullptr);
            _ofThread = this;
        }
        ~Scope() { _ofThread = nullptr; }
        Scope(const Scope &) = delete;
        Scope &operator=(const Scope &) = delete;

        // Returns true if `send` is kept, to be called later; false if the datagram must be sent now. Call it
        // on the thread of the scope.
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
    // The scope of the calling thread. Null: its datagrams go at once.
    static Scope *OfThisThread() { return _ofThread; }

    // Bytes of the next datagram on the air; 0: none is held.
    std::size_t NextBytes() const
    {
        const std::lock_guard lock(_mutex);
        return _held.empty() ? 0 : _held.front().first;
    }
    // Sends the next datagram. Returns false if none is held.
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
