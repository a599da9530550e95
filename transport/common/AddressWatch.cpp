#include "common/AddressWatch.h"

#include <linux/netlink.h>
#include <linux/rtnetlink.h>
#include <poll.h>
#include <sys/eventfd.h>
#include <sys/socket.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <system_error>
#include <utility>

namespace Rabit
{

namespace
{

// Changes less than this apart belong to one burst: an interface that comes up causes several within
// milliseconds.
constexpr std::chrono::milliseconds Pause{100};
constexpr std::chrono::milliseconds LongestBurst{500};
constexpr int Forever = -1;

}  // namespace

AddressWatch::Descriptor::Descriptor(int value, const char *what) : _value(value)
{
    if (value < 0)
    {
        throw std::system_error(errno, std::generic_category(), what);
    }
}

AddressWatch::Descriptor::~Descriptor()
{
    close(_value);
}

AddressWatch::AddressWatch(std::function<std::optional<std::chrono::milliseconds>()> look)
    : _look(std::move(look)),
      _netlink(socket(AF_NETLINK, SOCK_RAW | SOCK_CLOEXEC | SOCK_NONBLOCK, NETLINK_ROUTE), "netlink socket"),
      _stop(eventfd(0, EFD_CLOEXEC | EFD_NONBLOCK), "eventfd")
{
    sockaddr_nl address{};
    address.nl_family = AF_NETLINK;
    address.nl_groups = RTMGRP_LINK | RTMGRP_IPV4_IFADDR;
    if (bind(_netlink.Get(), reinterpret_cast<const sockaddr *>(&address), sizeof address) != 0)
    {
        throw std::system_error(errno, std::generic_category(), "binding a netlink socket");
    }
    _thread = std::thread([this] { Run(); });
}

AddressWatch::~AddressWatch()
{
    const std::uint64_t one = 1;
    // An eventfd takes its first 2^64 - 2 counts without fail.
    [[maybe_unused]] const auto written = write(_stop.Get(), &one, sizeof one);
    _thread.join();
}

void AddressWatch::Run()
{
    using Clock = std::chrono::steady_clock;
    while (true)
    {
        const auto again = _look();
        Event event = Wait(again ? static_cast<int>(again->count()) : Forever);
        for (const auto end = Clock::now() + LongestBurst; event == Event::News && Clock::now() < end;)
        {
            event = Wait(static_cast<int>(Pause.count()));
        }
        if (event == Event::Stop)
        {
            return;
        }
    }
}

AddressWatch::Event AddressWatch::Wait(int milliseconds)
{
    std::array<pollfd, 2> descriptors{{{_netlink.Get(), POLLIN, 0}, {_stop.Get(), POLLIN, 0}}};
    poll(descriptors.data(), descriptors.size(), milliseconds);
    if (descriptors[1].revents != 0)
    {
        return Event::Stop;
    }
    // The content does not matter, since all networks are listed afresh. An error means that more changes
    // came than the kernel's buffer holds, which is a change too.
    std::array<char, 8192> ignored;
    for (int messages = 0; messages < 1000 && recv(_netlink.Get(), ignored.data(), ignored.size(), 0) > 0;
         ++messages)
    {
    }
    return descriptors[0].revents != 0 ? Event::News : Event::Silence;
}

}  // namespace Rabit
