#pragma once

#include <rabit/gateway/GatewayConfig.h>

#include <string>
#include <vector>

#include "FleetCheck.h"
#include "IdlFiles.h"

// The configurations that a command line names.
namespace Rabit::Tool::CheckedFiles
{

// A file, and the nodes that use it: `uav.yaml`, `uav1=uav.yaml`, `uav1,uav2=uav.yaml`.
struct Argument
{
    std::string File;
    std::vector<std::string> Nodes;  // empty: the node that the file names
};
// If a file of the whole name exists, that is the file, whatever characters the name has.
Argument Parse(const std::string &text);

// Loads them all. A bad file becomes a finding, the only one of its file, and is left out.
std::vector<GatewayConfig> Load(const std::vector<Argument> &arguments, const IdlFiles &types,
                                std::vector<FleetCheck::Finding> &findings);

}  // namespace Rabit::Tool::CheckedFiles
