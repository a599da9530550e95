#pragma once

#include <atomic>
#include <chrono>
#include <cstddef>
#include <functional>
#include <mutex>
#include <utility>

namespace Rabit
{

// Lets the holder of a session decide when the session's exchange of cards sends: the exchange waits for its
// turn, as everything else that the holder sends. Until Schedule is called, the exchange sends by itself.
//
//     DiscoveryTurns *turns = session.Discovery();
//     turns->Schedule([] { wake the sending thread });
//     ... on the sending thread:
//     while (turns->IsDue() && turns->NextBytes() > 0) { turns->SendNext(); }
//
// Announcements of participants, and the endpoint discovery of peers without cards, take no turns.
//
// Thread-safe.
class DiscoveryTurns
{
public:
    // An exchange of a session. Its functions are called one at a time, on the thread that calls NextBytes
    // and SendNext.
    class Exchange
    {
    public:
        // About how many bytes the next datagram takes, with the headers of IP and UDP; 0: none is due. It
        // costs that for each destination: one where nodes hear a group, several where peers are listed.
        virtual std::size_t NextBytes() = 0;
        // Sends one datagram to its destinations, if one is due. May wait for a socket, 100 ms for each.
        virtual void SendNext() = 0;
        // How long the other nodes' messages of this exchange have lately waited in queues: the median of
        // the nodes; 0: not at all, or none was heard for some seconds.
        virtual std::chrono::nanoseconds QueueingDelay() const = 0;

    protected:
        ~Exchange() = default;
    };

    // The holder's side.

    // From now on, the exchange sends in SendNext alone. `onDue` is called, on any thread and without locks,
    // each time that IsDue becomes true. It must not call this object. Call once.
    void Schedule(std::function<void()> onDue)
    {
        _onDue = std::move(onDue);
        _isScheduled = true;
    }
    // True if NextBytes may be more than 0. Costs one load.
    bool IsDue() const { return _isDue; }
    // Exchange::NextBytes. 0 makes IsDue false until the next call of `onDue`.
    std::size_t NextBytes()
    {
        const std::lock_guard lock(_mutex);
        _isDue = false;
        const std::size_t bytes = _exchange != nullptr ? _exchange->NextBytes() : 0;
        if (bytes > 0)
        {
            _isDue = true;
        }
        return bytes;
    }
    void SendNext()
    {
        const std::lock_guard lock(_mutex);
        if (_exchange != nullptr)
        {
            _exchange->SendNext();
        }
    }
    // Exchange::QueueingDelay
    std::chrono::nanoseconds QueueingDelay()
    {
        const std::lock_guard lock(_mutex);
        return _exchange != nullptr ? _exchange->QueueingDelay() : std::chrono::nanoseconds(0);
    }

    // The session's side.

    // From now on `exchange` takes turns, in place of an earlier one. It is not called any more when this, or
    // RemoveExchange, returns.
    void SetExchange(Exchange &exchange)
    {
        const std::lock_guard lock(_mutex);
        _exchange = &exchange;
    }
    // Nothing happens if another one takes turns.
    void RemoveExchange(const Exchange &exchange)
    {
        const std::lock_guard lock(_mutex);
        _exchange = _exchange == &exchange ? nullptr : _exchange;
    }
    // True if the exchange sends in SendNext alone, and calls Due when a datagram is due.
    bool IsScheduled() const { return _isScheduled; }
    // A datagram is due. Call without locks that the exchange's functions take, and after IsScheduled.
    void Due()
    {
        if (!_isDue.exchange(true))
        {
            _onDue();
        }
    }

private:
    std::mutex _mutex;
    Exchange *_exchange = nullptr;  // guarded by _mutex, which is held while its functions run
    std::function<void()> _onDue;   // set before _isScheduled, and not changed afterwards
    std::atomic<bool> _isScheduled{false};
    std::atomic<bool> _isDue{false};
};

}  // namespace Rabit
