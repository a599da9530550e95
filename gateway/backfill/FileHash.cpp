#include "backfill/FileHash.h"

#include <openssl/evp.h>

#include <sys/types.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <memory>

namespace Rabit::Backfill
{

std::optional<std::vector<std::uint8_t>> HashOf(int file, std::uint64_t size)
{
    const std::unique_ptr<EVP_MD_CTX, void (*)(EVP_MD_CTX *)> context(EVP_MD_CTX_new(), EVP_MD_CTX_free);
    if (!context || EVP_DigestInit_ex(context.get(), EVP_sha256(), nullptr) != 1)
    {
        return std::nullopt;
    }
    std::vector<std::uint8_t> room(1U << 20);
    for (std::uint64_t offset = 0; offset < size;)
    {
        const std::size_t most =
            static_cast<std::size_t>(std::min<std::uint64_t>(room.size(), size - offset));
        const ssize_t read = ::pread(file, room.data(), most, static_cast<off_t>(offset));
        if (read < 0 && errno == EINTR)
        {
            continue;
        }
        if (read <= 0 || EVP_DigestUpdate(context.get(), room.data(), static_cast<std::size_t>(read)) != 1)
        {
            return std::nullopt;
        }
        offset += static_cast<std::uint64_t>(read);
    }
    std::vector<std::uint8_t> hash(EVP_MAX_MD_SIZE);
    unsigned length = 0;
    if (EVP_DigestFinal_ex(context.get(), hash.data(), &length) != 1)
    {
        return std::nullopt;
    }
    hash.resize(length);
    return hash;
}

}  // namespace Rabit::Backfill
