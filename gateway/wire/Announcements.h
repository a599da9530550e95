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
// can send one. What exceeds these bounds is dropped by whoever hears it, so no node may be configured to
// send it. They are far above what a fleet uses.
namespace Rabit::Announcements
{

// Bytes of an announcement as it is on the wire; a larger one is not even decoded.
inline constexpr std::size_t LargestEncoded = 32 * 1024;
// Messages published and queues accepted, together; types of these queues, together.
inline constexpr std::size_t MostOffers = 512;
inline constexpr std::size_t MostTypes = 1024;
// Bytes of the name of a type. Those of nodes, messages and queues are in names/NamePattern.h.
inline constexpr std::size_t LongestType = 255;

// What a node with that configuration says of itself. Types that this process does not know have the
// definition 0.
Gateway::Announcement Of(const GatewayConfig &config);

// As it is on the wire.
std::vector<std::uint8_t> Encode(const Gateway::Announcement &announcement);
// Empty if the bytes are no announcement, or one that is not plausible.
std::optional<Gateway::Announcement> Decode(std::span<const std::uint8_t> bytes);

// Tells two encoded announcements apart. Beats carry it, so that whoever lacks the present one notices, and
// asks for it.
std::uint32_t DigestOf(std::span<const std::uint8_t> bytes);

// The place of a State of that name among the States announced, by which beats tell of it; empty: there is
// none.
std::optional<std::size_t> StateIndexOf(const Gateway::Announcement &announcement, std::string_view message);
// How many there are.
std::size_t StatesIn(const Gateway::Announcement &announcement);

// Why others would not take the announcement, in words; empty if they would.
std::string WhyTooLarge(const Gateway::Announcement &announcement);

// Whether what came from the network is within the bounds and each name in it can be one.
bool IsPlausible(const Gateway::Announcement &announcement);

}  // namespace Rabit::Announcements
