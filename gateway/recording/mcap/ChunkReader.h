#pragma once

#include "recording/mcap/McapRecords.h"

namespace Rabit::Mcap
{

// Chunks that are larger when decompressed are refused.
inline constexpr std::uint64_t LargestChunk = 256U << 20;

// Takes the records out of a chunk. Returns an empty text, or why it failed; `records` is then of no use.
// `room` is working memory, into which `records` may point.
std::string OpenChunk(const Chunk &chunk, Bytes &room, ByteView &records);

}  // namespace Rabit::Mcap
