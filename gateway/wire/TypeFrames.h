#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

// Parts of the IDL texts of types, sent to the nodes that request them: frames of the topic rabit/Link whose
// first byte is no version of the links.
namespace Rabit::TypeFrames
{

inline constexpr std::uint8_t FirstByte = 'T';

// Largest text in bytes; a larger one is neither sent nor accepted.
inline constexpr std::size_t LargestText = 128 * 1024;

struct Part
{
    std::uint64_t Definition = 0;         // hash of the type, as in announcements
    std::uint32_t First = 0;              // of the text's bytes, counted from 0
    std::uint32_t Of = 0;                 // bytes of the whole
    std::span<const std::uint8_t> Bytes;  // at least one
};

// Bytes of a frame beside the text.
inline constexpr std::size_t HeaderSize = 20;

std::vector<std::uint8_t> Encode(const Part &part);
// The bytes are views into the frame. Empty if it is no such frame, or an impossible one.
std::optional<Part> Decode(std::span<const std::uint8_t> frame);

}  // namespace Rabit::TypeFrames
