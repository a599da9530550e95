#pragma once

// Rabit::Gateway::Fleet, the local message Gateway/Fleet: the other nodes and their states, counters, and by
// name what keeps data from flowing. Defined in idl/messages/gateway.idl, which says what each member is.
//
//     AddPublishSubscribeMessage("Gateway/Fleet", _fleet);  // std::shared_ptr<Rabit::Gateway::Fleet>
//     ...
//     const auto *node = Rabit::Gateway::FindNode(*_fleet, "uav1");
//     if (node != nullptr && node->state == Rabit::Gateway::NodeState::UP)
//
// A node that has become UP was heard: its beats arrive. Its States follow: its beats tell their versions,
// and those that lack here are requested until they have come. At 20 % loss 95 % of them come within 0.6 s
// and 99 % within 1.3 s. A State that the node has not posted in this life does not come; the local message
// then keeps the value of an earlier life, whose age grows.
#include <algorithm>
#include <string_view>

#include "gateway.idl.h"

namespace Rabit::Gateway
{

// Returns the row of that node; null if it is not known.
inline const NodeStatus *FindNode(const Fleet &fleet, std::string_view node)
{
    const auto found = std::find_if(fleet.nodes.begin(), fleet.nodes.end(),
                                    [node](const NodeStatus &status) { return status.node == node; });
    return found == fleet.nodes.end() ? nullptr : &*found;
}

}  // namespace Rabit::Gateway
