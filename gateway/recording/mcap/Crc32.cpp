#include "recording/mcap/Crc32.h"

#include <zlib.h>

namespace Rabit::Mcap
{

std::uint32_t Crc32(std::span<const std::uint8_t> bytes, std::uint32_t crc)
{
    // zlib returns the first checksum for a null pointer, whatever came before.
    return bytes.empty() ? crc : static_cast<std::uint32_t>(crc32_z(crc, bytes.data(), bytes.size()));
}

}  // namespace Rabit::Mcap
