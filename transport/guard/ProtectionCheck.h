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

// The sender that the tags around protected content have to prove. All members of a fleet hold the key of the
// tag that is common to all receivers; a receiver's own tag is made with a key that it and the sender alone
// hold. A vendor takes a list without tags, and a tag under the key 0, for no origin authentication.
enum class Proof
{
    OfMember,  // any one that holds the common key
    // A whole message has a receiver's own tag. A unit outside of a message has the key 0, which two
    // participants alone hold: with it they exchange the other keys.
    OfSender
};

// `from` begins with a submessage of DDS Security. Returns the size of the unit that it begins: a prefix, the
// protected content, and the postfix with the tags; empty if it is unsound. The vendor adds up the lengths in
// there and feeds that many bytes to its cipher, present or not; it checks the signature afterwards.
// `wholeMessage`: the unit follows the RTPS header, where alone a whole message may be protected. The key of
// a whole message tells only which participant made it, so `mayContain` decides about each submessage in it
// that has no prefix and postfix of its own: a plain one, or the body that is the encrypted message.
std::optional<std::size_t> ProtectedSize(std::span<std::uint8_t> from, bool wholeMessage, Proof proof,
                                         const std::function<bool(const Submessage &)> &mayContain);

}  // namespace Rabit::Rtps
