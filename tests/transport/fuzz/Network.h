// The loopback of a network namespace, seen from outside the nodes that talk on it.
#pragma once

#include <netinet/in.h>

#include <cstddef>
#include <cstdint>
#include <map>
#include <span>
#include <vector>

#include "Mutator.h"

// Reads every UDP datagram on loopback. Throws std::system_error if the process may not do so.
class Sniffer
{
public:
    Sniffer();
    ~Sniffer();
    Sniffer(const Sniffer &) = delete;
    Sniffer &operator=(const Sniffer &) = delete;

    // Reads the datagrams that came; waits at most this long for the first. Keeps RTPS and sealed datagrams
    // alone, and only a few with the same submessages and size.
    void Read(int milliseconds);

    const std::vector<Datagram> &Kept() const { return _kept; }
    // Returns the addresses and ports that these were sent to.
    std::vector<sockaddr_in> Destinations() const;

private:
    void Keep(std::span<const std::uint8_t> packet);

    int _socket = -1;
    std::vector<Datagram> _kept;
    std::map<std::vector<std::uint32_t>, int> _alike;
    std::map<std::pair<std::uint32_t, std::uint16_t>, std::uint64_t> _destinations;
};

// Sends datagrams in bursts, as fast as the receivers read them.
class Sender
{
public:
    Sender();
    ~Sender();
    Sender(const Sender &) = delete;
    Sender &operator=(const Sender &) = delete;

    void Send(const std::vector<Datagram> &datagrams, const std::vector<sockaddr_in> &destinations);
    // Waits until no socket of these ports has more than this many bytes unread. Others may never be read.
    static void WaitForReaders(const std::vector<sockaddr_in> &destinations, std::size_t bytes);
    // Returns the number of datagrams that sockets of this namespace have lost because they were full.
    static std::uint64_t Dropped();

private:
    int _socket = -1;
};
