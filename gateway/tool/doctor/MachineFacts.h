#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace Rabit::Tool::Doctor
{

struct Interface
{
    std::string Name;
    int Index = 0;
    std::vector<std::string> Addresses;  // IPv4
    bool IsUp = false;                   // and has a carrier
    bool HasMulticast = false;
    bool IsLoopback = false;
    unsigned Mtu = 0;
};

// Counters of UDP over IPv4, since the machine started.
struct UdpCounters
{
    std::uint64_t NoRoom = 0;   // datagrams dropped because a receive buffer was full
    std::uint64_t NotSent = 0;  // likewise of send buffers
};

// Facts that this machine reports of itself.
struct MachineFacts
{
    std::vector<Interface> Interfaces;
    std::optional<std::uint64_t> LargestReceiveBuffer;  // net.core.rmem_max
    UdpCounters Udp;
    std::map<int, std::uint64_t> DropsOfPorts;  // datagrams dropped of UDP sockets that are open now
};

// Reads them from the machine.
MachineFacts LookAtMachine();

// Parse /proc/net/snmp and /proc/net/udp; missing numbers are 0 or left out.
UdpCounters UdpCountersIn(const std::string &snmp);
std::map<int, std::uint64_t> DropsIn(const std::string &udp);

}  // namespace Rabit::Tool::Doctor
