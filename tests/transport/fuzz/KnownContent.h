// What each writer has said, to tell damage of the protocol from forged content.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <set>
#include <span>
#include <utility>
#include <vector>

#include "Mutator.h"

// The content of a sample under the right number cannot be told from what its writer says: that is a matter
// for signatures. Copies that pass here do no more than repeat what a writer has said, under whatever number
// and to whomever; all of it a receiver has to withstand by itself.
class KnownContent
{
public:
    void Learn(const std::vector<Datagram> &datagrams);
    // Whether all samples in it that are not of discovery have a content that their writer was heard with.
    bool Covers(const Datagram &datagram) const;

private:
    // The participant's prefix and the entity.
    using Writer = std::array<std::uint8_t, 16>;
    using Sample = std::pair<Writer, std::size_t>;  // and the hash of the content

    static std::vector<Sample> SamplesOf(const Datagram &datagram);

    std::set<Sample> _known;
};
