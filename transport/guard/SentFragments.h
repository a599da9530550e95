// Records into how many fragments our sent samples were cut.
#pragma once

#include <cstddef>
#include <cstdint>
#include <utility>

#include "common/RecentMap.h"
#include "guard/RtpsMessage.h"

namespace Rabit::Rtps
{

// If a peer requests a fragment beyond the last one, the vendor would read past the end of the sample.
// Bounded: keeps the samples sent last. Not thread-safe.
class SentFragments
{
public:
    // Records the body of a DATA_FRAG of our own, which is sound.
    void Sent(RtpsReader fragment);
    // True if a sample was sent that has a fragment of this number, and all before it.
    bool Has(EntityId writer, std::int64_t sequence, std::uint32_t fragment) const;

    std::size_t Size() const { return _fragments.Size(); }

private:
    using Sample = std::pair<EntityId, std::int64_t>;

    // More than a history keeps of samples that are large enough for fragments.
    static constexpr std::size_t MostSamples = 4096;

    RecentMap<Sample, std::uint32_t> _fragments{MostSamples};
};

}  // namespace Rabit::Rtps
