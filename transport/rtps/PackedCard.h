// A card is one RTPS message: all that a participant has to say in discovery, its own announcement (SPDP)
// first, then the announcements of its endpoints (SEDP), as its DDS implementation writes them. On the air it
// is packed with zstd (RFC 8878), because these announcements repeat names, addresses and QoS: eight
// endpoints take some 600 bytes of 3 kB.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "rtps/CardMessage.h"

namespace Rabit::Rtps
{

// A card that unpacks to more bytes is refused.
constexpr std::size_t LargestUnpackedCard = 256 * 1024;

// Empty if the card is too large.
std::vector<std::uint8_t> PackCard(std::span<const std::uint8_t> card);
// Nothing if the bytes, which may be any, are not a packed card.
std::optional<std::vector<std::uint8_t>> UnpackCard(std::span<const std::uint8_t> packed);
CardSummary SummaryOf(std::span<const std::uint8_t> packed);

}  // namespace Rabit::Rtps
