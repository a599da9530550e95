#pragma once

#include <SeedRunner.h>

#include <cstdint>
#include <ostream>

namespace Rabit::Sim
{

// Runs whole nodes, with their managers and gateways, on a simulated network: see SeedFunction.
SeedResult RunFleetSeed(std::uint64_t seed, std::ostream *trace);

}  // namespace Rabit::Sim
