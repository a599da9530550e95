// Puts announcements together that came in fragments.
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <span>
#include <vector>

#include "guard/DeliveryCheck.h"
#include "guard/RtpsMessage.h"

namespace Rabit::Rtps
{

// An announcement is checked whole before the vendor sees it, so its fragments are put together here: one
// with many partitions is larger than a datagram. Bounded: the announcements begun last, of up to 60 kB. Not
// thread-safe.
class DiscoveryFragments
{
public:
    // Takes fragments of a sample of the sender in an RTPS header. Once they are all there, returns a message
    // with this header and the whole sample, to that destination; empty until then.
    std::vector<std::uint8_t> Add(std::span<const std::uint8_t> header, const Delivery &delivery,
                                  const GuidPrefix &destination);

private:
    struct Sample
    {
        GuidPrefix Sender{};
        EntityId Writer = 0;
        std::int64_t Sequence = 0;
        std::uint16_t FragmentSize = 0;
        std::vector<std::uint8_t> Bytes;
        std::vector<bool> Missing;
    };

    Sample *Find(const GuidPrefix &sender, const Delivery &delivery);

    std::deque<Sample> _samples;
};

}  // namespace Rabit::Rtps
