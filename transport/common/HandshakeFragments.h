#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace Rabit
{

// Cuts a handshake's message into datagrams with one fragment each, of at most `largest` bytes with a
// KeyExchangeStamp. The guard assembles them. Fast DDS sends such a message in one datagram of 4 kB and more,
// which IP fragments: if one of these is lost, all are. A receiver keeps fragments of RTPS, and needs only
// the lost ones again. Returns an empty vector if the datagram is small enough, or something else.
std::vector<std::vector<std::uint8_t>> CutHandshake(std::span<const std::uint8_t> datagram,
                                                    std::size_t largest);

}  // namespace Rabit
