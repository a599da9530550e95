#pragma once

#include <rabit/mcap/McapRecords.h>

#include <cstdint>
#include <memory>

namespace Rabit::Mcap
{

// Compresses with zstd at its quickest ordinary level, and reuses its memory. Not thread-safe.
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

// Decompresses to exactly `size` bytes; false if that is impossible. Takes no more memory than that, and 8
// MiB besides.
bool DecompressZstd(ByteView compressed, std::uint64_t size, Bytes &to);

}  // namespace Rabit::Mcap
