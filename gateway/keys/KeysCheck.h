#pragma once

#include <ctime>
#include <string>
#include <vector>

#include "keys/NodeKeys.h"

namespace Rabit::Keys
{

// What a person should know of a node's keys.
struct KeysFinding
{
    bool IsProblem = true;  // or a note
    std::string Text;
};

// What the permissions allow that no node needs: writing by a pattern, in the partition of another node, or
// whatever is not forbidden; reading topics by a pattern. Permissions of a tool may read all.
std::vector<KeysFinding> WhatIsTooMuch(const NodeKeys &keys);

// What is wrong with the dates, and what soon will be: `days` ahead.
std::vector<KeysFinding> WhatEnds(const NodeKeys &keys, std::time_t now, int days);

// Who may what, in words, a line for each: `writes Pose, MissionState`, `reads Pose of uav*`.
std::vector<std::string> WhoMayWhat(const NodeKeys &keys);

}  // namespace Rabit::Keys
