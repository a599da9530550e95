#pragma once

#include <rabit/gateway/GatewayConfig.h>

#include <string>
#include <vector>

// Problems between the configurations of a fleet, each of which is valid alone. No node is asked: settings
// that programs make in code are unknown.
namespace Rabit::Tool::FleetCheck
{

struct Finding
{
    std::string File;
    int Line = 0;                    // 0: none
    std::vector<std::string> Nodes;  // whose configuration it is
    std::string Text;
    bool IsProblem = true;  // else worth knowing
};

// If a node is alone in its domain, its wishes are not checked: the other nodes are not among the files.
std::vector<Finding> FindingsOf(const std::vector<GatewayConfig> &fleet);

// Adds a finding. The same finding of several nodes of one file is listed once, with all nodes.
void Add(std::vector<Finding> &findings, Finding finding);

// Returns the line of a top-level key, or of a key of `radio` (`radio.budget`), in its file; 0 if it is
// missing.
int LineIn(const GatewayConfig &config, const std::string &key);

// Returns `uav1.yaml:4: ...`, with the nodes if the finding has several.
std::string LineOf(const Finding &finding);

}  // namespace Rabit::Tool::FleetCheck
