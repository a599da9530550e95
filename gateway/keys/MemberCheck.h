#pragma once

#include <ctime>
#include <string>
#include <vector>

#include "envelope/Certificate.h"
#include "envelope/Permissions.h"
#include "keys/KeysFinding.h"

namespace Rabit::Keys
{

// Finds permissions that no node needs: patterns, except that a tool may read all topics.
std::vector<KeysFinding> WhatIsTooMuch(const Envelope::Certificate &certificate,
                                       const Envelope::Permissions &allowed);

// Finds a certificate that has not begun, has ended, or ends within `days` days. Nodes go on with it.
std::vector<KeysFinding> WhatEnds(const Envelope::Certificate &certificate, std::time_t now, int days);

// The day on which a certificate ends, in UTC: `2027-11-23`.
std::string EndOf(const Envelope::Certificate &certificate);

// Lists the permissions in words, one line each: `writes Pose, MissionState`, `reads everything`.
std::vector<std::string> WhoMayWhat(const Envelope::Permissions &allowed);

}  // namespace Rabit::Keys
