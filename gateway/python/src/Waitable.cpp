#include "Waitable.h"

#include <poll.h>
#include <sys/eventfd.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cstdint>
#include <system_error>

#include "Seconds.h"

namespace Rabit::Python
{
namespace
{

// A signal may reach another thread than the waiting one, which Python lets handle it. This is how late that
// is noticed.
constexpr std::chrono::nanoseconds LongestSleep = std::chrono::milliseconds(200);

}  // namespace

Waitable::Event::~Event()
{
    if (_fd >= 0)
    {
        close(_fd);
    }
}

int Waitable::Event::Fd()
{
    if (_fd < 0)
    {
        const int made = eventfd(0, EFD_CLOEXEC | EFD_NONBLOCK);
        if (made < 0)
        {
            return made;
        }
        _fd = made;
        if (_isClosed)
        {
            Write();
        }
    }
    return _fd;
}

void Waitable::Event::Notify()
{
    if (_isArmed.exchange(false))
    {
        Write();
    }
}

void Waitable::Event::Write()
{
    const std::uint64_t one = 1;
    static_cast<void>(!write(_fd, &one, sizeof one));
}

void Waitable::Event::Drain()
{
    std::uint64_t count = 0;
    static_cast<void>(!read(_fd, &count, sizeof count));
    if (_isClosed)
    {
        Write();
    }
}

void Waitable::Event::Close()
{
    _isClosed = true;
    Write();
}

int Waitable::Fd()
{
    const int fd = _loop.Fd();
    if (fd < 0)
    {
        throw std::system_error(errno, std::generic_category(), "eventfd");
    }
    return fd;
}

void Waitable::Notify()
{
    _threads.Notify();
    _loop.Notify();
}

void Waitable::Close()
{
    _threads.Close();
    _loop.Close();
}

bool Waitable::Wait(std::optional<double> seconds, const std::function<bool()> &isReady)
{
    using Clock = std::chrono::steady_clock;
    const auto start = Clock::now();
    const std::chrono::nanoseconds limit = seconds ? DurationOf(*seconds) : Forever;
    const int fd = _threads.Fd();
    for (;;)
    {
        _threads.Arm();
        if (isReady())
        {
            return true;
        }
        const std::chrono::nanoseconds left = limit - (Clock::now() - start);
        if (left.count() <= 0)
        {
            return false;
        }
        {
            const pybind11::gil_scoped_release released;
            pollfd waited{fd, POLLIN, 0};
            const auto nanoseconds = std::min(left, LongestSleep).count();
            const timespec sleep{nanoseconds / 1000000000, nanoseconds % 1000000000};
            ppoll(&waited, 1, &sleep, nullptr);
        }
        _threads.Drain();
        if (PyErr_CheckSignals() != 0)
        {
            throw pybind11::error_already_set();
        }
    }
}

}  // namespace Rabit::Python
