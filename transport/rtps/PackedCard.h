// A card is one RTPS message with all discovery data of a participant, as its DDS implementation writes them:
// its own announcement (SPDP) first, then those of its endpoints (SEDP). For the network it is packed with
// zstd (RFC 8878), because announcements repeat names, addresses and QoS: eight endpoints take some 600 bytes
// instead of 3 kB.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "rtps/CardMessage.h"

namespace Rabit::Rtps
{

// A card that unpacks to more bytes is refused, and one that unpacks to more for each packed byte: 300 bytes
// of zstd can stand for 512 kB. Announcements of nodes pack to a fifth; a thousand that differ in their
// numbers alone pack to a fortieth. 512 kB: OwnCard::MostEndpoints with 500 bytes each; those of nodes have
// some 400.
constexpr std::size_t LargestUnpackedCard = 512 * 1024;
constexpr std::size_t LargestDensity = 100;

// Packs a card. Empty if the card is too large, unpacked or packed (LargestCard).
std::vector<std::uint8_t> PackCard(std::span<const std::uint8_t> card);
// Unpacks a card. Accepts any bytes; empty if they are not a packed card.
std::optional<std::vector<std::uint8_t>> UnpackCard(std::span<const std::uint8_t> packed);
CardSummary SummaryOf(std::span<const std::uint8_t> packed);

}  // namespace Rabit::Rtps
