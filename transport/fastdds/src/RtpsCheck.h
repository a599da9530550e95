// Whether a datagram is well-formed enough to be given to the vendor's parser.
//
// Debian builds the vendor's library with its assertions on, so a datagram that breaks one ends the process.
#pragma once

#include <cstdint>
#include <span>

namespace Rabit::FastDds
{

// Checks the structure of OMG DDSI-RTPS 2.3, 8.3 and 9.4: the header, the chain of submessages, and in those
// that carry samples or manage their delivery all lengths, counts, and sequence numbers. Submessages of other
// kinds (those of DDS Security, of vendors) are passed over. Reads nothing outside of the span.
bool IsSoundRtps(std::span<const std::uint8_t> datagram);

}  // namespace Rabit::FastDds
