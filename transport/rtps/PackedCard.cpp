#include "rtps/PackedCard.h"

#include <rabit/base/Fnv1a.h>
#include <zstd.h>

#include <algorithm>

namespace Rabit::Rtps
{

std::vector<std::uint8_t> PackCard(std::span<const std::uint8_t> card)
{
    constexpr int level = 12;  // a card of 3 kB takes a fraction of a millisecond, once for each change
    if (card.size() > LargestUnpackedCard)
    {
        return {};
    }
    std::vector<std::uint8_t> packed(ZSTD_compressBound(card.size()));
    const std::size_t size = ZSTD_compress(packed.data(), packed.size(), card.data(), card.size(), level);
    packed.resize(ZSTD_isError(size) || size > LargestCard ? 0 : size);
    return packed;
}

std::optional<std::vector<std::uint8_t>> UnpackCard(std::span<const std::uint8_t> packed)
{
    const auto size = ZSTD_getFrameContentSize(packed.data(), packed.size());
    if (size == ZSTD_CONTENTSIZE_UNKNOWN || size == ZSTD_CONTENTSIZE_ERROR ||
        size > std::min(LargestUnpackedCard, LargestDensity * packed.size()))
    {
        return std::nullopt;
    }
    std::vector<std::uint8_t> card(size);
    const std::size_t got = ZSTD_decompress(card.data(), card.size(), packed.data(), packed.size());
    return got == size ? std::optional(std::move(card)) : std::nullopt;
}

CardSummary SummaryOf(std::span<const std::uint8_t> packed)
{
    return {.Digest = Fnv1a().Add(packed).Sum(), .Size = static_cast<std::uint32_t>(packed.size())};
}

}  // namespace Rabit::Rtps
