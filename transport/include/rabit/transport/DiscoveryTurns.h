#pragma once

#include <algorithm>
#include <array>
#include <atomic>
#include <chrono>
#include <cstddef>
#include <functional>
#include <mutex>
#include <utility>

namespace Rabit
{

// Lets the holder of a session decide when the session's discovery sends: the exchange of cards and, on a
// node with keys, the introduction of its sealed session. They wait for their turn, as everything else that
// the holder sends. Until Schedule is called, they send by themselves.
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
    // The exchanges of a session. If several have a datagram due, they take turns, in this order.
    enum class Kind
    {
        Introduction,  // before it, a node with keys reads no card
        Cards
    };
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
        // the nodes; 0: not at all, none was heard for some seconds, or the messages do not tell.
        virtual std::chrono::nanoseconds QueueingDelay() const = 0;

    protected:
        ~Exchange() = default;
    };

    // The holder's side.

    // From now on, the exchanges send in SendNext alone. `onDue` is called, on any thread and without locks,
    // each time that IsDue becomes true. It must not call this object. Call once.
    void Schedule(std::function<void()> onDue)
    {
        _onDue = std::move(onDue);
        _isScheduled = true;
    }
    // True if NextBytes may be more than 0. Costs one load.
    bool IsDue() const { return _isDue; }
    // Exchange::NextBytes of the next exchange that has a datagram due. 0 makes IsDue false until the next
    // call of `onDue`.
    std::size_t NextBytes()
    {
        const std::lock_guard lock(_mutex);
        _isDue = false;
        _next = nullptr;
        for (std::size_t i = 0; i < _exchanges.size(); ++i)
        {
            const std::size_t place = (_first + i) % _exchanges.size();
            Exchange *const exchange = _exchanges[place];
            const std::size_t bytes = exchange != nullptr ? exchange->NextBytes() : 0;
            if (bytes > 0)
            {
                _next = exchange;
                _afterNext = (place + 1) % _exchanges.size();
                _isDue = true;
                return bytes;
            }
        }
        return 0;
    }
    // Exchange::SendNext of the exchange whose bytes NextBytes returned last.
    void SendNext()
    {
        const std::lock_guard lock(_mutex);
        if (_next != nullptr)
        {
            _next->SendNext();
            _first = _afterNext;
        }
    }
    // The longest Exchange::QueueingDelay.
    std::chrono::nanoseconds QueueingDelay()
    {
        const std::lock_guard lock(_mutex);
        std::chrono::nanoseconds longest{0};
        for (const Exchange *const exchange : _exchanges)
        {
            longest = exchange != nullptr ? std::max(longest, exchange->QueueingDelay()) : longest;
        }
        return longest;
    }

    // The session's side.

    // From now on `exchange` takes turns, in place of an earlier one of that kind. The earlier one is not
    // called any more when this returns.
    void SetExchange(Exchange &exchange, Kind kind = Kind::Cards)
    {
        const std::lock_guard lock(_mutex);
        Exchange *&place = _exchanges[static_cast<std::size_t>(kind)];
        _next = _next == place ? nullptr : _next;
        place = &exchange;
    }
    // `exchange` is not called any more when this returns. Nothing happens if it takes no turns.
    void RemoveExchange(const Exchange &exchange)
    {
        const std::lock_guard lock(_mutex);
        for (Exchange *&place : _exchanges)
        {
            place = place == &exchange ? nullptr : place;
        }
        _next = _next == &exchange ? nullptr : _next;
    }
    // True if the exchanges send in SendNext alone, and call Due when a datagram is due.
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
    // Of each Kind. Guarded by _mutex, which is held while their functions run.
    std::array<Exchange *, 2> _exchanges{};
    // Guarded by _mutex: the exchange that sends in SendNext, the place after it, and the place that is asked first.
    Exchange *_next = nullptr;
    std::size_t _afterNext = 0;
    std::size_t _first = 0;
    std::function<void()> _onDue;  // set before _isScheduled, and not changed afterwards
    std::atomic<bool> _isScheduled{false};
    std::atomic<bool> _isDue{false};
};

}  // namespace Rabit
