#include "FleetCheck.h"

#include <rabit/base/ListedNames.h>
#include <rabit/base/NaturalOrder.h>
#include <rabit/gateway/ConfigError.h>
#include <rabit/idl/NearestWord.h>

#include <algorithm>
#include <map>
#include <set>
#include <utility>

#include "WantCheck.h"

namespace Rabit::Tool::FleetCheck
{
namespace
{

using Fleet = std::vector<GatewayConfig>;

void CheckNames(const Fleet &fleet, std::vector<Finding> &findings)
{
    std::map<std::pair<int, std::string>, const GatewayConfig *> seen;
    for (const GatewayConfig &config : fleet)
    {
        const auto [first, isNew] = seen.emplace(std::pair(config.Domain, config.Node), &config);
        if (!isNew)
        {
            Add(findings,
                {config.File,
                 LineIn(config, "node"),
                 {config.Node},
                 "two nodes are called `" + config.Node + "`; the other one is in " + first->second->File});
        }
    }
}

bool IsSameAgreement(AgreementRule one, AgreementRule other)
{
    std::sort(one.Members.begin(), one.Members.end());
    std::sort(other.Members.begin(), other.Members.end());
    return one.Members == other.Members && one.Lease == other.Lease;
}

void CheckAgreements(const Fleet &fleet, std::vector<Finding> &findings)
{
    std::map<int, const GatewayConfig *> first;  // with an agreement, in each domain
    for (const GatewayConfig &config : fleet)
    {
        const auto known = config.Agreement ? first.emplace(config.Domain, &config).first : first.end();
        if (known != first.end() && !IsSameAgreement(*known->second->Agreement, *config.Agreement))
        {
            Add(findings,
                {config.File,
                 LineIn(config, "agreement"),
                 {config.Node},
                 "`agreement` has other members, or another lease, than that of `" + known->second->Node +
                     "` in " + known->second->File + "; all members need the same"});
        }
    }
    for (const GatewayConfig &config : fleet)
    {
        const auto known = config.Agreement ? first.end() : first.find(config.Domain);
        if (known == first.end())
        {
            continue;
        }
        const std::vector<std::string> &members = known->second->Agreement->Members;
        if (std::find(members.begin(), members.end(), config.Node) != members.end())
        {
            Add(findings, {config.File,
                           LineIn(config, "node"),
                           {config.Node},
                           "`" + config.Node + "` is a member of the `agreement` in " + known->second->File +
                               ", and has none itself: it does not vote"});
        }
    }
}

// Groups domains that are connected because one process has a gateway in each (two gateways with two names).
std::vector<std::set<int>> ConnectedDomains(const Fleet &fleet)
{
    std::vector<std::set<int>> groups;
    const auto join = [&groups](const std::set<int> &domains)
    {
        std::set<int> joined = domains;
        std::erase_if(groups,
                      [&joined](const std::set<int> &group)
                      {
                          const bool meets =
                              std::any_of(group.begin(), group.end(),
                                          [&joined](int domain) { return joined.contains(domain); });
                          if (meets)
                          {
                              joined.insert(group.begin(), group.end());
                          }
                          return meets;
                      });
        groups.push_back(joined);
    };
    for (const GatewayConfig &config : fleet)
    {
        std::set<int> domains{config.Domain};
        for (const GatewayConfig &other : fleet)
        {
            if (other.Node == config.Node && other.Name != config.Name)
            {
                domains.insert(other.Domain);
            }
        }
        join(domains);
    }
    return groups;
}

// Reports the nodes of all groups except the largest.
void CheckDomains(const Fleet &fleet, std::vector<Finding> &findings)
{
    const std::vector<std::set<int>> groups = ConnectedDomains(fleet);
    const auto nodesIn = [&fleet](const std::set<int> &group)
    {
        std::set<std::string, NaturalOrder> nodes;
        for (const GatewayConfig &config : fleet)
        {
            if (group.contains(config.Domain))
            {
                nodes.insert(config.Node);
            }
        }
        return std::vector<std::string>(nodes.begin(), nodes.end());
    };
    const auto largest = std::max_element(groups.begin(), groups.end(),
                                          [&nodesIn](const std::set<int> &one, const std::set<int> &other)
                                          { return nodesIn(one).size() < nodesIn(other).size(); });
    for (const GatewayConfig &config : fleet)
    {
        if (!largest->contains(config.Domain))
        {
            Add(findings,
                {config.File,
                 LineIn(config, "domain"),
                 {config.Node},
                 "domain " + std::to_string(config.Domain) + " does not hear domain " +
                     std::to_string(*largest->begin()) + ", where " + ListedNames(nodesIn(*largest)) +
                     (nodesIn(*largest).size() == 1 ? " is" : " are")});
        }
    }
}

void CheckTransports(const Fleet &fleet, std::vector<Finding> &findings)
{
    const std::string &first = fleet.front().Transport;
    for (const GatewayConfig &config : fleet)
    {
        if (config.Transport != first)
        {
            const bool shares = config.SharedMemory || fleet.front().SharedMemory;
            Add(findings,
                {.File = config.File,
                 .Line = LineIn(config, "transport"),
                 .Nodes = {config.Node},
                 .Text = "the transport is `" + config.Transport + "`, that of " + fleet.front().Node + " `" +
                         first + "`; they understand each other" + (shares ? ", but share no memory" : ""),
                 .IsProblem = false});
        }
    }
}

// Reports nodes without multicast, if other nodes are in their domain, and no file of the domain names
// `peers`.
void CheckPeers(const Fleet &fleet, std::vector<Finding> &findings)
{
    for (const GatewayConfig &config : fleet)
    {
        const auto isInDomain = [&config](const GatewayConfig &one) { return one.Domain == config.Domain; };
        const bool isAlone = std::count_if(fleet.begin(), fleet.end(), isInDomain) == 1;
        const bool hasPeers = std::any_of(fleet.begin(), fleet.end(),
                                          [&isInDomain](const GatewayConfig &one)
                                          { return isInDomain(one) && !one.Peers.empty(); });
        if (!config.Multicast && !isAlone && !hasPeers)
        {
            Add(findings, {config.File,
                           LineIn(config, "multicast"),
                           {config.Node},
                           "without multicast this node finds no other: no file of domain " +
                               std::to_string(config.Domain) + " names `peers`"});
        }
    }
}

}  // namespace

void Add(std::vector<Finding> &findings, Finding finding)
{
    const auto same = std::find_if(
        findings.begin(), findings.end(),
        [&finding](const Finding &other)
        { return other.File == finding.File && other.Line == finding.Line && other.Text == finding.Text; });
    if (same == findings.end())
    {
        findings.push_back(std::move(finding));
        return;
    }
    for (std::string &node : finding.Nodes)
    {
        if (std::find(same->Nodes.begin(), same->Nodes.end(), node) == same->Nodes.end())
        {
            same->Nodes.push_back(std::move(node));
        }
    }
}

int LineIn(const GatewayConfig &config, const std::string &key)
{
    const auto found = config.Lines.find(key);
    return found == config.Lines.end() ? 0 : found->second;
}

std::string LineOf(const Finding &finding)
{
    std::string text = finding.Text;
    if (finding.Nodes.size() > 1)
    {
        text += " (" + ListedNames(finding.Nodes) + ")";
    }
    return ConfigError(finding.File, finding.Line, (finding.IsProblem ? "" : "note: ") + text).what();
}

std::vector<Finding> FindingsOf(const Fleet &fleet)
{
    std::vector<Finding> findings;
    if (fleet.empty())
    {
        return findings;
    }
    CheckNames(fleet, findings);
    CheckDomains(fleet, findings);
    CheckTransports(fleet, findings);
    CheckPeers(fleet, findings);
    CheckAgreements(fleet, findings);
    for (const GatewayConfig &config : fleet)
    {
        WantCheck(config, fleet, findings).Run();
    }
    return findings;
}

}  // namespace Rabit::Tool::FleetCheck
