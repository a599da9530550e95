#pragma once

#include <string>
#include <vector>

namespace Rabit
{

// The unicast IPv4 addresses that one other session announces.
using PeerPlace = std::vector<std::string>;

}  // namespace Rabit
