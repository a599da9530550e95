#pragma once

#include "FleetWorld.h"
#include "PresenceOracle.h"

#include <rabit/simulated/SimulatedNetwork.h>

#include <cstdint>
#include <vector>

namespace Rabit::Sim
{

// The state of the network between each two nodes: the weather, and cuts, of which there may be several at
// once.
class Paths
{
public:
    // Begins with the weather of the plan's start.
    Paths(const FleetWorld &world, SimulatedNetwork &network, PresenceOracle &presence);

    void SetWeather(std::size_t from, std::size_t to, const SimulatedFaults &weather);
    void Cut(std::size_t from, std::size_t to);
    void EndCut(std::size_t from, std::size_t to);
    // Cuts the paths between all nodes.
    void CutAll();
    void EndCutOfAll();

    // Number of cuts so far.
    std::uint64_t Cuts() const { return _cuts; }

private:
    struct Path
    {
        SimulatedFaults Weather;
        int Cuts = 0;
    };

    Path &At(std::size_t from, std::size_t to) { return _paths[from * _count + to]; }
    void Apply(std::size_t from, std::size_t to);

    const FleetWorld &_world;
    SimulatedNetwork &_network;
    PresenceOracle &_presence;
    const std::size_t _count;
    std::vector<Path> _paths;
    std::uint64_t _cuts = 0;
};

}  // namespace Rabit::Sim
