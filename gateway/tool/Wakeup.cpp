#include "Wakeup.h"

#include <pthread.h>
#include <signal.h>

namespace Rabit::Tool
{
namespace
{

// The signal that ends the thread which waits for signals.
constexpr int End = SIGUSR2;

sigset_t Handled()
{
    sigset_t set;
    sigemptyset(&set);
    for (const int number : {SIGINT, SIGTERM, SIGHUP, End})
    {
        sigaddset(&set, number);
    }
    return set;
}

}  // namespace

Wakeup::Wakeup()
{
    // A closed pipe shows as an error of the write.
    signal(SIGPIPE, SIG_IGN);
    const sigset_t handled = Handled();
    pthread_sigmask(SIG_BLOCK, &handled, nullptr);
    _signals = std::thread(
        [this, handled]
        {
            for (int number = 0; sigwait(&handled, &number) == 0 && number != End;)
            {
                {
                    const std::lock_guard lock(_mutex);
                    _interrupted = true;
                }
                Notify();
            }
        });
}

Wakeup::~Wakeup()
{
    pthread_kill(_signals.native_handle(), End);
    _signals.join();
}

void Wakeup::Notify()
{
    {
        const std::lock_guard lock(_mutex);
        ++_changes;
    }
    _changed.notify_all();
}

bool Wakeup::IsInterrupted() const
{
    const std::lock_guard lock(_mutex);
    return _interrupted;
}

bool Wakeup::WaitUntil(Time end, const std::function<bool()> &holds)
{
    for (;;)
    {
        std::uint64_t seen = 0;
        {
            const std::lock_guard lock(_mutex);
            seen = _changes;
        }
        if (holds())
        {
            return true;
        }
        std::unique_lock lock(_mutex);
        if (!_changed.wait_until(lock, end, [&] { return _interrupted || _changes != seen; }) || _interrupted)
        {
            lock.unlock();
            return holds();
        }
    }
}

}  // namespace Rabit::Tool
