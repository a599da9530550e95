// Checks tokens and handshake messages, which precede authentication (OMG DDS Security 1.1, 7.2 and 7.4.3).
#pragma once

#include <cstdint>
#include <span>
#include <string_view>

#include "common/RtpsReader.h"

namespace Rabit::Rtps
{

// The vendor allocates for as many elements and bytes as a message declares, before it looks for them. A few
// bytes of an unauthenticated peer took gigabytes, or ended the process.

// Reads a token, or data holder: a name, properties, and binary properties. Returns false if it is unsound.
bool IsToken(RtpsReader &from);
// True if the payload is a sound message of a handshake, or another generic message between participants.
bool IsGenericMessage(std::span<const std::uint8_t> payload);
// The value of the first binary property of that name in a sound generic message; empty if there is none.
std::span<const std::uint8_t> BinaryPropertyOf(std::span<const std::uint8_t> payload, std::string_view name);

}  // namespace Rabit::Rtps
