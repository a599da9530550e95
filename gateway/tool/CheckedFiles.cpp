#include "CheckedFiles.h"

#include <rabit/gateway/ConfigError.h>
#include <rabit/gateway/LoadGatewayConfig.h>

#include <algorithm>
#include <charconv>
#include <filesystem>
#include <regex>
#include <sstream>

namespace Rabit::Tool::CheckedFiles
{
namespace
{

bool IsTypeName(const std::string &name)
{
    static const std::regex pattern("[A-Za-z][A-Za-z0-9_]*(::[A-Za-z][A-Za-z0-9_]*)*");
    return name.size() <= 255 && std::regex_match(name, pattern);
}

// Without --idl any type name will do: the types of the programs are unknown.
std::string WhyNoType(const IdlFiles &types, const std::string &name)
{
    if (!IsTypeName(name))
    {
        return "`" + name + "` is no name of an IDL type; expected one such as Uav::Pose";
    }
    return types.AreNone() ? "" : types.Find(name).Reason;
}

// Splits `file:line: text`.
FleetCheck::Finding FindingOf(const std::string &error, const std::string &file, const std::string &node)
{
    FleetCheck::Finding finding;
    finding.File = file;
    finding.Nodes.assign(node.empty() ? 0 : 1, node);
    finding.Text = error;
    if (error.starts_with(file + ":"))
    {
        const char *begin = error.data() + file.size() + 1;
        const char *end = error.data() + error.size();
        begin = std::from_chars(begin, end, finding.Line).ptr;
        begin = std::find_if(begin, end, [](char c) { return c != ':' && c != ' '; });
        finding.Text.assign(begin, end);
    }
    return finding;
}

}  // namespace

Argument Parse(const std::string &text)
{
    std::error_code ignored;
    const std::size_t equals = text.find('=');
    if (equals == std::string::npos || std::filesystem::exists(text, ignored))
    {
        return {text, {}};
    }
    Argument argument{text.substr(equals + 1), {}};
    std::istringstream nodes(text.substr(0, equals));
    for (std::string node; std::getline(nodes, node, ',');)
    {
        argument.Nodes.push_back(node);
    }
    return argument;
}

std::vector<GatewayConfig> Load(const std::vector<Argument> &arguments, const IdlFiles &types,
                                std::vector<FleetCheck::Finding> &findings)
{
    std::vector<GatewayConfig> fleet;
    const auto whyNoType = [&types](const std::string &name) { return WhyNoType(types, name); };
    for (const Argument &argument : arguments)
    {
        const std::vector<std::string> nodes =
            argument.Nodes.empty() ? std::vector<std::string>{""} : argument.Nodes;
        for (const std::string &node : nodes)
        {
            try
            {
                fleet.push_back(LoadGatewayConfig(argument.File, node, whyNoType));
            }
            catch (const ConfigError &error)
            {
                // The error names file and line itself.
                FleetCheck::Add(findings, FindingOf(error.what(), argument.File, node));
            }
        }
    }
    return fleet;
}

}  // namespace Rabit::Tool::CheckedFiles
