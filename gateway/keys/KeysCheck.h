#pragma once

#include <ctime>
#include <string>
#include <vector>

#include "keys/KeysFinding.h"
#include "keys/NodeKeys.h"

namespace Rabit::Keys
{

// Finds permissions that no node needs: writing by a pattern or in the partition of another node, anything
// that is not forbidden, a range of domains, reading topics by a pattern. Permissions of a tool may read all
// topics.
std::vector<KeysFinding> WhatIsTooMuch(const NodeKeys &keys);

// Finds a certificate, or a list of revoked ones, that is not valid yet, has ended, or ends within `days`
// days.
std::vector<KeysFinding> WhatEnds(const NodeKeys &keys, std::time_t now, int days);

// Lists the permissions in words, one line each: `writes Pose, MissionState`, `reads Pose of uav*`.
std::vector<std::string> WhoMayWhat(const NodeKeys &keys);

}  // namespace Rabit::Keys
