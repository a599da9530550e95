#include "KeysReport.h"

#include <algorithm>
#include <filesystem>
#include <utility>

#include "Command.h"
#include "KeysDomains.h"
#include "SafeText.h"

namespace Rabit::Tool
{

bool Print(const KeysReport &report, bool json)
{
    const bool isGood = std::none_of(report.Findings.begin(), report.Findings.end(),
                                     [](const Keys::KeysFinding &finding) { return finding.IsProblem; });
    if (json)
    {
        Json problems = Json::array();
        Json notes = Json::array();
        for (const Keys::KeysFinding &finding : report.Findings)
        {
            (finding.IsProblem ? problems : notes).push_back(finding.Text);
        }
        Output::Object(Json{{"node", report.Node},
                            {"folder", report.Folder},
                            {"until", report.Until},
                            {"may", report.May},
                            {"problems", problems},
                            {"notes", notes}});
        return isGood;
    }
    Output::Line(SafeText(report.Node) + (report.Until.empty() ? "" : ": valid until " + report.Until));
    for (const std::string &line : report.May)
    {
        Output::Line("  " + SafeText(line));
    }
    for (const Keys::KeysFinding &finding : report.Findings)
    {
        Output::Line((finding.IsProblem ? "  problem: " : "  note: ") + SafeText(finding.Text));
    }
    return isGood;
}

std::map<std::string, GatewayConfig> ConfigsOf(const KeysCheckOptions &options)
{
    std::map<std::string, GatewayConfig> configs;
    for (const std::string &file : options.Configs)
    {
        GatewayConfig config = ConfigForKeys(file, "");
        const std::string node = config.Node;
        configs.insert_or_assign(node, std::move(config));
    }
    return configs;
}

bool AllHaveKeys(const std::map<std::string, GatewayConfig> &configs, const std::string &fleet)
{
    bool all = true;
    for (const auto &[node, config] : configs)
    {
        if (!std::filesystem::exists(fleet + "/" + node))
        {
            Output::Talk(node + " has no keys; `rabit keys add " + node + " --config " + config.File + "`");
            all = false;
        }
    }
    return all;
}

}  // namespace Rabit::Tool
