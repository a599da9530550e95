#pragma once

#include "FleetWorld.h"

#include <cstdint>
#include <map>
#include <tuple>
#include <utility>
#include <vector>

#include "gateway.idl.h"

namespace Rabit::Sim
{

// Knows which node could be heard where. Fails if a gateway shows a node as live that has long been silent.
class PresenceOracle
{
public:
    // How much later than promised a state may change: the delays of both directions, which cannot be told
    // apart, and the sampling of the state.
    static constexpr Time Tolerance = std::chrono::milliseconds(500);

    explicit PresenceOracle(FleetWorld &world);

    void OnCut(std::size_t from, std::size_t to);
    void OnCutEnd(std::size_t from, std::size_t to);
    void OnStarted(std::size_t node);
    void OnEnded(std::size_t node);

    // The gateway of a life shows this fleet now.
    void OnFleet(std::size_t observerLife, const Gateway::Fleet &fleet);
    // True if the fleet shows the node as UP.
    static bool IsUp(const Gateway::Fleet &fleet, const std::string &node);

    std::uint64_t Stale() const { return _stale; }
    std::uint64_t Lost() const { return _lost; }

private:
    struct Path
    {
        int Cuts = 0;
        Time CutAt{0};
    };
    // Writes the shown state to the trace.
    void SayWhatIsShown(std::size_t observer, std::size_t node, Gateway::NodeState state);

    struct Machine
    {
        bool Alive = false;
        Time EndedAt{0};
    };

    FleetWorld &_world;
    std::vector<Path> _paths;
    std::vector<Machine> _machines;
    std::map<std::pair<std::size_t, std::size_t>, Gateway::NodeState> _shown;  // by observer and node
    // By observing life, node and incarnation. The first beat that comes of a life may be late: it looks
    // like a new one.
    std::map<std::tuple<std::size_t, std::size_t, std::uint64_t>, Time> _firstShown;
    std::uint64_t _stale = 0;
    std::uint64_t _lost = 0;
};

}  // namespace Rabit::Sim
