#pragma once

#include <cstdint>
#include <optional>
#include <vector>

namespace Rabit::Backfill
{

// Returns the SHA-256 of the first `size` bytes of an open file; empty if they cannot be read.
std::optional<std::vector<std::uint8_t>> HashOf(int file, std::uint64_t size);

}  // namespace Rabit::Backfill
