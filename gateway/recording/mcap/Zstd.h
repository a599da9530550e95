#pragma once

#include <cstdint>
#include <memory>

#include "recording/mcap/McapRecords.h"

namespace Rabit::Mcap
{

// Compresses with zstd at its quickest ordinary level, again and again with the same memory. Not thread-safe.
class ZstdCompressor
{
public:
    ZstdCompressor();
    ~ZstdCompressor();
    // Puts the compressed bytes in place of what `to` holds. False if they would not be fewer.
    bool Compress(ByteView bytes, Bytes &to);

private:
    struct Context;
    std::unique_ptr<Context> _context;
};

// Exactly `size` bytes come of it, or it is refused. Takes no more memory than that, and 8 MiB besides.
bool DecompressZstd(ByteView compressed, std::uint64_t size, Bytes &to);

}  // namespace Rabit::Mcap
