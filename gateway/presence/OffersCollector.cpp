#include "presence/OffersCollector.h"

#include <span>

#include "wire/Announcements.h"

namespace Rabit
{

OffersCollector::Outcome OffersCollector::Add(std::uint32_t digest, const Gateway::AnnouncementPart &part)
{
    if (digest != _digest || part.of != _parts.Size())
    {
        _digest = digest;
        _parts.Begin(part.of);
    }
    _parts.Add(part.first, std::span<const std::uint8_t>(part.bytes.data(), part.bytes.size()));
    if (!_parts.IsComplete())
    {
        return Outcome::Incomplete;
    }
    if (Announcements::DigestOf(_parts.Bytes()) != digest)
    {
        *this = {};
        return Outcome::Wrong;
    }
    return Outcome::Complete;
}

std::uint16_t OffersCollector::FirstLacking(std::uint32_t digest) const
{
    return digest != _digest ? std::uint16_t{0} : static_cast<std::uint16_t>(_parts.FirstLacking());
}

}  // namespace Rabit
