#pragma once

#include <cstddef>
#include <string>

namespace Rabit::Keys
{

// The folder of the authority, beside those of the nodes.
inline constexpr const char *AuthorityFolder = "authority";

inline constexpr std::size_t LongestNodeName = 64;

// Names of nodes are names of folders, too. True for 1 to 64 letters, digits, `_`, `.` and `-`, and
// no dot in front: that would be a hidden folder.
bool IsFolderName(const std::string &name);
// Throws KeysError if the name cannot be that of a node with keys.
void CheckNodeName(const std::string &node);

}  // namespace Rabit::Keys
