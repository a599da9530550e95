// The content that each writer has sent, to tell damage of the protocol from forged content.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <set>
#include <span>
#include <utility>
#include <vector>

#include "Mutator.h"

// Only a signature tells forged content under the right number from the writer's own. A copy that passes
// here at most repeats the writer's content, under any number and to any receiver. A receiver must
// withstand all such copies by itself.
class KnownContent
{
public:
    void Learn(const std::vector<Datagram> &datagrams);
    // True if each sample in the datagram, apart from discovery, has a content that its writer was heard
    // with.
    bool Covers(const Datagram &datagram) const;

private:
    // The participant's prefix and the entity.
    using Writer = std::array<std::uint8_t, 16>;
    using Sample = std::pair<Writer, std::size_t>;  // and the hash of the content

    static std::vector<Sample> SamplesOf(const Datagram &datagram);

    std::set<Sample> _known;
};
