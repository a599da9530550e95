#include "AircraftConfig.h"

#include "Names.h"

#include <rabit/gateway/ConfigError.h>

namespace Swarm
{

std::string AircraftOf(const std::string &visionNode)
{
    const std::string ending = Names::VisionOf("");
    if (!visionNode.ends_with(ending) || visionNode.size() == ending.size())
        throw Rabit::ConfigError("the node name `" + visionNode + "` is not its aircraft's name and `" +
                                 ending + "`");
    return visionNode.substr(0, visionNode.size() - ending.size());
}

void CompleteAircraftConfig(Rabit::GatewayConfig &config, const std::string &ground)
{
    const std::string vision = Names::VisionOf(config.Node);
    bool takesTargets = false;
    for (Rabit::SubscribeRule &rule : config.Subscribe)
    {
        if (rule.Message == "SearchArea" || rule.Message == "Geofence")
            rule.From = {ground};
        if (rule.Message != "Targets")
            continue;
        rule.From = {vision};
        takesTargets = true;
    }
    if (!takesTargets)
        config.Subscribe.push_back({.Message = "Targets", .Type = "Uav::Targets", .From = {vision}});
    Rabit::ValidateGatewayConfig(config);
}

}  // namespace Swarm
