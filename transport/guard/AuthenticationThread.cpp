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
    DueThread::Start();
}

// Requires _mutex. Something may become due after what was noted. The retries are not searched for the time
// at each datagram: the thread looks once in _lookEvery while anything is due at all.
void AuthenticationThread::Noted()
{
    if (!_lookAt && _retries.Due({}))
    {
        _lookAt = Clock::now() + _lookEvery;
        WakeIfEarlier();
    }
}

bool AuthenticationThread::Announced(const GuidPrefix &peer, const AuthenticationRetries::Content &content)
{
    const std::lock_guard lock(_mutex);
    const bool isNew = _retries.Announced(peer, content, Clock::now());
    Noted();
    return isNew;
}

bool AuthenticationThread::Signs(const GuidPrefix &peer, const SignedContent &content)
{
    const std::lock_guard lock(_mutex);
    return _retries.Signs(peer, content);
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
    Noted();
}

void AuthenticationThread::SaidGoodbye(const GuidPrefix &peer)
{
    const std::lock_guard lock(_mutex);
    _retries.SaidGoodbye(peer, Clock::now());
    Noted();
}

void AuthenticationThread::Gone(const GuidPrefix &peer)
{
    {
        const std::lock_guard lock(_mutex);
        _retries.Gone(peer);
        if (IsStopped() || !_calls.Drop)
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

void AuthenticationThread::Work(std::unique_lock<std::mutex> &lock)
{
    const std::vector<GuidPrefix> toAsk = _retries.TakeToAsk();
    lock.unlock();
    const auto answerTime = _calls.AnswerTime();
    if (_calls.Ask)
    {
        std::for_each(toAsk.begin(), toAsk.end(), _calls.Ask);
    }
    lock.lock();
    for (const GuidPrefix &peer : _retries.Doubtful(Clock::now(), answerTime))
    {
        if (!IsStopped())
        {
            LookAt(peer, lock);
        }
    }
    const auto due = _retries.Due(answerTime);
    _lookAt = due ? std::optional(std::min(*due, Clock::now() + _lookEvery)) : std::nullopt;
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
