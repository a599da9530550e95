// What participants show each other before they are authenticated (OMG DDS Security 1.1, 7.2 and 7.4.3).
#pragma once

#include <cstdint>
#include <span>

#include "guard/RtpsReader.h"

namespace Rabit::Rtps
{

// The vendor makes room for as many things, and as many bytes, as it is told that there are, and does so
// before it looks for them: a few bytes of a stranger took gigabytes, or ended the process.

// A token, or data holder: a name, properties, and properties of bytes. Reads it.
bool IsToken(RtpsReader &from);
// The payload of a message of a handshake, or of what else participants say to each other so.
bool IsGenericMessage(std::span<const std::uint8_t> payload);

}  // namespace Rabit::Rtps
