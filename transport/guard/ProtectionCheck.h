// What DDS Security puts around encrypted and signed submessages, before anybody has looked at a signature.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

namespace Rabit::Rtps
{

// `from` begins with one of its submessages. How much of it belongs together: a prefix, what it protects, and
// the tag that follows; nothing if that is unsound. The vendor adds up the lengths that it finds there and
// feeds so many bytes to its cipher, whether they are there or not; the signature is looked at afterwards.
// `wholeMessage`: whether it follows the header, where alone a whole message may be protected.
std::optional<std::size_t> ProtectedSize(std::span<std::uint8_t> from, bool wholeMessage);

}  // namespace Rabit::Rtps
