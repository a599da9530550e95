// The names of enumeration values on the page and the terminal. Undeclared values, which the network may
// bring, are `unknown`.
#pragma once

#include "FleetTable.h"
#include "ground.idl.h"
#include "uav.idl.h"

namespace Ground
{

const char *WireName(RowState state);
const char *WireName(Uav::MissionMode mode);
const char *WireName(Uav::TargetStage stage);
const char *WireName(OrderKind kind);
const char *WireName(CommandProgress progress);

}  // namespace Ground
