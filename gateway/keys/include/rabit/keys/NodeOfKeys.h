#pragma once

#include <string>

namespace Rabit::Keys
{

// Returns the name of the node that a folder of keys is for, as its certificate has it. The folder is checked
// as far as this host can: the authority signed its files, they belong together, and only the owner can read
// the keys. Throws KeysError, with a line for people, if the keys cannot be used. Any thread may call it.
std::string NodeOfKeys(const std::string &folder);

}  // namespace Rabit::Keys
