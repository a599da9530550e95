#pragma once

#include <rabit/dynamic/DynamicType.h>

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "FleetSession.h"

namespace Rabit::Tool
{

// A type of the fleet, had from a node that has announced it.
struct FleetType
{
    std::string Text;                         // IDL; empty: nobody has handed it out
    std::shared_ptr<const DynamicType> Type;  // null if the text could not be had or understood
    std::string Reason;                       // why, in one line
};

// Asks these nodes, one after the other, for the type of that definition; waits until so many seconds from
// the start of the session at most.
FleetType FetchType(FleetSession &session, const std::vector<std::string> &nodes, const std::string &name,
                    std::uint64_t definition, double until);

}  // namespace Rabit::Tool
