// SHA-256 (FIPS 180-4), for names that are hashes. The generator has no library of cryptography.
#pragma once

#include <string>
#include <string_view>

namespace RabitIdl
{

// The hash in 64 lower-case hexadecimal digits.
std::string Sha256Hex(std::string_view text);

}  // namespace RabitIdl
