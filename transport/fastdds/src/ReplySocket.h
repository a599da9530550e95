#pragma once

#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <cstdint>
#include <span>

#include "common/Ledger.h"

namespace Rabit::FastDds
{

// A socket for a node whose vendor has not sent anything yet: without multicast and peers it first sends when
// it has heard of somebody. Sends to single addresses, and receives nothing. Not thread-safe.
class ReplySocket
{
public:
    ReplySocket() = default;
    ~ReplySocket()
    {
        if (_socket >= 0)
        {
            ::close(_socket);
        }
    }
    ReplySocket(const ReplySocket &) = delete;
    ReplySocket &operator=(const ReplySocket &) = delete;

    // Does not block. A datagram that cannot be sent is lost.
    void Send(const Rtps::Place &to, std::span<const std::uint8_t> datagram)
    {
        if (_socket < 0)
        {
            _socket = ::socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0);
        }
        sockaddr_in address{};
        address.sin_family = AF_INET;
        address.sin_port = htons(to.Port);
        std::copy(to.Host.begin(), to.Host.end(), reinterpret_cast<std::uint8_t *>(&address.sin_addr.s_addr));
        static_cast<void>(::sendto(_socket, datagram.data(), datagram.size(), 0,
                                   reinterpret_cast<const sockaddr *>(&address), sizeof(address)));
    }

private:
    int _socket = -1;
};

}  // namespace Rabit::FastDds
