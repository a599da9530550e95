// What the page and the terminal call the values of the enumerations. What is none of them, for it came from the network, is
// `unknown`.
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
