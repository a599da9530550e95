#pragma once

#include <cstdint>
#include <vector>

#include "gateway.idl.h"
#include "wire/PartsCollector.h"

namespace Rabit
{

// Puts the parts of another node's announcement together, in whatever order they come. One announcement at a
// time; parts of another one begin anew. Bounded by the size of an announcement.
class OffersCollector
{
public:
    enum class Outcome
    {
        Incomplete,
        Complete,  // Bytes() is the announcement
        Wrong      // all parts were there and do not match the digest; they are dropped
    };

    // The part must lie within the whole, and that within the bounds of an announcement.
    Outcome Add(std::uint32_t digest, const Gateway::AnnouncementPart &part);
    const std::vector<std::uint8_t> &Bytes() const { return _parts.Bytes(); }
    // The first lacking byte of that announcement.
    std::uint16_t FirstLacking(std::uint32_t digest) const;

private:
    std::uint32_t _digest = 0;
    PartsCollector _parts;
};

}  // namespace Rabit
