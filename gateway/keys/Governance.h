#pragma once

#include <string>

namespace Rabit::Keys
{

// How a fleet is protected; all of it alike, or they do not hear each other.
enum class Level
{
    Sign,    // what is said can be read by everybody, and forged by nobody
    Encrypt  // nor can it be read
};

// `sign`, `encrypt`.
const char *NameOf(Level level);

// DDS Security in Cyclone DDS knows the domains up to this one.
inline constexpr int LargestDomain = 230;

// The text of a document, to be signed. Nobody joins without a certificate and permissions. Every message is
// signed as a whole, its times too; what is said of endpoints and what samples say is protected once more
// with keys that only those get who may read it. The frames of the queue links besides bear a signature for
// each reader: those who share a key to read cannot use it to command in another's name.
std::string GovernanceText(Level level);

}  // namespace Rabit::Keys
