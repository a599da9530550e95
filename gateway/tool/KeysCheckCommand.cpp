// rabit keys check: the problems of keys, and what they let nodes do.
#include <rabit/keys/KeysError.h>

#include <algorithm>
#include <ctime>
#include <filesystem>
#include <map>
#include <utility>

#include "Command.h"
#include "KeysConfig.h"
#include "SafeText.h"
#include "keys/FleetAuthority.h"
#include "keys/KeysFinding.h"
#include "keys/MemberCheck.h"
#include "keys/MemberFolder.h"
#include "keys/MemberPermissions.h"
#include "keys/NodeFolders.h"
#include "manager/NodeSecurity.h"

namespace Rabit::Tool
{
namespace KeysCheckParts
{
namespace
{

struct Options
{
    std::string Folder = "keys";
    std::vector<std::string> Configs;
    int Ahead = 30;
    bool Json = false;
};

// The report on one node.
struct Report
{
    std::string Node;
    std::string Folder;
    std::string Until;  // a day; empty: unknown
    std::vector<std::string> May;
    std::vector<Keys::KeysFinding> Findings;
};

// Returns true if there is no problem.
bool Show(const Report &report, bool json)
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

// Finds differences between the permissions and what the configuration needs.
void Compare(const Keys::MemberFolder &member, const GatewayConfig &config,
             std::vector<Keys::KeysFinding> &findings)
{
    const Keys::Access access = AccessOf(config);
    for (const std::string &one : member.Lacks(access))
    {
        findings.push_back({true, "may not " + one + ", which " + config.File + " wants; renew it"});
    }
    const auto needs = Keys::PermissionsFor(access);
    for (const auto &rule : member.Allowed().Rules())
    {
        const auto need = std::find_if(needs.Rules().begin(), needs.Rules().end(),
                                       [&rule](const auto &one) { return one.Topic == rule.Topic; });
        const bool isKnown = need != needs.Rules().end();
        if (rule.MayWrite && !(isKnown && need->MayWrite))
        {
            findings.push_back(
                {true, "may write " + rule.Topic + ", which " + config.File + " does not want; renew it"});
        }
        if (rule.MayRead && !(isKnown && need->MayRead))
        {
            findings.push_back(
                {false, "may read " + rule.Topic + ", which " + config.File + " does not want"});
        }
    }
}

// `config`: that of the node; null: none was given.
std::vector<Keys::KeysFinding> FindingsOf(const Keys::MemberFolder &member, const GatewayConfig *config,
                                          int ahead)
{
    const Envelope::Certificate &certificate = member.Certificate();
    std::vector<Keys::KeysFinding> findings = Keys::WhatEnds(certificate, std::time(nullptr), ahead);
    const auto tooMuch = Keys::WhatIsTooMuch(certificate, member.Allowed());
    findings.insert(findings.end(), tooMuch.begin(), tooMuch.end());
    if (const std::string why = member.WhyNot(certificate.Name); !why.empty())
    {
        findings.push_back({true, why});
    }
    if (config != nullptr)
    {
        Compare(member, *config, findings);
    }
    if (!member.HasKey())
    {
        findings.push_back({false, "its private key is on the node alone"});
    }
    return findings;
}

// Reports on one node's folder; returns true if it is good. `fleet`: that of the authority; null: the folder
// was named alone. Beside an authority the folder may lack the private key.
bool Check(const std::string &folder, const std::map<std::string, GatewayConfig> &configs,
           const Options &options, const Keys::FleetAuthority *fleet)
{
    Report report{.Node = std::filesystem::path(folder).filename().string(),
                  .Folder = folder,
                  .Until = "",
                  .May = {},
                  .Findings = {}};
    try
    {
        const std::filesystem::path parent = std::filesystem::weakly_canonical(folder).parent_path();
        const bool isBesideAuthority = Keys::FleetAuthority::IsIn(parent.string());
        const Keys::MemberFolder member(
            folder, isBesideAuthority ? Keys::KeyPlace::HereOrOnNode : Keys::KeyPlace::Here);
        report.Node = member.Certificate().Name;
        report.Until = Keys::EndOf(member.Certificate());
        report.May = Keys::WhoMayWhat(member.Allowed());
        const auto config = configs.find(report.Node);
        report.Findings =
            FindingsOf(member, config == configs.end() ? nullptr : &config->second, options.Ahead);
        if (fleet != nullptr && member.Epoch() < fleet->Epoch())
        {
            report.Findings.push_back({true, "its bulletin is of epoch " + std::to_string(member.Epoch()) +
                                                 ", and the fleet is in epoch " +
                                                 std::to_string(fleet->Epoch()) +
                                                 "; copy authority/bulletin into its folder of keys"});
        }
    }
    catch (const Keys::KeysError &error)
    {
        report.Findings.push_back({true, error.what()});
    }
    return Show(report, options.Json);
}

// Reads the configurations, by their nodes. Throws ConfigError.
std::map<std::string, GatewayConfig> ConfigsOf(const Options &options)
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

// Names the nodes of these that have no folder in that of the fleet. Returns true if there are none.
bool AllHaveKeys(const std::map<std::string, GatewayConfig> &configs, const Keys::FleetAuthority &fleet)
{
    bool all = true;
    for (const auto &[node, config] : configs)
    {
        if (!std::filesystem::exists(fleet.FolderOf(node)))
        {
            Output::Talk(node + " has no keys; `rabit keys add " + node + " --config " + config.File + "`");
            all = false;
        }
    }
    return all;
}

int Run(const Options &options)
{
    Keys::CheckFormat(options.Folder);
    const std::map<std::string, GatewayConfig> configs = ConfigsOf(options);
    if (!Keys::FleetAuthority::IsIn(options.Folder))
    {
        return Check(options.Folder, configs, options, nullptr) ? Good : ProblemFound;
    }
    const Keys::FleetAuthority fleet(options.Folder);
    bool isGood = true;
    for (const std::string &node : fleet.Nodes())
    {
        isGood = Check(fleet.FolderOf(node), configs, options, &fleet) && isGood;
    }
    for (const std::string &node : options.Json ? std::vector<std::string>() : fleet.Revoked())
    {
        if (!std::filesystem::exists(fleet.FolderOf(node)))
        {
            Output::Line(SafeText(node) + ": revoked");
        }
    }
    return AllHaveKeys(configs, fleet) && isGood ? Good : ProblemFound;
}

}  // namespace
}  // namespace KeysCheckParts

void AddKeysCheckCommand(CLI::App &keys, Chosen &chosen)
{
    using namespace KeysCheckParts;
    const auto [command, options] =
        AddCommand<Options>(keys, chosen, "check", "What is wrong with keys, and who may do what", &Run);
    command->add_flag("--json", options->Json, "One JSON object a line");
    AddExamples(*command, {"rabit keys check", "rabit keys check keys --config uav1.yaml",
                           "rabit keys check --ahead 60 --json"});
    command->add_option("FOLDER", options->Folder, "The fleet's folder, or one node's")
        ->capture_default_str();
    command->add_option("--config", options->Configs, "Configurations of nodes, to compare with")
        ->check(CLI::ExistingFile);
    command->add_option("--ahead", options->Ahead, "Days before the end from which on it is a problem")
        ->check(CLI::Range(0, 3650))
        ->capture_default_str();
}

}  // namespace Rabit::Tool
