// Joins several RTPS messages into one.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace Rabit::Rtps
{

// Joins the messages `first` and, behind them, the message of `last` bytes at the start of the buffer, which
// may be empty. The result is in the buffer. For a vendor that takes one datagram at a time, where RtpsGuard
// delivers several. Each part keeps its sender and its destination. A message that does not fit is left out,
// as if the network had lost it. All messages must be sound. Returns the length of the result.
std::size_t JoinMessages(const std::vector<std::vector<std::uint8_t>> &first, std::span<std::uint8_t> buffer,
                         std::size_t last);

}  // namespace Rabit::Rtps
