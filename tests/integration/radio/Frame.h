#pragma once

#include <array>
#include <compare>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

namespace Rabit::Radio
{

using MacAddress = std::array<std::uint8_t, 6>;

// An Ethernet frame from its destination on, without checksum.
using Frame = std::vector<std::uint8_t>;
using FramePointer = std::shared_ptr<const Frame>;

constexpr std::size_t EthernetHeader = 14;

// Broadcast too. False of a frame that is too short for a header.
bool IsMulticast(const Frame &frame);
// Zeros of a frame that is too short for a header.
MacAddress DestinationOf(const Frame &frame);
// What of it is IP, headers included; 0 of ARP and the like.
std::size_t IpBytes(const Frame &frame);

// What a frame is, for a diagnosis by eye.
struct Kind
{
    bool Multicast = false;
    std::uint16_t EtherType = 0;
    std::uint8_t Protocol = 0;  // of IPv4; 0 otherwise
    bool Fragment = false;      // not the first one of its datagram, so without a port
    std::uint16_t Port = 0;     // destination; of UDP and TCP

    auto operator<=>(const Kind &) const = default;
};

Kind KindOf(const Frame &frame);
// For instance "multicast udp 7400", "unicast arp", "unicast udp fragment".
std::string NameOf(const Kind &kind);

}  // namespace Rabit::Radio
