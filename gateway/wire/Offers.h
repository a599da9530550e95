#pragma once

#include <algorithm>
#include <string>

#include "gateway.idl.h"

namespace Rabit::Offers
{

// The first entry of that message in an announcement; null if there is none.
inline const Gateway::PublishedMessage *Find(const Gateway::Announcement &announcement,
                                             const std::string &message)
{
    const auto found =
        std::find_if(announcement.publishes.begin(), announcement.publishes.end(),
                     [&message](const auto &published) { return published.message == message; });
    return found == announcement.publishes.end() ? nullptr : &*found;
}

}  // namespace Rabit::Offers
