#pragma once

#include <openssl/types.h>

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

namespace Rabit::Backfill
{

// The SHA-256 of the first bytes of an open file, in pieces.
class FileHash
{
public:
    // Of the first `size` bytes.
    explicit FileHash(std::uint64_t size);

    // Reads up to `most` bytes more. Returns false if they cannot be read: then there is no hash.
    bool Advance(int file, std::uint64_t most);
    // Bytes read so far.
    std::uint64_t Offset() const { return _offset; }
    bool IsDone() const { return _offset == _size; }
    // The hash; empty if it is not done.
    std::vector<std::uint8_t> Take();

private:
    struct Free
    {
        void operator()(EVP_MD_CTX *context) const;
    };

    std::uint64_t _size;
    std::uint64_t _offset = 0;
    std::unique_ptr<EVP_MD_CTX, Free> _context;
};

// Returns the hash of the first `size` bytes of an open file; empty if they cannot be read.
std::optional<std::vector<std::uint8_t>> HashOf(int file, std::uint64_t size);

}  // namespace Rabit::Backfill
