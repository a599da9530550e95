// Files with keys and certificates. All functions throw KeysError with the file's name and the reason.
#pragma once

#include <string>
#include <string_view>

#include "keys/Secret.h"

namespace Rabit::Keys
{

// Reads a file of up to 1 MiB.
std::string ReadFile(const std::string &file);
// Like ReadFile, but refuses a file that others than its owner may read or write.
std::string ReadSecret(const std::string &file);
// Returns the first line of a file, or of a pipe such as /dev/fd/3, of up to 1023 bytes. Refuses an empty
// line, and a file that others than its owner may read or write.
Secret ReadPassphrase(const std::string &file);
// Replace a file of that name as a whole, or not at all. The file of WriteSecret is never readable by anyone
// but its owner.
void WriteSecret(const std::string &file, std::string_view text);
void WriteFile(const std::string &file, std::string_view text);
// Like WriteSecret, but returns false and changes nothing if a file of that name exists.
bool WriteNewSecret(const std::string &file, std::string_view text);
// Makes a folder for its owner alone. It must not exist yet, and its parent must exist.
void MakeSecretFolder(const std::string &folder);

}  // namespace Rabit::Keys
