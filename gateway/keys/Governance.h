#pragma once

#include <string>

namespace Rabit::Keys
{

// The protection of a fleet. Nodes of different levels do not hear each other.
enum class Level
{
    Sign,    // anybody can read the data, nobody can forge it
    Encrypt  // nor can outsiders read it
};

// `sign`, `encrypt`.
const char *NameOf(Level level);

// The largest domain for DDS Security in Cyclone DDS.
inline constexpr int LargestDomain = 230;

// Returns the text of a governance document, to be signed. Nobody joins without a certificate and
// permissions. Every message is signed as a whole, its times included. Discovery of endpoints and samples are
// protected once more, with keys that only permitted readers get. Frames of the queue links also bear a
// signature for each reader: nodes that share a key to read a link cannot use it to command in another's
// name.
std::string GovernanceText(Level level);

}  // namespace Rabit::Keys
