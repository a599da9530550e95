#pragma once

#include <string>
#include <vector>

namespace Rabit
{

// The unicast IPv4 addresses that one other session of the network tells to be reached by.
using PeerPlace = std::vector<std::string>;

}  // namespace Rabit
