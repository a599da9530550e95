#pragma once

#include <array>
#include <compare>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace Rabit
{

// A part of a datagram of our own in which discovery says which endpoints we have, or had (news), or which of
// that somebody has or lacks (heartbeats and acknowledgements). If one is lost, the protocol says it again.
struct DiscoveryPart
{
    using Prefix = std::array<std::uint8_t, 12>;
    using Entity = std::array<std::uint8_t, 4>;

    // What a later one of the same subject says takes the place of what an earlier one said.
    struct Subject
    {
        Prefix To{};  // a participant; zero: all who hear it
        std::uint8_t Kind = 0;
        Entity Reader{};
        Entity Writer{};
        std::array<std::uint8_t, 8> Sequence{};  // of news
        auto operator<=>(const Subject &) const = default;
    };

    Subject About;
    bool IsNews = false;
    // Equal where the same is said again: of heartbeats and acknowledgements the count may differ.
    std::uint64_t Content = 0;
    std::vector<std::uint8_t> Bytes;  // whole submessages, of a size that others can follow
};

// Nothing unless the datagram consists of such parts alone. It comes from a vendor's writers and is trusted
// to be sound.
std::optional<std::vector<DiscoveryPart>> ReadDiscoveryParts(std::span<const std::uint8_t> datagram);

// News that were for one reader, for all.
DiscoveryPart ForAll(DiscoveryPart news);

}  // namespace Rabit
