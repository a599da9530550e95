#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

// A number in a small file of its own, as a line of digits.
namespace Rabit::StoredNumber
{

// Returns the number; 0 if there is no file, or no number up to `most` in it. `error` is then one line, with
// `what` as the number's name; empty if there is no file.
std::uint64_t Read(const std::filesystem::path &file, std::uint64_t most, const std::string &what,
                   std::string &error);

// Writes a new file beside the old one, syncs it, and renames it, so that the disk holds one whole file at
// any moment. Makes the directory. Returns the failure in one line, or an empty text.
std::string Write(const std::filesystem::path &file, std::uint64_t number);

}  // namespace Rabit::StoredNumber
