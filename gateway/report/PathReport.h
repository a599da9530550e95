#pragma once

#include <chrono>
#include <string>
#include <vector>

#include "gateway.idl.h"
#include "paths/PathChoice.h"
#include "paths/PeersOverPaths.h"

namespace Rabit::PathReport
{

// Fills in the paths to each node of the fleet, whose rows are there already. `names`: those of the paths, in
// their order.
void FillNodes(const PeersOverPaths &peers, const PathChoice &choice, const std::vector<std::string> &names,
               std::chrono::nanoseconds now, Gateway::Fleet &fleet);

// Adds to the row of a publication that of the same publication on another path.
void Add(const Gateway::PublicationStatus &other, Gateway::PublicationStatus &status);

// Adds the rates of another path.
void Add(const Gateway::AirStatus &other, Gateway::AirStatus &air);

}  // namespace Rabit::PathReport
