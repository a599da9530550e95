#pragma once

#include <rabit/gateway/GatewayConfig.h>

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "gateway.idl.h"

// Announcements, and how large one may be: each node keeps one of every other node, for hours, and anybody
// can send one. Receivers drop announcements beyond these bounds, so no node may be configured to send one.
// The bounds are far above the needs of a fleet.
namespace Rabit::Announcements
{

// Bytes of an announcement as it is on the wire; a larger one is not even decoded.
inline constexpr std::size_t LargestEncoded = 32 * 1024;
// Messages published and queues accepted, together; types of these queues, together.
inline constexpr std::size_t MostOffers = 512;
inline constexpr std::size_t MostTypes = 1024;
// Bytes of the name of a type: with its definition behind it (names/TypeDefinition.h), a queue link takes
// 255. Those of nodes, messages and queues are in names/NamePattern.h.
inline constexpr std::size_t LongestType = 238;

// The announcement of a node with that configuration. Types that this process does not know have the
// definition 0.
Gateway::Announcement Of(const GatewayConfig &config);

// Encodes the announcement for the wire.
std::vector<std::uint8_t> Encode(const Gateway::Announcement &announcement);
// Empty if the bytes are no announcement, or an implausible one.
std::optional<Gateway::Announcement> Decode(std::span<const std::uint8_t> bytes);

// Tells two encoded announcements apart. Beats carry it, so that a node that lacks the present announcement
// notices and requests it.
std::uint32_t DigestOf(std::span<const std::uint8_t> bytes);

// The index of the State of that name among the announced States, which beats use for it; empty: there is
// none.
std::optional<std::size_t> StateIndexOf(const Gateway::Announcement &announcement, std::string_view message);
// Number of States in the announcement.
std::size_t StatesIn(const Gateway::Announcement &announcement);

// Why others would drop the announcement, in words; empty if they would not.
std::string WhyTooLarge(const Gateway::Announcement &announcement);

// True if an announcement from the network is within the bounds and all its names are valid.
bool IsPlausible(const Gateway::Announcement &announcement);

}  // namespace Rabit::Announcements
