#pragma once

#include "recording/mcap/McapRecords.h"

namespace Rabit::Mcap
{

// What is larger when it is decompressed is refused.
inline constexpr std::uint64_t LargestChunk = 256U << 20;

// Takes the records out of a chunk. Returns an empty text, or why it cannot be done; `records` then holds
// nothing of use. `room` is memory to be used, and may be what `records` points into.
std::string OpenChunk(const Chunk &chunk, Bytes &room, ByteView &records);

}  // namespace Rabit::Mcap
