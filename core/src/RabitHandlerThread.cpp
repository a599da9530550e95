#include <rabit/RabitHandlerThread.h>

#include <system_error>
#include <utility>

namespace Rabit
{

bool RabitHandlerThread::Scope::HandOver(const std::shared_ptr<Detail::EventSlot> &handler) const
{
    return _thread->Add(handler, _subject, _shareOwner(_owner));
}

RabitHandlerThread::~RabitHandlerThread()
{
    Stop();
}

void RabitHandlerThread::Stop()
{
    std::thread thread;
    {
        const std::lock_guard<std::mutex> lock(_mutex);
        _stopped = true;
        thread.swap(_thread);
    }
    _changed.notify_all();
    if (thread.joinable())
    {
        thread.join();
    }
}

bool RabitHandlerThread::Add(const std::shared_ptr<Detail::EventSlot> &handler, const std::string &subject,
                             std::shared_ptr<const void> owner)
{
    {
        const std::lock_guard<std::mutex> lock(_mutex);
        if (_stopped || !IsStarted())
        {
            return false;
        }
        // A read-modify-write, so that the waiting call sees everything that happened before this event.
        if (handler->Waits.exchange(true, std::memory_order_acq_rel))
        {
            return true;
        }
        _waiting.push_back({handler, subject, std::move(owner)});
    }
    _changed.notify_one();
    return true;
}

// The caller holds the mutex.
bool RabitHandlerThread::IsStarted()
{
    try
    {
        if (!_thread.joinable())
        {
            _thread = std::thread([this] { Run(); });
        }
        return true;
    }
    catch (const std::system_error &)
    {
        return false;
    }
}

void RabitHandlerThread::Run()
{
    std::unique_lock<std::mutex> lock(_mutex);
    for (;;)
    {
        _changed.wait(lock, [this] { return _stopped || !_waiting.empty(); });
        if (_waiting.empty())
        {
            return;
        }
        {
            const Waiting next = std::move(_waiting.front());
            _waiting.pop_front();
            lock.unlock();
            Call(next);
        }
        lock.lock();
    }
}

void RabitHandlerThread::Call(const Waiting &waiting)
{
    // Reset before the call: later events need another call.
    waiting.Handler->Waits.exchange(false, std::memory_order_acq_rel);
    if (!waiting.Handler->Connected.load(std::memory_order_acquire))
    {
        return;
    }
    if (_watch != nullptr)
    {
        _watch->Begins(waiting.Subject);
    }
    Detail::CallHandler(*waiting.Handler);
    if (_watch != nullptr)
    {
        _watch->Returned();
    }
}

}  // namespace Rabit
