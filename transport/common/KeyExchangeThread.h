#pragma once

#include <rabit/transport/DiscoveryTurns.h>

#include <algorithm>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "common/DueThread.h"
#include "common/HandshakeFragments.h"
#include "common/KeyExchangeOutbox.h"
#include "common/RecentNumbers.h"
#include "common/RtpsReader.h"

namespace Rabit
{

// Sends the datagrams of a session's key exchanges when a KeyExchangeOutbox releases them. Route: a way from
// one of the vendor's sockets to an address. Thread-safe.
template <typename Route, typename Less = std::less<Route>>
class KeyExchangeThread final : public DueThread
{
public:
    // Called without a lock of this object, on the thread or in Put.
    using Send = std::function<void(const Route &route, std::vector<std::uint8_t> &datagram)>;
    // Called on the thread, without a lock of this object.
    using Tell = std::function<void(bool isSettled)>;

    // `largest`: size of a datagram with a handshake's message.
    KeyExchangeThread(std::shared_ptr<DiscoveryTurns> turns, std::size_t largest)
        : _turns(std::move(turns)), _largest(largest)
    {
    }
    ~KeyExchangeThread() { Stop(); }

    // Call before Put. Send is not called after Stop.
    void Start(Send send)
    {
        _send = std::move(send);
        DueThread::Start();
    }
    // Calls `tell` soon, and again whenever exchanges have begun or all have settled.
    void TellSettled(Tell tell)
    {
        const std::lock_guard lock(_mutex);
        _tell = std::move(tell);
        WakeIfEarlier();
    }
    // Takes a datagram that the vendor wants to send. Returns false if it should be sent unchanged. Datagrams
    // that may go now are sent on the calling thread. The vendor's locks may be held.
    bool Put(std::span<const std::uint8_t> datagram, const KeyExchange &what, const Route &route)
    {
        std::unique_lock lock(_mutex);
        if (IsStopped())
        {
            return false;
        }
        _self = what.From;
        _exchanges.SetRate(_turns->KeyRate());
        const std::uint64_t number = _routes.Of(route).first;
        const auto pieces = what.IsHandshake() && !what.IsForOther ? CutHandshake(datagram, _largest)
                                                                   : std::vector<std::vector<std::uint8_t>>();
        for (const auto &piece : pieces)
        {
            _exchanges.Put(piece, ReadKeyExchange(piece).value_or(what), number, Clock::now());
        }
        if (pieces.empty() && !_exchanges.Put(datagram, what, number, Clock::now()))
        {
            return false;
        }
        SendDue(lock);
        WakeIfEarlier();
        return true;
    }
    // Takes a received datagram. Returns false if the vendor should not see it.
    bool Received(const KeyExchange &what)
    {
        const std::lock_guard lock(_mutex);
        const bool isHeard = what.To != _self || _exchanges.Received(what, Clock::now());
        WakeIfEarlier();
        return isHeard;
    }
    // Takes any received datagram, before the guard has changed it.
    void Came(std::span<const std::uint8_t> datagram)
    {
        const auto stamp = KeyExchangeStamp::Of(datagram);
        const auto what = stamp ? ReadKeyExchange(datagram) : std::nullopt;
        if (what)
        {
            const std::lock_guard lock(_mutex);
            // The first message of a peer may come before this node has sent one.
            if (what->To == _self || _self == KeyExchange::Prefix{})
            {
                _exchanges.Stamped(what->From, *stamp, Clock::now());
            }
        }
    }
    // True if it is for the own participant.
    bool IsForUs(const KeyExchange &what) const
    {
        const std::lock_guard lock(_mutex);
        return what.To == _self;
    }
    // As in KeyExchangeOutbox.
    bool IsWaiting(const KeyExchange::Prefix &peer) const
    {
        const std::lock_guard lock(_mutex);
        return _exchanges.IsWaiting(peer);
    }
    KeyExchangeOutbox::Duration AnswerTime() const
    {
        const std::lock_guard lock(_mutex);
        return _exchanges.AnswerTime(Clock::now());
    }
    void Forget(const KeyExchange::Prefix &peer)
    {
        const std::lock_guard lock(_mutex);
        _exchanges.Forget(peer);
    }

private:
    std::optional<Clock::time_point> Due() override
    {
        const auto due = _exchanges.Due();
        const auto tellAt = TellAt();
        return due && tellAt ? std::min(*due, *tellAt) : due ? due : tellAt;
    }
    void Work(std::unique_lock<std::mutex> &lock) override
    {
        SendDue(lock);
        const auto now = Clock::now();
        if (const auto tellAt = TellAt(); tellAt && *tellAt <= now)
        {
            _told = Told{.SettledAt = _exchanges.SettledAt(), .IsSettled = _exchanges.SettledAt() <= now};
            const bool isSettled = _told->IsSettled;
            const Tell tell = _tell;
            lock.unlock();
            tell(isSettled);
            lock.lock();
        }
    }
    std::optional<Clock::time_point> TellAt() const
    {
        if (!_tell)
        {
            return std::nullopt;
        }
        if (!_told || (_told->IsSettled && _told->SettledAt != _exchanges.SettledAt()))
        {
            return Clock::time_point{};
        }
        return _told->IsSettled ? std::nullopt : std::optional(_exchanges.SettledAt());
    }
    void SendDue(std::unique_lock<std::mutex> &lock)
    {
        for (KeyExchangeOutbox::Datagram &datagram : _exchanges.TakeDue(Clock::now()))
        {
            // Null: thousands of other routes have come since.
            if (const Route *const known = _routes.KeyOf(datagram.Route))
            {
                const Route route = *known;
                lock.unlock();
                _send(route, datagram.Bytes);
                lock.lock();
            }
        }
    }

    const std::shared_ptr<DiscoveryTurns> _turns;
    const std::size_t _largest;
    Send _send;
    struct Told
    {
        Clock::time_point SettledAt;
        bool IsSettled = false;
    };

    KeyExchangeOutbox _exchanges;  // guarded by _mutex, like those below
    Tell _tell;
    std::optional<Told> _told;           // what _tell was called with last
    KeyExchange::Prefix _self{};         // known once something was exchanged
    RecentNumbers<Route, Less> _routes;  // of _exchanges
};

}  // namespace Rabit
