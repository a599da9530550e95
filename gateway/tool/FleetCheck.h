#pragma once

#include <rabit/gateway/GatewayConfig.h>

#include <string>
#include <vector>

// What is wrong with the configurations of a fleet together, each of which is good alone. Nobody is asked:
// what programs do beyond their files is not known.
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

// Of a node alone in its domain nothing is said of what it wants: the others are not among the files.
std::vector<Finding> FindingsOf(const std::vector<GatewayConfig> &fleet);

// Adds one; the same of several nodes of one file is one.
void Add(std::vector<Finding> &findings, Finding finding);

// The line of a top-level key, or of one of `radio` (`radio.budget`), in its file; 0: it is not there.
int LineIn(const GatewayConfig &config, const std::string &key);

// `uav1.yaml:4: ...`, with the nodes if there are several in the file.
std::string LineOf(const Finding &finding);

}  // namespace Rabit::Tool::FleetCheck
