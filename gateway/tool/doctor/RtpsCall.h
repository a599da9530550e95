// What DDS participants say to find each other (OMG DDSI-RTPS 2.3, 8.5.3 and 9.6), for who listens to a
// network.
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

// A participant, in its first 12 bytes.
using ParticipantId = std::array<std::uint8_t, 12>;

// A datagram from a network; nothing of it is trusted.
struct HeardCall
{
    ParticipantId Sender{};
    std::string Name{};   // of the participant, if it announces itself here; printable, 64 characters at most
    bool IsNode = false;  // of Rabit
    bool HasKeys = false;  // it says that it takes part in DDS Security
    bool Announces = false;
};
// Nothing if it is not of RTPS.
std::optional<HeardCall> HeardIn(std::span<const std::uint8_t> datagram);

// An announcement by which a participant that is none asks all others for theirs: it has no writers and no
// readers, and is forgotten after a second.
std::vector<std::uint8_t> MakeCall(const ParticipantId &sender, std::array<std::uint8_t, 4> address,
                                   std::uint16_t port);

// The port of a domain's announcements by multicast.
constexpr int CallPort(int domain)
{
    return 7400 + 250 * domain;
}
inline constexpr int LastDomain = 232;
inline constexpr const char *CallGroup = "239.255.0.1";

}  // namespace Rabit::Tool::Doctor
