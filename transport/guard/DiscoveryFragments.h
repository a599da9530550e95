// Assembles announcements that arrive in fragments.
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <map>
#include <span>
#include <vector>

#include "guard/DeliveryCheck.h"
#include "guard/RtpsMessage.h"

namespace Rabit::Rtps
{

// An announcement is checked whole before the vendor sees it, so its fragments are assembled here: one with
// many partitions is larger than a datagram. Bounded: keeps the announcements begun last, each up to 60 kB,
// and of each what has come. Not thread-safe.
class DiscoveryFragments
{
public:
    // Takes fragments of a sample of the sender named in an RTPS header. Once the sample is complete, returns
    // a message with this header and the whole sample, addressed to `destination`; empty until then.
    std::vector<std::uint8_t> Add(std::span<const std::uint8_t> header, const Delivery &delivery,
                                  const GuidPrefix &destination);

private:
    struct Sample
    {
        GuidPrefix Sender{};
        EntityId Writer = 0;
        std::int64_t Sequence = 0;
        std::uint16_t FragmentSize = 0;
        std::uint32_t SampleSize = 0;
        std::map<std::uint32_t, std::vector<std::uint8_t>> Parts;  // as they came, by their first fragment
        std::size_t Bytes = 0;                                     // of the parts
    };

    Sample *Find(const GuidPrefix &sender, const Delivery &delivery);
    static bool IsWhole(const Sample &sample);
    void Forget(const Sample &sample);

    std::deque<Sample> _samples;
};

}  // namespace Rabit::Rtps
