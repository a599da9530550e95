#pragma once

#include <rabit/mcap/McapRecords.h>

namespace Rabit::Mcap
{

// Chunks that are larger when decompressed are refused.
inline constexpr std::uint64_t LargestChunk = 256U << 20;

// Takes the records out of a chunk. Returns an empty text, or why it failed; `records` is then of no use.
// `records` points into the chunk or into `room`, which is working memory, and is valid as long as both are
// unchanged. Takes no more memory than LargestChunk. Keeps no state.
std::string OpenChunk(const Chunk &chunk, Bytes &room, ByteView &records);

}  // namespace Rabit::Mcap
