#include "OutboxThread.h"

#include <algorithm>
#include <utility>

namespace Rabit::Cyclone
{

OutboxThread::OutboxThread(std::shared_ptr<DiscoveryPace> pace, Send send)
    : _pace(std::move(pace)), _send(std::move(send)), _thread([this] { Run(); })
{
}

OutboxThread::~OutboxThread()
{
    Stop();
}

void OutboxThread::Stop()
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

void OutboxThread::HasGroup(const void *connection)
{
    const std::lock_guard lock(_mutex);
    _groups.insert(connection);
}

bool OutboxThread::Put(std::span<const std::uint8_t> message, std::vector<DiscoveryPart> parts,
                       const RabitCycloneRoute &route, bool hears)
{
    {
        const std::lock_guard lock(_mutex);
        if (_stop)
        {
            return false;
        }
        DiscoveryOutbox::Route way{.Address = NumberOf(route), .Group = {}};
        if (hears && _groups.contains(route.connection))
        {
            way.Group = reinterpret_cast<std::uintptr_t>(route.connection);
        }
        _outbox.SetRate(_pace->Get());
        const auto now = Clock::now();
        for (DiscoveryPart &part : parts)
        {
            _outbox.Put(message, std::move(part), way, now);
        }
        _pace->SetHeldUpSince(_outbox.HeldUpSince());
    }
    _changed.notify_one();
    return true;
}

bool OutboxThread::PutExchange(std::span<const std::uint8_t> datagram, const KeyExchange &what,
                               const RabitCycloneRoute &route)
{
    {
        std::unique_lock lock(_mutex);
        if (_stop)
        {
            return false;
        }
        _self = what.From;
        _exchanges.SetRate(_pace->Get());
        if (!_exchanges.Put(datagram, what, NumberOf(route), Clock::now()))
        {
            return false;
        }
        SendExchanges(lock);
    }
    _changed.notify_one();
    return true;
}

bool OutboxThread::ReceivedExchange(const KeyExchange &what)
{
    bool isHeard = true;
    {
        const std::lock_guard lock(_mutex);
        if (what.To != _self)
        {
            return true;
        }
        isHeard = _exchanges.Received(what, Clock::now());
    }
    _changed.notify_one();
    return isHeard;
}

void OutboxThread::SendExchanges(std::unique_lock<std::mutex> &lock)
{
    for (const KeyExchangeOutbox::Datagram &datagram : _exchanges.TakeDue(Clock::now()))
    {
        const RabitCycloneRoute route = _routes.at(datagram.Route);
        lock.unlock();
        _send(route, false, datagram.Bytes);
        lock.lock();
    }
}

std::optional<OutboxThread::Clock::time_point> OutboxThread::Due() const
{
    const auto discovery = _outbox.Due();
    const auto exchange = _exchanges.Due();
    return discovery && exchange ? std::min(*discovery, *exchange) : discovery ? discovery : exchange;
}

void OutboxThread::Sent(std::size_t size)
{
    const std::lock_guard lock(_mutex);
    _outbox.Sent(size, Clock::now());
}

void OutboxThread::Announced(std::span<const std::uint8_t> message)
{
    const std::lock_guard lock(_mutex);
    _outbox.Announced(message, Clock::now());
}

void OutboxThread::Received(std::span<const std::uint8_t> message)
{
    const std::lock_guard lock(_mutex);
    _outbox.Received(message, Clock::now());
}

std::uint64_t OutboxThread::NumberOf(const RabitCycloneRoute &route)
{
    const auto found = std::find_if(
        _routes.begin(), _routes.end(),
        [&route](const RabitCycloneRoute &other)
        {
            return route.connection == other.connection && route.port == other.port &&
                   std::equal(std::begin(route.address), std::end(route.address), std::begin(other.address));
        });
    const auto number = static_cast<std::uint64_t>(found - _routes.begin());
    if (found == _routes.end())
    {
        _routes.push_back(route);
    }
    return number;
}

void OutboxThread::Run()
{
    std::unique_lock lock(_mutex);
    while (!_stop)
    {
        const auto due = Due();
        if (!due)
        {
            _changed.wait(lock);
            continue;
        }
        if (Clock::now() < *due)
        {
            _changed.wait_until(lock, *due);
            continue;
        }
        for (const auto delay : _pace->TakeLate())
        {
            _outbox.CameLate(delay, Clock::now());
        }
        for (const DiscoveryOutbox::Datagram &datagram : _outbox.TakeDue(Clock::now()))
        {
            const RabitCycloneRoute route = _routes.at(datagram.Address);
            lock.unlock();
            _send(route, datagram.ToGroup, datagram.Bytes);
            lock.lock();
        }
        _pace->SetHeldUpSince(_outbox.HeldUpSince());
        SendExchanges(lock);
    }
}

}  // namespace Rabit::Cyclone
