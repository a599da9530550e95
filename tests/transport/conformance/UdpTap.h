// Listens to what goes to a port of loopback.
#pragma once

#include <arpa/inet.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <stdexcept>
#include <string>
#include <vector>

namespace Rabit::Conformance
{

// Takes the datagrams that have come whenever one of its functions is called. Not thread-safe.
class UdpTap
{
public:
    // `port`: 0 for any. `group`: the multicast group to listen to; empty: none. Throws std::runtime_error.
    UdpTap(int port, const std::string &group) : _socket(socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0))
    {
        constexpr int yes = 1;
        constexpr int buffer = 4 << 20;
        sockaddr_in address{};
        address.sin_family = AF_INET;
        address.sin_port = htons(static_cast<std::uint16_t>(port));
        address.sin_addr.s_addr = htonl(group.empty() ? INADDR_LOOPBACK : INADDR_ANY);
        socklen_t size = sizeof address;
        bool good = _socket >= 0 && setsockopt(_socket, SOL_SOCKET, SO_REUSEADDR, &yes, sizeof yes) == 0 &&
                    setsockopt(_socket, SOL_SOCKET, SO_REUSEPORT, &yes, sizeof yes) == 0 &&
                    setsockopt(_socket, SOL_SOCKET, SO_RCVBUF, &buffer, sizeof buffer) == 0 &&
                    bind(_socket, reinterpret_cast<const sockaddr *>(&address), size) == 0 &&
                    getsockname(_socket, reinterpret_cast<sockaddr *>(&address), &size) == 0;
        if (good && !group.empty())
        {
            ip_mreq membership{};
            membership.imr_interface.s_addr = htonl(INADDR_LOOPBACK);
            good = inet_pton(AF_INET, group.c_str(), &membership.imr_multiaddr) == 1 &&
                   setsockopt(_socket, IPPROTO_IP, IP_ADD_MEMBERSHIP, &membership, sizeof membership) == 0;
        }
        if (!good)
        {
            close(_socket);
            throw std::runtime_error("cannot listen to a port of loopback");
        }
        _port = ntohs(address.sin_port);
    }
    ~UdpTap() { close(_socket); }
    UdpTap(const UdpTap &) = delete;
    UdpTap &operator=(const UdpTap &) = delete;

    int Port() const { return _port; }
    // Datagrams that are sealed (transport/envelope/Outer.h), and all others. A single zero byte, which wakes
    // a thread, is neither.
    std::size_t Sealed()
    {
        Take();
        return static_cast<std::size_t>(std::count_if(_datagrams.begin(), _datagrams.end(), IsSealed));
    }
    std::size_t Plain()
    {
        Take();
        return static_cast<std::size_t>(std::count_if(_datagrams.begin(), _datagrams.end(),
                                                      [](const Bytes &one)
                                                      { return !IsSealed(one) && one != Bytes{0}; }));
    }
    // True if a datagram contains the text.
    bool Saw(const std::string &text)
    {
        Take();
        return std::any_of(
            _datagrams.begin(), _datagrams.end(),
            [&](const Bytes &one)
            { return std::search(one.begin(), one.end(), text.begin(), text.end()) != one.end(); });
    }
    std::size_t Largest()
    {
        Take();
        std::size_t largest = 0;
        for (const Bytes &one : _datagrams)
        {
            largest = std::max(largest, one.size());
        }
        return largest;
    }

    // Sends a datagram to where the last one came from.
    void Answer(const std::vector<std::uint8_t> &datagram)
    {
        Take();
        static_cast<void>(sendto(_socket, datagram.data(), datagram.size(), 0,
                                 reinterpret_cast<const sockaddr *>(&_from), sizeof _from));
    }

private:
    using Bytes = std::vector<std::uint8_t>;

    static bool IsSealed(const Bytes &datagram)
    {
        return !datagram.empty() && (datagram.front() & 0xc0) == 0x80;
    }
    void Take()
    {
        std::array<std::uint8_t, 65536> buffer{};
        socklen_t length = sizeof _from;
        for (ssize_t size = 0; (size = recvfrom(_socket, buffer.data(), buffer.size(), MSG_DONTWAIT,
                                                reinterpret_cast<sockaddr *>(&_from), &length)) >= 0;)
        {
            _datagrams.emplace_back(buffer.begin(), buffer.begin() + size);
            length = sizeof _from;
        }
    }

    const int _socket;
    int _port = 0;
    std::vector<Bytes> _datagrams;
    sockaddr_in _from{};  // of the last one
};

}  // namespace Rabit::Conformance
