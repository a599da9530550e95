// Checks the framing that DDS Security puts around encrypted and signed submessages, before any signature is
// verified.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

namespace Rabit::Rtps
{

// `from` begins with a submessage of DDS Security. Returns the size of the unit that it begins: a prefix, the
// protected content, and the postfix with the tags; empty if it is unsound. The vendor adds up the lengths in
// there and feeds that many bytes to its cipher, present or not; it checks the signature afterwards.
// `wholeMessage`: the unit follows the RTPS header, where alone a whole message may be protected.
std::optional<std::size_t> ProtectedSize(std::span<std::uint8_t> from, bool wholeMessage);

}  // namespace Rabit::Rtps
