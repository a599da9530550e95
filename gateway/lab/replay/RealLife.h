#pragma once

#include <optional>
#include <string>
#include <vector>

#include "Recording.h"

namespace Rabit::WhatIf
{

struct RealLifeSettings
{
    std::string Node;
    int Life = 1;  // of the node's lives in the recording, from 1
    std::vector<std::string> Interfaces{};
    std::string Record{};  // a folder; empty: none
    // Replaces the node's budget, in bytes a second; 0: as the channel allows.
    std::optional<double> Budget{};
};

// Flies one recorded life of a node in real time, on a real network: posts and sends what it did, as long
// after the start as it was after the beginning of the life. Returns after SIGINT or SIGTERM. Throws
// ConfigError; std::runtime_error if the recording has no such life.
void FlyLife(Recording &recording, const RealLifeSettings &settings);

}  // namespace Rabit::WhatIf
