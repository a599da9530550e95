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

// True for multicast and broadcast. False for a frame that is too short for a header.
bool IsMulticast(const Frame &frame);
// Returns zeros for a frame that is too short for a header.
MacAddress DestinationOf(const Frame &frame);
// Returns the bytes of the IP packet in the frame, headers included; 0 for ARP and the like.
std::size_t IpBytes(const Frame &frame);

// The kind of a frame, for a diagnosis by eye.
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
