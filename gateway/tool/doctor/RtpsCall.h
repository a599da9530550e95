// The announcements by which DDS participants find each other (OMG DDSI-RTPS 2.3, 8.5.3 and 9.6), for a
// listener on a network. Of nodes with keys it only sees that there are some.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace Rabit::Tool::Doctor
{

// A participant: the 12 bytes of its GUID prefix.
using ParticipantId = std::array<std::uint8_t, 12>;

// An RTPS datagram from a network, read without trust.
struct HeardCall
{
    ParticipantId Sender{};
    std::string Name{};   // of the participant, if it announces itself here; printable, 64 characters at most
    bool IsNode = false;  // of Rabit
    bool IsRos = false;   // of ROS 2, which names the enclave in the participant's USER_DATA
    bool Announces = false;
    std::uint16_t Port = 0;  // at which it takes announcements for itself alone, over UDP and IPv4; 0: none
};
// Empty if the datagram is not RTPS.
std::optional<HeardCall> HeardIn(std::span<const std::uint8_t> datagram);

// Returns the name of a participant for people. Programs of ROS 2, and those without a name, have their GUID
// prefix in it, so that each is counted: "a program of ROS 2 (0102030405060708090a0b0c)".
std::string LabelOf(const HeardCall &heard);
// The same of a program of ROS 2 by its GUID prefix, as 24 hexadecimal digits, and the names of its nodes,
// which may be missing: "a program of ROS 2 (/talker /listener, 0102030405060708090a0b0c)".
std::string LabelOfRos(const std::string &prefix, const std::vector<std::string> &nodes);

// Returns an announcement of a participant without writers and readers, which makes all others announce
// themselves to it. They forget it after one second.
std::vector<std::uint8_t> MakeCall(const ParticipantId &sender, std::array<std::uint8_t, 4> address,
                                   std::uint16_t port);

// Returns the tag of the sender's session if the datagram looks like one of a node with keys
// (envelope/Outer.h), and is no sealed call. Such a node sends no other datagrams, and each of its sessions
// has a tag of its own.
std::optional<std::uint32_t> SealedTagIn(std::span<const std::uint8_t> datagram);
// Returns a sealed call: each node with keys answers it by introducing itself to all, once
// (Envelope::EpochOfCalls).
std::vector<std::uint8_t> MakeSealedCall();

// Returns the port of a domain's announcements by multicast.
constexpr int CallPort(int domain)
{
    return 7400 + 250 * domain;
}
// Returns the port at which the `index`-th participant of a machine takes announcements for itself alone.
constexpr int AlonePort(int domain, int index)
{
    return CallPort(domain) + 10 + 2 * index;
}
inline constexpr int LastDomain = 232;
inline constexpr const char *CallGroup = "239.255.0.1";

}  // namespace Rabit::Tool::Doctor
