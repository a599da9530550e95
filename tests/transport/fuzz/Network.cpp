#include "Network.h"

#include <arpa/inet.h>
#include <linux/if_ether.h>
#include <netpacket/packet.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <sstream>
#include <string>
#include <system_error>
#include <thread>

namespace
{

constexpr int MostAlike = 4;
constexpr std::size_t MostKept = 4000;

[[noreturn]] void Fail(const char *what)
{
    throw std::system_error(errno, std::generic_category(), what);
}

// A line of /proc/net/udp for each socket: its port, unread bytes and lost datagrams.
template <typename Each>
void ForEachSocket(Each each)
{
    std::ifstream file("/proc/net/udp");
    std::string line;
    std::getline(file, line);
    while (std::getline(file, line))
    {
        std::istringstream fields(line);
        std::vector<std::string> all;
        for (std::string field; fields >> field;)
        {
            all.push_back(field);
        }
        const auto number = [&](std::size_t field)
        { return std::stoull(all.at(field).substr(all.at(field).find(':') + 1), nullptr, 16); };
        each(static_cast<std::uint16_t>(number(1)), number(4), std::stoull(all.back()));
    }
}

}  // namespace

Sniffer::Sniffer() : _socket(::socket(AF_PACKET, SOCK_DGRAM, htons(ETH_P_IP)))
{
    if (_socket < 0)
    {
        Fail("packet socket");
    }
    const int size = 64 << 20;
    ::setsockopt(_socket, SOL_SOCKET, SO_RCVBUFFORCE, &size, sizeof size);
}

Sniffer::~Sniffer()
{
    ::close(_socket);
}

void Sniffer::Read(int milliseconds)
{
    static std::array<std::uint8_t, 65536> buffer;
    pollfd waiting{_socket, POLLIN, 0};
    while (::poll(&waiting, 1, milliseconds) > 0)
    {
        milliseconds = 0;
        sockaddr_ll from{};
        socklen_t size = sizeof from;
        const ssize_t got =
            ::recvfrom(_socket, buffer.data(), buffer.size(), 0, reinterpret_cast<sockaddr *>(&from), &size);
        // On loopback the socket sees each datagram twice.
        if (got > 0 && from.sll_pkttype != PACKET_OUTGOING)
        {
            Keep({buffer.data(), static_cast<std::size_t>(got)});
        }
    }
}

void Sniffer::Keep(std::span<const std::uint8_t> packet)
{
    constexpr std::size_t UdpHeader = 8;
    const std::size_t ipHeader = packet.size() >= 20 ? 4u * (packet[0] & 15u) : packet.size();
    constexpr std::uint8_t Udp = 17;
    if (packet.size() < ipHeader + UdpHeader + 24 || packet[9] != Udp)
    {
        return;
    }
    const auto content = packet.subspan(ipHeader + UdpHeader);
    const bool isRtps = std::memcmp(content.data(), "RTPS", 4) == 0;
    const bool isSealed = (content[0] & 0xc0) == 0x80;  // transport/envelope/Outer.h
    if (!isRtps && !isSealed)
    {
        return;
    }
    std::uint32_t address = 0;
    std::memcpy(&address, packet.data() + 16, sizeof address);
    const auto port = static_cast<std::uint16_t>(packet[ipHeader + 2] << 8 | packet[ipHeader + 3]);
    ++_destinations[{address, port}];

    Datagram datagram(content.begin(), content.end());
    std::vector<std::uint32_t> likeness = {port, static_cast<std::uint32_t>(datagram.size()),
                                           datagram[isRtps ? 19 : 0]};
    for (std::size_t at = 20; isRtps && at + 12 <= datagram.size();)
    {
        const std::size_t length = datagram[at + 2] | static_cast<std::size_t>(datagram[at + 3]) << 8;
        likeness.push_back(datagram[at]);
        likeness.push_back(static_cast<std::uint32_t>(datagram[at + 10] << 8 | datagram[at + 11]));
        at += 4 + length;
    }
    if (_kept.size() < MostKept && _alike[likeness]++ < MostAlike)
    {
        _kept.push_back(std::move(datagram));
    }
}

std::vector<sockaddr_in> Sniffer::Destinations() const
{
    std::vector<sockaddr_in> all;
    for (const auto &[where, count] : _destinations)
    {
        sockaddr_in address{};
        address.sin_family = AF_INET;
        address.sin_addr.s_addr = where.first;
        address.sin_port = htons(where.second);
        all.push_back(address);
    }
    return all;
}

Sender::Sender() : _socket(::socket(AF_INET, SOCK_DGRAM, 0))
{
    if (_socket < 0)
    {
        Fail("socket");
    }
    in_addr loopback{htonl(INADDR_LOOPBACK)};
    ::setsockopt(_socket, IPPROTO_IP, IP_MULTICAST_IF, &loopback, sizeof loopback);
}

Sender::~Sender()
{
    ::close(_socket);
}

void Sender::Send(const std::vector<Datagram> &datagrams, const std::vector<sockaddr_in> &destinations)
{
    std::vector<iovec> parts(datagrams.size());
    std::vector<mmsghdr> messages(datagrams.size());
    for (std::size_t i = 0; i < datagrams.size(); ++i)
    {
        parts[i] = {const_cast<std::uint8_t *>(datagrams[i].data()), datagrams[i].size()};
        messages[i].msg_hdr.msg_name = const_cast<sockaddr_in *>(&destinations[i]);
        messages[i].msg_hdr.msg_namelen = sizeof(sockaddr_in);
        messages[i].msg_hdr.msg_iov = &parts[i];
        messages[i].msg_hdr.msg_iovlen = 1;
    }
    for (std::size_t sent = 0; sent < messages.size();)
    {
        const int now =
            ::sendmmsg(_socket, &messages[sent], static_cast<unsigned>(messages.size() - sent), 0);
        if (now < 0 && errno != ECONNREFUSED && errno != EINTR && errno != ENOBUFS)
        {
            Fail("sendmmsg");
        }
        sent += now > 0 ? static_cast<std::size_t>(now) : 0;
    }
}

void Sender::WaitForReaders(const std::vector<sockaddr_in> &destinations, std::size_t bytes)
{
    for (;;)
    {
        std::size_t most = 0;
        ForEachSocket(
            [&](std::uint16_t port, std::uint64_t unread, std::uint64_t /*dropped*/)
            {
                const auto isIt = [&](const sockaddr_in &each) { return ntohs(each.sin_port) == port; };
                if (std::any_of(destinations.begin(), destinations.end(), isIt))
                {
                    most = std::max<std::size_t>(most, unread);
                }
            });
        if (most <= bytes)
        {
            return;
        }
        std::this_thread::yield();
    }
}

std::uint64_t Sender::Dropped()
{
    std::uint64_t all = 0;
    ForEachSocket([&](std::uint16_t /*port*/, std::uint64_t /*unread*/, std::uint64_t dropped)
                  { all += dropped; });
    return all;
}
