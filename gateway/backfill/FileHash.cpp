#include "backfill/FileHash.h"

#include <openssl/evp.h>

#include <sys/types.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>

namespace Rabit::Backfill
{

void FileHash::Free::operator()(EVP_MD_CTX *context) const
{
    EVP_MD_CTX_free(context);
}

FileHash::FileHash(std::uint64_t size) : _size(size), _context(EVP_MD_CTX_new())
{
    if (_context && EVP_DigestInit_ex(_context.get(), EVP_sha256(), nullptr) != 1)
    {
        _context.reset();
    }
}

bool FileHash::Advance(int file, std::uint64_t most)
{
    const std::uint64_t end = _offset + std::min(most, _size - _offset);
    std::vector<std::uint8_t> room(
        static_cast<std::size_t>(std::min<std::uint64_t>(end - _offset, 1U << 20)));
    while (_context && _offset < end)
    {
        const auto wanted = static_cast<std::size_t>(std::min<std::uint64_t>(room.size(), end - _offset));
        const ssize_t read = ::pread(file, room.data(), wanted, static_cast<off_t>(_offset));
        if (read < 0 && errno == EINTR)
        {
            continue;
        }
        if (read <= 0 || EVP_DigestUpdate(_context.get(), room.data(), static_cast<std::size_t>(read)) != 1)
        {
            _context.reset();
            break;
        }
        _offset += static_cast<std::uint64_t>(read);
    }
    return _context != nullptr;
}

std::vector<std::uint8_t> FileHash::Take()
{
    std::vector<std::uint8_t> hash(EVP_MAX_MD_SIZE);
    unsigned length = 0;
    if (!IsDone() || !_context || EVP_DigestFinal_ex(_context.get(), hash.data(), &length) != 1)
    {
        length = 0;
    }
    hash.resize(length);
    return hash;
}

std::optional<std::vector<std::uint8_t>> HashOf(int file, std::uint64_t size)
{
    FileHash hash(size);
    std::vector<std::uint8_t> bytes = hash.Advance(file, size) ? hash.Take() : std::vector<std::uint8_t>();
    return bytes.empty() ? std::nullopt : std::optional(std::move(bytes));
}

}  // namespace Rabit::Backfill
