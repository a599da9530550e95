#include <rabit/gateway/GatewayConfig.h>

#include <algorithm>
#include <map>
#include <string>
#include <utility>
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
                                      "radio.slowest_beat", "security", "security.keys"})
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

bool SomePathHasKeys(const GatewayConfig &config)
{
    return config.Security || std::any_of(config.Paths.begin(), config.Paths.end(),
                                          [](const PathRule &path) { return path.Security.has_value(); });
}

void UseInterfaces(const std::vector<std::string> &interfaces, GatewayConfig &config)
{
    if (!config.Paths.empty())
    {
        const auto names = [&interfaces](const GatewayConfig &path)
        {
            return std::find_first_of(path.Interfaces.begin(), path.Interfaces.end(), interfaces.begin(),
                                      interfaces.end()) != path.Interfaces.end();
        };
        std::vector<GatewayConfig> paths = PathConfigsOf(config);
        const auto fit = std::find_if(paths.begin(), paths.end(), names);
        config = std::move(fit == paths.end() ? paths.front() : *fit);
        config.Paths.clear();
    }
    config.Interfaces = interfaces;
}

}  // namespace Rabit
