// Into how many fragments the samples that we sent were cut.
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <map>
#include <span>
#include <utility>

#include "guard/RtpsMessage.h"

namespace Rabit::Rtps
{

// A peer that asks for a fragment beyond the last one would have the vendor read past the end of the sample.
// Bounded: the samples that were begun last are known. Not thread-safe.
class SentFragments
{
public:
    // Takes note of the fragments in a datagram of our own.
    void Sent(std::span<const std::uint8_t> datagram);
    // Whether a sample has been sent that has a fragment of this number, and all before it.
    bool Has(EntityId writer, std::int64_t sequence, std::uint32_t fragment) const;

    std::size_t Size() const { return _fragments.size(); }

private:
    using Sample = std::pair<EntityId, std::int64_t>;

    std::map<Sample, std::uint32_t> _fragments;
    std::deque<Sample> _order;
};

}  // namespace Rabit::Rtps
