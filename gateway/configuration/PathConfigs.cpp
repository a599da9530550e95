#include <rabit/gateway/GatewayConfig.h>

#include <map>
#include <string>
#include <vector>

namespace Rabit
{
namespace
{

// The settings of a path stand in its entry, where it names them.
void SetLines(const PathRule &path, const std::map<std::string, int> &all, std::map<std::string, int> &lines)
{
    const std::string place = "paths." + path.Name + ".";
    for (const char *const setting : {"transport", "interfaces", "peers", "multicast", "radio.budget",
                                      "radio.slowest_beat", "security.keys"})
    {
        const auto line = all.find(place + setting);
        if (line != all.end())
        {
            lines[setting] = line->second;
        }
        else if (lines.count(setting) == 0 && path.Line > 0)
        {
            lines[setting] = path.Line;
        }
    }
}

}  // namespace

std::vector<GatewayConfig> PathConfigsOf(const GatewayConfig &config)
{
    if (config.Paths.empty())
    {
        return {config};
    }
    std::vector<GatewayConfig> configs;
    for (const PathRule &path : config.Paths)
    {
        GatewayConfig &of = configs.emplace_back(config);
        of.Paths = {path};
        of.Transport = path.Transport.empty() ? config.Transport : path.Transport;
        of.Interfaces = path.Interfaces;
        of.Peers = path.Peers;
        of.Multicast = path.Multicast;
        of.Radio = path.Radio;
        of.Security = path.Security ? path.Security : config.Security;
        SetLines(path, config.Lines, of.Lines);
    }
    return configs;
}

}  // namespace Rabit
