#pragma once

#include <rabit/dynamic/DynamicType.h>

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "FleetSession.h"

namespace Rabit::Tool
{

// A type of the fleet, received from a node that has announced it.
struct FleetType
{
    std::string Text;                         // IDL; empty: no node has handed it out
    std::shared_ptr<const DynamicType> Type;  // null if the text did not come or cannot be used
    std::string Reason;                       // why it is null, in one line
};

// Asks these nodes, one after the other, for the type of that definition; waits until `until`, in seconds
// from the start of the session.
FleetType FetchType(FleetSession &session, const std::vector<std::string> &nodes, const std::string &name,
                    std::uint64_t definition, double until);

}  // namespace Rabit::Tool
