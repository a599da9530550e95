#include "recording/mcap/Zstd.h"

#include <zstd.h>

#include <new>

namespace Rabit::Mcap
{
namespace
{

constexpr int Level = 1;

}  // namespace

struct ZstdCompressor::Context
{
    ZSTD_CCtx *const Zstd = ZSTD_createCCtx();
    ~Context() { ZSTD_freeCCtx(Zstd); }
};

ZstdCompressor::ZstdCompressor() : _context(std::make_unique<Context>())
{
    if (_context->Zstd == nullptr)
    {
        throw std::bad_alloc();
    }
}

ZstdCompressor::~ZstdCompressor() = default;

bool ZstdCompressor::Compress(ByteView bytes, Bytes &to)
{
    to.resize(bytes.size());
    const std::size_t size =
        ZSTD_compressCCtx(_context->Zstd, to.data(), to.size(), bytes.data(), bytes.size(), Level);
    if (ZSTD_isError(size) != 0 || size >= bytes.size())
    {
        return false;
    }
    to.resize(size);
    return true;
}

bool DecompressZstd(ByteView compressed, std::uint64_t size, Bytes &to)
{
    to.resize(static_cast<std::size_t>(size));
    return ZSTD_decompress(to.data(), to.size(), compressed.data(), compressed.size()) == size;
}

}  // namespace Rabit::Mcap
