#include "guard/AuthenticationThread.h"

#include <utility>

namespace Rabit::Rtps
{

void AuthenticationThread::Start(Calls calls)
{
    {
        const std::lock_guard lock(_mutex);
        _calls = std::move(calls);
    }
    _thread = std::thread([this] { Run(); });
}

void AuthenticationThread::Stop()
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

bool AuthenticationThread::Announced(const GuidPrefix &peer, const AuthenticationRetries::Content &content)
{
    const std::lock_guard lock(_mutex);
    const bool isNew = _retries.Announced(peer, content, Clock::now());
    // Nothing is due within seconds of now, so the thread need only be woken from a sleep without an end.
    if (_sleeps && _retries.Due({}))
    {
        _changed.notify_one();
    }
    return isNew;
}

bool AuthenticationThread::Signs(const GuidPrefix &peer, const std::vector<std::uint64_t> &addresses)
{
    const std::lock_guard lock(_mutex);
    return _retries.Signs(peer, addresses);
}

void AuthenticationThread::Exchanged(const GuidPrefix &peer, const KeyExchange &what, bool isSent)
{
    // Datagrams that are protected as a whole come after an exchange.
    if (what.IsWhole || what.IsIdle || what.IsForOther)
    {
        return;
    }
    const std::lock_guard lock(_mutex);
    _retries.Exchanged(peer, what.What, isSent, Clock::now());
}

void AuthenticationThread::Gone(const GuidPrefix &peer)
{
    {
        const std::lock_guard lock(_mutex);
        _retries.Gone(peer);
        if (_stop || !_calls.Drop)
        {
            return;
        }
    }
    _calls.Drop(peer);
}

bool AuthenticationThread::WasForgotten(const GuidPrefix &peer) const
{
    const std::lock_guard lock(_mutex);
    return _retries.WasForgotten(peer);
}

void AuthenticationThread::Run()
{
    std::unique_lock lock(_mutex);
    while (!_stop)
    {
        lock.unlock();
        const auto answerTime = _calls.AnswerTime();
        lock.lock();
        const auto due = _retries.Due(answerTime);
        if (_stop)
        {
            return;
        }
        if (!due)
        {
            _sleeps = true;
            _changed.wait(lock);
            _sleeps = false;
            continue;
        }
        if (Clock::now() < *due)
        {
            // Something else may become due meanwhile, but not much earlier.
            _changed.wait_until(lock, std::min(*due, Clock::now() + std::chrono::seconds(1)));
            continue;
        }
        for (const GuidPrefix &peer : _retries.Doubtful(Clock::now(), answerTime))
        {
            if (!_stop)
            {
                LookAt(peer, lock);
            }
        }
    }
}

void AuthenticationThread::LookAt(const GuidPrefix &peer, std::unique_lock<std::mutex> &lock)
{
    lock.unlock();
    const bool isAuthenticated = _calls.IsAuthenticated(peer);
    const bool isWaiting = !isAuthenticated && _calls.IsWaiting(peer);
    lock.lock();
    if (isAuthenticated)
    {
        _retries.IsAuthenticated(peer);
    }
    else if (isWaiting)
    {
        _retries.IsWaiting(peer, Clock::now());
    }
    else
    {
        const std::int64_t number = _retries.Forget(peer);
        lock.unlock();
        _calls.Forget(peer, number);
        lock.lock();
    }
}

}  // namespace Rabit::Rtps
