// rabit keys check: the problems of keys, and what they let nodes do.
#include <algorithm>
#include <ctime>
#include <filesystem>
#include <map>

#include "Command.h"
#include "KeysDomains.h"
#include "KeysReport.h"
#include "SafeText.h"
#include "SealedKeys.h"
#include "keys/FleetKeys.h"
#include "keys/KeysCheck.h"
#include "keys/KeysError.h"
#include "manager/NodeSecurity.h"

namespace Rabit::Tool
{
namespace KeysCheckParts
{
namespace
{

using Options = KeysCheckOptions;

// Returns the domain of the most nodes; -1 if two domains have equally many, or none has any.
int UsualDomainOf(const Keys::FleetKeys &fleet)
{
    const std::map<int, std::size_t> domains = DomainsOf(fleet);
    const auto most =
        std::max_element(domains.begin(), domains.end(),
                         [](const auto &one, const auto &other) { return one.second < other.second; });
    const auto same = std::count_if(domains.begin(), domains.end(),
                                    [&](const auto &one) { return one.second == most->second; });
    return same == 1 ? most->first : -1;
}

std::vector<Keys::KeysFinding> FindingsOf(const Keys::NodeKeys &keys, const GatewayConfig *config, int ahead)
{
    std::vector<Keys::KeysFinding> findings = Keys::WhatEnds(keys, std::time(nullptr), ahead);
    const auto tooMuch = Keys::WhatIsTooMuch(keys);
    findings.insert(findings.end(), tooMuch.begin(), tooMuch.end());
    if (config == nullptr)
    {
        return findings;
    }
    if (const std::string why = keys.WhyNever(config->Node, config->Transport, config->Domain); !why.empty())
    {
        findings.push_back({true, why});
    }
    const Keys::Access needs = AccessOf(*config);
    for (const std::string &one : keys.Lacks(needs))
    {
        findings.push_back({true, "may not " + one + ", which " + config->File + " wants; renew it"});
    }
    const auto isNeeded = [](const std::vector<Keys::TopicAccess> &list, const Keys::TopicAccess &one)
    { return std::find(list.begin(), list.end(), one) != list.end(); };
    for (const Keys::Permissions::Rule &rule : keys.Permissions().Rules)
    {
        for (const Keys::TopicAccess &one : rule.Publish)
        {
            if (rule.Allows && !isNeeded(needs.Publish, one))
            {
                findings.push_back({true, "may write " + one.Topic + ", which " + config->File +
                                              " does not want; renew it"});
            }
        }
        for (const Keys::TopicAccess &one : rule.Subscribe)
        {
            if (rule.Allows && !isNeeded(needs.Subscribe, one))
            {
                findings.push_back(
                    {false, "may read " + one.Topic + " otherwise than " + config->File + " wants"});
            }
        }
    }
    return findings;
}

// Reports on one node's folder; returns true if it is good. Beside the authorities it may lack the private
// key. `usual`: the domain of the other nodes; -1: none.
bool Check(const std::string &folder, const std::map<std::string, GatewayConfig> &configs,
           const Options &options, int usual = -1)
{
    KeysReport report{.Node = std::filesystem::path(folder).filename().string(),
                      .Folder = folder,
                      .Until = "",
                      .May = {},
                      .Findings = {}};
    try
    {
        const std::filesystem::path parent = std::filesystem::weakly_canonical(folder).parent_path();
        const Keys::NodeKeys keys(folder, Keys::FleetKeys::IsFleet(parent.string())
                                              ? Keys::PrivateKeyPlace::HereOrOnNode
                                              : Keys::PrivateKeyPlace::Here);
        report.Node = keys.Subject().Node;
        report.Until = Keys::DayText(keys.ValidityOf().To);
        report.May = Keys::WhoMayWhat(keys);
        const auto config = configs.find(report.Node);
        report.Findings =
            FindingsOf(keys, config == configs.end() ? nullptr : &config->second, options.Ahead);
        if (!keys.HasPrivateKey())
        {
            report.Findings.push_back({false, "its private key is on the node alone"});
        }
        if (usual >= 0 && DomainOf(keys) != usual)
        {
            report.Findings.push_back({false, "most nodes are in domain " + std::to_string(usual)});
        }
    }
    catch (const Keys::KeysError &error)
    {
        report.Findings.push_back({true, error.what()});
    }
    return Print(report, options.Json);
}

int Run(const Options &options)
{
    if (SealedKeys::AreIn(options.Folder))
    {
        return SealedKeys::Check(options);
    }
    if (Keys::FleetKeys::IsFleet(options.Folder) ||
        std::filesystem::exists(Keys::NodeFiles(options.Folder).Certificate))
    {
        Output::Talk("the keys in " + options.Folder +
                     " are of the former format, which will be removed; `rabit keys init --sealed` makes a "
                     "fleet of the new one");
    }
    const std::map<std::string, GatewayConfig> configs = ConfigsOf(options);
    if (!Keys::FleetKeys::IsFleet(options.Folder))
    {
        return Check(options.Folder, configs, options) ? Good : ProblemFound;
    }
    const Keys::FleetKeys fleet(options.Folder);
    const int usual = UsualDomainOf(fleet);
    bool isGood = true;
    for (const std::string &node : fleet.Nodes())
    {
        isGood = Check(fleet.FolderOf(node), configs, options, usual) && isGood;
    }
    for (const std::string &node : options.Json ? std::vector<std::string>() : fleet.Revoked())
    {
        if (!std::filesystem::exists(fleet.FolderOf(node)))
        {
            Output::Line(SafeText(node) + ": revoked");
        }
    }
    return AllHaveKeys(configs, options.Folder) && isGood ? Good : ProblemFound;
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
