#include "NodeState.h"

#include <algorithm>

namespace Ground
{

const Rabit::Gateway::NodeStatus *StatusOf(const Rabit::Gateway::Fleet &fleet, const std::string &node)
{
    const auto status = std::find_if(fleet.nodes.begin(), fleet.nodes.end(),
                                     [&node](const auto &candidate) { return candidate.node == node; });
    return status == fleet.nodes.end() ? nullptr : &*status;
}

RowState StateOf(const Rabit::Gateway::Fleet &fleet, double fleetAgeS, const std::string &node)
{
    const Rabit::Gateway::NodeStatus *const status = StatusOf(fleet, node);
    if (status == nullptr)
        return RowState::Waiting;
    switch (status->state)
    {
        case Rabit::Gateway::NodeState::UP:
            return fleetAgeS <= FleetFreshS ? RowState::Up : RowState::Stale;
        case Rabit::Gateway::NodeState::STALE:
            return RowState::Stale;
        case Rabit::Gateway::NodeState::LOST:
            return RowState::Lost;
    }
    return RowState::Lost;
}

}  // namespace Ground
