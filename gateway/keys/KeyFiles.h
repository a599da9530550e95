// Files with keys and certificates. All throw KeysError with the file's name and the reason.
#pragma once

#include <string>
#include <string_view>

namespace Rabit::Keys
{

// Of up to 1 MiB.
std::string ReadFile(const std::string &file);
// Refuses a file that others than its owner may read or write.
std::string ReadSecret(const std::string &file);
// Takes the place of a file of that name at once, or not at all. A secret one is readable by its owner alone
// from the moment at which it is there.
void WriteSecret(const std::string &file, std::string_view text);
void WriteFile(const std::string &file, std::string_view text);
// For its owner alone. It must not be there yet, and the one above it must be.
void MakeSecretFolder(const std::string &folder);

}  // namespace Rabit::Keys
