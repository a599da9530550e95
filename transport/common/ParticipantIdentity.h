// The data by which a Rabit node identifies itself in DDS discovery, the same for all DDS backends.
//
// The participant's name is the node's name. The participant's USER_DATA (OMG DDS specification, 2.2.3.1) is
// ASCII: `rabit=1;incarnation=<decimal>;`, followed by `card=2;` if the node exchanges cards
// (rtps/Meeting.h). A participant without that USER_DATA is a plain DDS program.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>

namespace Rabit
{

// The USER_DATA of each writer and reader of a node. ROS 2 warns of each endpoint that has none, since it
// looks for the hash of the type there (REP-2011). It accepts any list of `key=value;`. Without a hash it is
// EndpointUserData.
inline constexpr std::string_view EndpointUserData = "rabit=1;";
std::string MakeEndpointUserData(std::string_view typeHash);

struct ParticipantIdentity
{
    std::string Node;
    std::uint64_t Incarnation = 0;
};

std::string MakeUserData(std::uint64_t incarnation, bool hasCard = false);

// The incarnation in a participant's USER_DATA; none if it is not a Rabit node's. Accepts any bytes.
std::optional<std::uint64_t> ParseUserData(std::span<const std::uint8_t> userData);

// True if the USER_DATA is that of a node that exchanges cards. Accepts any bytes.
bool HasCard(std::span<const std::uint8_t> userData);

}  // namespace Rabit
