#include "Waitable.h"

#include <poll.h>
#include <sys/eventfd.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cstdint>
#include <system_error>

namespace Rabit::Python
{
namespace
{

// A signal may reach another thread than the waiting one, which Python lets handle it. This is how late that
// is noticed.
constexpr double LongestSleep = 0.2;

}  // namespace

Waitable::Waitable() : _fd(eventfd(0, EFD_CLOEXEC | EFD_NONBLOCK))
{
    if (_fd < 0)
    {
        throw std::system_error(errno, std::generic_category(), "eventfd");
    }
}

Waitable::~Waitable()
{
    close(_fd);
}

void Waitable::Notify()
{
    if (_armed.exchange(false))
    {
        Write();
    }
}

void Waitable::Write()
{
    const std::uint64_t one = 1;
    static_cast<void>(!write(_fd, &one, sizeof one));
}

void Waitable::Drain()
{
    std::uint64_t count = 0;
    static_cast<void>(!read(_fd, &count, sizeof count));
    if (_isClosed)
    {
        Write();
    }
}

void Waitable::Close()
{
    _isClosed = true;
    Write();
}

bool Waitable::Wait(std::optional<double> seconds, const std::function<bool()> &isReady)
{
    using Clock = std::chrono::steady_clock;
    const auto start = Clock::now();
    for (;;)
    {
        Arm();
        if (isReady())
        {
            return true;
        }
        const double left =
            seconds ? *seconds - std::chrono::duration<double>(Clock::now() - start).count() : LongestSleep;
        if (left <= 0)
        {
            return false;
        }
        {
            const pybind11::gil_scoped_release released;
            pollfd waited{_fd, POLLIN, 0};
            const auto sleep = std::chrono::duration<double>(std::min(left, LongestSleep));
            const auto nanoseconds = std::chrono::duration_cast<std::chrono::nanoseconds>(sleep).count();
            const timespec limit{nanoseconds / 1000000000, nanoseconds % 1000000000};
            ppoll(&waited, 1, &limit, nullptr);
        }
        Drain();
        if (PyErr_CheckSignals() != 0)
        {
            throw pybind11::error_already_set();
        }
    }
}

}  // namespace Rabit::Python
