// A datagram of the vendor's without the parts that its receivers do not need.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace Rabit::FastDds
{

// Begins without the vendor's statistics, which are at the end. The bytes are those of the vendor until a
// part in front of the end is left out, then a copy. Not thread-safe: GuardedUdp uses it on the thread that
// sends.
class ShortenedDatagram
{
public:
    // Borrows both. `copy`: memory for the copy, used from the first LeaveOut on.
    ShortenedDatagram(std::span<const std::uint8_t> whole, std::vector<std::uint8_t> &copy);

    // The bytes that are left.
    std::span<const std::uint8_t> Bytes() const { return _bytes; }

    // Leaves out what WriteWithoutProperties does. The datagram must be an announcement of a participant.
    void LeaveOutProperties();
    // Leaves out INFO_DST, if the datagram is not too large for a copy. The datagram must consist of samples
    // for one participant, and no other part may have been left out.
    void LeaveOutDestination();
    // Puts the vendor's statistics back if what is left ends like statistics: the socket would write its
    // statistics into this end. Call it last.
    void PutBackStatistics();

private:
    const std::span<const std::uint8_t> _whole;
    std::span<const std::uint8_t> _bytes;
    const std::span<const std::uint8_t> _statistics;  // empty: the vendor added none
    std::vector<std::uint8_t> &_copy;
};

}  // namespace Rabit::FastDds
