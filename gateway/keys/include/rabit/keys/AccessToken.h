// The token that gives access to a server of this program: the ground station's page, and the viewers of
// `rabit foxglove`.
#pragma once

#include <cstddef>
#include <string>

namespace Rabit::Keys
{

// A shorter token could be guessed.
inline constexpr std::size_t ShortestToken = 22;
inline constexpr std::size_t LongestToken = 128;

// Returns a new token: 128 random bits as 32 hexadecimal digits. Throws KeysError if the system has no random
// numbers. Any thread may call it.
std::string MakeAccessToken();

// Returns the token in a file. A missing file is made, readable by its owner alone, so that the next start
// has the same token; without `mayWrite` the token is made in memory only. Throws KeysError if the file has
// no token, or is readable by others than its owner, or cannot be read or made.
std::string AccessTokenIn(const std::string &file, bool mayWrite = true);

}  // namespace Rabit::Keys
