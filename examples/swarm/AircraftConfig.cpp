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
    for (Rabit::SubscribeRule &rule : config.Subscribe)
    {
        if (rule.Message == "SearchArea")
            rule.From = {ground};
        if (rule.Message == "Targets")
            rule.From = {Names::VisionOf(config.Node)};
    }
    Rabit::ValidateGatewayConfig(config);
}

}  // namespace Swarm
