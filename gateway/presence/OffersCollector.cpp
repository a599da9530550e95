#include "presence/OffersCollector.h"

#include <algorithm>

#include "wire/Announcements.h"

namespace Rabit
{

OffersCollector::Outcome OffersCollector::Add(std::uint32_t digest, const Gateway::AnnouncementPart &part)
{
    if (digest != _digest || part.of != _bytes.size())
    {
        _digest = digest;
        _bytes.assign(part.of, 0);
        _have.assign(part.of, false);
        _lacking = part.of;
    }
    for (std::size_t i = 0; i < part.bytes.size() && part.first + i < _bytes.size(); ++i)
    {
        _bytes[part.first + i] = part.bytes[i];
        _lacking -= _have[part.first + i] ? 0 : 1;
        _have[part.first + i] = true;
    }
    if (_lacking > 0)
    {
        return Outcome::Incomplete;
    }
    if (Announcements::DigestOf(_bytes) != digest)
    {
        *this = {};
        return Outcome::Wrong;
    }
    return Outcome::Complete;
}

std::uint16_t OffersCollector::FirstLacking(std::uint32_t digest) const
{
    return digest != _digest
               ? std::uint16_t{0}
               : static_cast<std::uint16_t>(std::find(_have.begin(), _have.end(), false) - _have.begin());
}

}  // namespace Rabit
