#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "backfill/Series.h"

// The bytes in questions and answers. Numbers have seven bits a byte, the least significant first; a set
// eighth bit means that another byte follows. Each time is written as its distance from the one before it.
//
//     stamps: distance, ...                       (the first from the beginning of the range)
//     spans:  incarnation, first, end - first, ...
//     posts:  distance in ns, size, bytes, ...    (the first from the beginning of the range)
namespace Rabit::Backfill::PostsCodec
{

// The incarnations of which a node has posts, and their stamps.
struct Span
{
    std::uint64_t Incarnation = 0;
    Range Stamps;
    bool IsOver = false;  // nothing more will come; known at the origin alone, and not encoded

    bool operator==(const Span &) const = default;
};
inline constexpr std::size_t MostSpans = 1000;

// `stamps` and `posts` rise.
std::vector<std::uint8_t> EncodeStamps(const std::vector<Stamp> &stamps, Stamp first);
std::vector<std::uint8_t> EncodeSpans(const std::vector<Span> &spans);
std::vector<std::uint8_t> EncodePosts(const std::vector<Post> &posts, Stamp first);

// Empty for bytes that are nothing of the kind. The results take no more memory than a small multiple of the
// bytes.
std::optional<std::vector<Stamp>> DecodeStamps(std::span<const std::uint8_t> bytes, Stamp first);
std::optional<std::vector<Span>> DecodeSpans(std::span<const std::uint8_t> bytes);
std::optional<std::vector<Post>> DecodePosts(std::span<const std::uint8_t> bytes, Stamp first);

}  // namespace Rabit::Backfill::PostsCodec
