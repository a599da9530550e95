// Checks the settings that mean the same to every backend.
#pragma once

#include <rabit/transport/Transport.h>

#include <vector>

namespace Rabit
{

// The impossible settings, in the order of TransportSettings, independent of the network's state.
std::vector<SettingsProblem> FindImpossible(const TransportSettings &settings);

// Throws TransportError if FindImpossible finds a problem.
void CheckSettings(const TransportSettings &settings);

// Throws TransportError if the depth is out of its range, 1 to 1,000,000.
void CheckQos(const TopicDescription &topic, const TopicQos &qos);

}  // namespace Rabit
