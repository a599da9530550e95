#include "OutboxThread.h"

#include <utility>

namespace Rabit::Cyclone
{

OutboxThread::OutboxThread(std::shared_ptr<DiscoveryTurns> turns, Send send)
    : _turns(std::move(turns)), _send(std::move(send)), _thread([this] { Run(); })
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
        _exchanges.SetRate(_turns->KeyRate());
        if (!_exchanges.Put(datagram, what, _routes.Of(route).first, Clock::now()))
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

bool OutboxThread::IsWaiting(const KeyExchange::Prefix &peer)
{
    const std::lock_guard lock(_mutex);
    return _exchanges.IsWaiting(peer);
}

void OutboxThread::Forget(const KeyExchange::Prefix &peer)
{
    const std::lock_guard lock(_mutex);
    _exchanges.Forget(peer);
}

void OutboxThread::SendExchanges(std::unique_lock<std::mutex> &lock)
{
    for (const KeyExchangeOutbox::Datagram &datagram : _exchanges.TakeDue(Clock::now()))
    {
        const auto *const known = _routes.KeyOf(datagram.Route);
        if (known == nullptr)
        {
            continue;  // thousands of others have come since
        }
        const RabitCycloneRoute route = *known;
        lock.unlock();
        _send(route, datagram.Bytes);
        lock.lock();
    }
}

void OutboxThread::Run()
{
    std::unique_lock lock(_mutex);
    while (!_stop)
    {
        const auto due = _exchanges.Due();
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
        SendExchanges(lock);
    }
}

}  // namespace Rabit::Cyclone
