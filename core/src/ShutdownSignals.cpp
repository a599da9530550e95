#include "ShutdownSignals.h"

#include <rabit/RabitLog.h>
#include <rabit/RabitReactor.h>

#include <array>
#include <cerrno>
#include <cstdint>
#include <ctime>
#include <mutex>

#include <csignal>

namespace Rabit
{
namespace
{

constexpr std::array<int, 3> Signals{SIGINT, SIGTERM, SIGHUP};

// The handler uses lock-free atomics, clock_gettime, sem_post, sigaction and raise only: all
// async-signal-safe (POSIX.1-2017, 2.4.3).
static_assert(std::atomic<bool>::is_always_lock_free && std::atomic<std::int64_t>::is_always_lock_free);

struct SignalState
{
    std::array<ShutdownSignals::Place, 64> Places;
    std::array<std::atomic<bool>, Signals.size()> Installed{};
    std::atomic<std::int64_t> FirstAt{0};  // the first signal by the monotonic clock, in ns; 0: none has come
    std::mutex Mutex;                      // for what follows; never taken by the handler
    int Listeners = 0;
};

// Never destroyed; made before the handler is installed.
SignalState &State()
{
    static SignalState *const state = []
    {
        auto *made = new SignalState();
        for (ShutdownSignals::Place &place : made->Places)
        {
            sem_init(&place.Semaphore, 0, 0);
        }
        return made;
    }();
    return *state;
}

void RestoreDefault(int signal)
{
    struct sigaction action = {};
    action.sa_handler = SIG_DFL;
    sigemptyset(&action.sa_mask);
    sigaction(signal, &action, nullptr);
}

std::int64_t MonotonicNanoseconds()
{
    std::timespec now{};
    clock_gettime(CLOCK_MONOTONIC, &now);
    return std::int64_t(now.tv_sec) * 1'000'000'000 + now.tv_nsec;
}

extern "C" void OnShutdownSignal(int signal)
{
    const int savedErrno = errno;
    SignalState &state = State();
    const std::int64_t now = MonotonicNanoseconds();
    std::int64_t first = 0;
    if (!state.FirstAt.compare_exchange_strong(first, now))
    {
        if (now - first >= std::chrono::nanoseconds(RabitReactor::SignalRepeat).count())
        {
            RestoreDefault(signal);
            raise(signal);  // takes effect when the handler returns, since the signal is blocked in it
        }
        errno = savedErrno;
        return;
    }
    for (ShutdownSignals::Place &place : state.Places)
    {
        if (place.InUse.load())
        {
            place.SignalCame.store(true);
            sem_post(&place.Semaphore);
        }
    }
    errno = savedErrno;
}

void InstallHandlers(SignalState &state)
{
    for (std::size_t i = 0; i < Signals.size(); ++i)
    {
        struct sigaction current = {};
        sigaction(Signals[i], nullptr, &current);
        if ((current.sa_flags & SA_SIGINFO) != 0 || current.sa_handler != SIG_DFL)
        {
            continue;  // the program handles or ignores it
        }
        struct sigaction action = {};
        action.sa_handler = OnShutdownSignal;
        sigemptyset(&action.sa_mask);
        for (const int signal : Signals)
        {
            sigaddset(&action.sa_mask, signal);
        }
        action.sa_flags = SA_RESTART;
        state.Installed[i].store(true);
        sigaction(Signals[i], &action, nullptr);
    }
}

void RemoveHandlers(SignalState &state)
{
    for (std::size_t i = 0; i < Signals.size(); ++i)
    {
        if (!state.Installed[i].exchange(false))
        {
            continue;
        }
        struct sigaction current = {};
        sigaction(Signals[i], nullptr, &current);
        if ((current.sa_flags & SA_SIGINFO) == 0 && current.sa_handler == OnShutdownSignal)
        {
            RestoreDefault(Signals[i]);
        }
    }
}

// Null if all places are taken.
ShutdownSignals::Place *TakePlace(SignalState &state)
{
    for (ShutdownSignals::Place &place : state.Places)
    {
        if (!place.InUse.load())
        {
            while (sem_trywait(&place.Semaphore) == 0)
            {
            }
            place.SignalCame.store(false);
            place.InUse.store(true);
            return &place;
        }
    }
    return nullptr;
}

}  // namespace

ShutdownSignals::ShutdownSignals(bool handle) : _place(&_own)
{
    sem_init(&_own.Semaphore, 0, 0);
    if (!handle)
    {
        return;
    }
    SignalState &state = State();
    const std::lock_guard<std::mutex> lock(state.Mutex);
    Place *const place = TakePlace(state);
    if (place == nullptr)
    {
        RabitLog::Write(RabitLogLevel::Warning,
                        "too many reactors run: one does not react to SIGINT, SIGTERM and SIGHUP");
        return;
    }
    _place = place;
    if (++state.Listeners == 1)
    {
        state.FirstAt.store(0);
        InstallHandlers(state);
    }
}

ShutdownSignals::~ShutdownSignals()
{
    if (_place != &_own)
    {
        SignalState &state = State();
        const std::lock_guard<std::mutex> lock(state.Mutex);
        _place->InUse.store(false);
        if (--state.Listeners == 0)
        {
            RemoveHandlers(state);
        }
    }
    sem_destroy(&_own.Semaphore);
}

void ShutdownSignals::WaitFor(std::chrono::nanoseconds longest)
{
    const auto until = std::chrono::steady_clock::now().time_since_epoch() + longest;
    const auto seconds = std::chrono::floor<std::chrono::seconds>(until);
    std::timespec deadline{};
    deadline.tv_sec = static_cast<std::time_t>(seconds.count());
    deadline.tv_nsec = static_cast<long>((until - seconds).count());
    // Another signal may interrupt this: then WaitFor returns spuriously, as documented.
    sem_clockwait(&_place->Semaphore, CLOCK_MONOTONIC, &deadline);
}

void ShutdownSignals::Wake()
{
    sem_post(&_place->Semaphore);
}

bool ShutdownSignals::SignalCame() const
{
    return _place->SignalCame.load();
}

}  // namespace Rabit
