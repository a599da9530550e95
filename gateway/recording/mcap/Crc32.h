#pragma once

#include <cstdint>
#include <span>

namespace Rabit::Mcap
{

// CRC-32 as in zlib and PNG (polynomial 0xEDB88320, reflected). `crc` is the checksum of the bytes before;
// 0 at first.
std::uint32_t Crc32(std::span<const std::uint8_t> bytes, std::uint32_t crc = 0);

}  // namespace Rabit::Mcap
