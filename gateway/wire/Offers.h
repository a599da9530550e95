#pragma once

#include <algorithm>
#include <string>

#include "gateway.idl.h"

namespace Rabit::Offers
{

// What an announcement says of that message; null if nothing. Of several the first counts.
inline const Gateway::PublishedMessage *Find(const Gateway::Announcement &announcement,
                                             const std::string &message)
{
    const auto found =
        std::find_if(announcement.publishes.begin(), announcement.publishes.end(),
                     [&message](const auto &published) { return published.message == message; });
    return found == announcement.publishes.end() ? nullptr : &*found;
}

}  // namespace Rabit::Offers
