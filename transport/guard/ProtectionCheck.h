// Checks the framing that DDS Security puts around encrypted and signed submessages, before any signature is
// verified.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>

#include "guard/RtpsMessage.h"

namespace Rabit::Rtps
{

// `from` begins with a submessage of DDS Security. Returns the size of the unit that it begins: a prefix, the
// protected content, and the postfix with the tags; empty if it is unsound. The vendor adds up the lengths in
// there and feeds that many bytes to its cipher, present or not; it checks the signature afterwards.
// `wholeMessage`: the unit follows the RTPS header, where alone a whole message may be protected. The key of
// a whole message tells only which participant made it, so `mayContain` decides about each submessage in it
// that has no prefix and postfix of its own: a plain one, or the body that is the encrypted message.
std::optional<std::size_t> ProtectedSize(std::span<std::uint8_t> from, bool wholeMessage,
                                         const std::function<bool(const Submessage &)> &mayContain);

}  // namespace Rabit::Rtps
