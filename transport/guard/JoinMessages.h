// One RTPS message out of several.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace Rabit::Rtps
{

// Puts sound messages, and behind them the one with which the buffer begins, which may be empty, into one
// message in the buffer: for a vendor that takes one datagram at a time, where RtpsGuard hands on several.
// Each says what it said alone: who sends it, and to whom. What of them would not fit is left out, from the
// last on, as if it had been lost on its way. Returns the length of the whole.
std::size_t JoinMessages(const std::vector<std::vector<std::uint8_t>> &first, std::span<std::uint8_t> buffer,
                         std::size_t last);

}  // namespace Rabit::Rtps
