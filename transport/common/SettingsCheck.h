// Checks the settings that mean the same to every backend.
#pragma once

#include <rabit/transport/Transport.h>

#include <vector>

namespace Rabit
{

// What is impossible in the settings, in the order of TransportSettings; whatever the network is like.
std::vector<SettingsProblem> FindImpossible(const TransportSettings &settings);

// Throws TransportError if there is anything of the kind.
void CheckSettings(const TransportSettings &settings);

// Throws TransportError if the depth is out of its range, 1 to 1,000,000.
void CheckQos(const TopicDescription &topic, const TopicQos &qos);

}  // namespace Rabit
