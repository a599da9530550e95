#include "AnnouncementThread.h"

#include <utility>

namespace Rabit::Cyclone
{

AnnouncementThread::AnnouncementThread(std::chrono::milliseconds answerGap, bool hasCard)
    : _rounds(answerGap, Clock::now(), hasCard)
{
}

AnnouncementThread::~AnnouncementThread()
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

void AnnouncementThread::Start(Calls calls)
{
    _calls = std::move(calls);
    _thread = std::thread([this] { Run(); });
}

void AnnouncementThread::OnPeer()
{
    {
        const std::lock_guard lock(_mutex);
        _rounds.OnPeer(Clock::now());
    }
    _changed.notify_one();
}

void AnnouncementThread::Run()
{
    std::unique_lock lock(_mutex);
    while (!_stop)
    {
        const auto due = _rounds.Due();
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
        lock.unlock();
        const bool unheard = _calls.IsUnheard();
        lock.lock();
        if (_rounds.Next(Clock::now(), unheard))
        {
            lock.unlock();
            _calls.Announce();
            lock.lock();
        }
    }
}

}  // namespace Rabit::Cyclone
