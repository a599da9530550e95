// The names of enumeration values on the page and the terminal. Undeclared values, which the network may
// bring, are `unknown`.
#pragma once

#include "FleetTable.h"
#include "ground.idl.h"
#include "uav.idl.h"

#include <string>

namespace Ground
{

std::string WireName(RowState state);
// `MISSION_IDLE` is `idle`, `PROGRESS_IN_DOUBT` is `in doubt`.
std::string WireNameOf(const std::string &enumerator);
template <typename Enum>
std::string WireName(Enum value)
{
    return WireNameOf(ToString(value));
}

}  // namespace Ground
