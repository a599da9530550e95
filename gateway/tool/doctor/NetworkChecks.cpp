#include "doctor/NetworkChecks.h"

#include <rabit/base/NaturalOrder.h>

#include <algorithm>
#include <cstdio>
#include <iterator>

#include "doctor/MachineChecks.h"

namespace Rabit::Tool::Doctor
{
namespace
{

std::string Listed(const std::set<std::string> &list)
{
    constexpr std::size_t most = 8;
    std::string text;
    std::size_t count = 0;
    for (const std::string &entry : std::set<std::string, NaturalOrder>(list.begin(), list.end()))
    {
        if (++count <= most)
        {
            text += (text.empty() ? "" : ", ") + entry;
        }
    }
    return text + (count > most ? " and " + std::to_string(count - most) + " more" : "");
}

// Those of the interfaces that belong to a path with multicast.
std::vector<Interface> WithMulticast(const GatewayConfig &config, const std::vector<Interface> &used)
{
    if (config.Paths.empty())
    {
        return config.Multicast ? used : std::vector<Interface>();
    }
    GatewayConfig with = config;
    with.Paths.erase(std::remove_if(with.Paths.begin(), with.Paths.end(),
                                    [](const PathRule &path) { return !path.Multicast; }),
                     with.Paths.end());
    return with.Paths.empty() ? std::vector<Interface>() : UsedBy(with, used);
}

}  // namespace

std::vector<Finding> OfMulticast(const GatewayConfig &config, const std::vector<Interface> &used,
                                 const NetworkFacts &facts, const std::set<std::string> &heardBy)
{
    std::vector<Finding> findings;
    for (const Interface &one : WithMulticast(config, used))
    {
        const auto found = facts.Trials.find(one.Name);
        if (found == facts.Trials.end())
        {
            continue;
        }
        const MulticastTrial &trial = found->second;
        const std::string subject = "multicast on " + one.Name;
        if (!trial.Error.empty())
        {
            findings.push_back({one.IsLoopback && used.size() > 1 ? Level::Note : Level::Problem, subject,
                                "it cannot be sent: " + trial.Error,
                                one.HasMulticast ? "ip route add 224.0.0.0/4 dev " + one.Name
                                                 : "ip link set " + one.Name + " multicast on"});
            continue;
        }
        if (!trial.HeardOn.contains(one.Name))
        {
            findings.push_back({Level::Problem, subject,
                                "what is sent there does not come back to this machine",
                                "let UDP to 239.255.0.1 through the firewall (nft list ruleset)"});
            continue;
        }
        std::set<std::string> silent;
        std::set_difference(trial.HeardFrom.begin(), trial.HeardFrom.end(), trial.AnsweredFrom.begin(),
                            trial.AnsweredFrom.end(), std::inserter(silent, silent.begin()));
        if (const auto ours = facts.Domains.find(config.Domain); ours != facts.Domains.end())
        {
            for (const auto &[address, of] : ours->second)
            {
                if (std::any_of(of.Names.begin(), of.Names.end(),
                                [&heardBy](const std::string &name) { return heardBy.contains(name); }))
                {
                    silent.erase(address);
                }
            }
        }
        if (!silent.empty())
        {
            findings.push_back(
                {Level::Problem, subject,
                 Listed(silent) + (silent.size() == 1 ? " is" : " are") +
                     " heard, and did not answer: multicast from here does not get there, or the answer "
                     "does not get back",
                 "look at the firewalls of both and at the access point; or list peers in both"});
        }
        std::set<std::string> others = trial.HeardOn;
        others.erase(one.Name);
        findings.push_back({trial.AnsweredFrom.empty() ? Level::Note : Level::Good, subject,
                            "it goes out" + (others.empty() ? "" : ", and comes in on " + Listed(others)) +
                                (trial.AnsweredFrom.empty() ? std::string("; nobody answered")
                                                            : "; answered by " + Listed(trial.AnsweredFrom)) +
                                (trial.HeardFrom.empty() ? "" : "; heard from " + Listed(trial.HeardFrom)),
                            trial.AnsweredFrom.empty() && trial.HeardFrom.empty()
                                ? "if others should be there: docs/how_to/connect.md"
                                : ""});
    }
    return findings;
}

std::vector<Finding> OfOtherParticipants(const GatewayConfig &config, const NetworkFacts &facts,
                                         const std::set<std::string> &nodes)
{
    std::set<std::string> others;
    if (const auto ours = facts.Domains.find(config.Domain); ours != facts.Domains.end())
    {
        for (const auto &[address, of] : ours->second)
        {
            std::set_difference(of.Names.begin(), of.Names.end(), nodes.begin(), nodes.end(),
                                std::inserter(others, others.end()));
        }
    }
    if (others.empty())
    {
        return {};
    }
    return {{Level::Note, "participants",
             Listed(others) + (others.size() == 1 ? " is" : " are") + " heard in domain " +
                 std::to_string(config.Domain) +
                 " and not among the nodes: other DDS programs and tools, or nodes whose beats do not come",
             "nothing, unless a node is among them: docs/how_to/connect.md"}};
}

std::vector<Finding> OfDomains(const GatewayConfig &config, const NetworkFacts &facts, bool anyNode)
{
    std::vector<Finding> findings;
    for (const auto &[domain, voices] : facts.Domains)
    {
        if (domain == config.Domain)
        {
            continue;
        }
        std::set<std::string> names;
        std::set<std::string> addresses;
        bool areNodes = false;
        for (const auto &[address, of] : voices)
        {
            names.insert(of.Names.begin(), of.Names.end());
            addresses.insert(address);
            areNodes = areNodes || of.AreNodes;
        }
        if (names.empty())
        {
            continue;
        }
        const bool isMeant = areNodes && !anyNode;
        findings.push_back(
            {isMeant ? Level::Problem : Level::Note, "domain " + std::to_string(domain),
             Listed(names) + (names.size() == 1 ? " is" : " are") + " in it, at " + Listed(addresses) +
                 (isMeant ? ", and nobody in domain " + std::to_string(config.Domain) : ""),
             isMeant ? "--domain " + std::to_string(domain) + ", or the same `domain` in all files"
                     : "the same `domain` in all files, if they belong to this fleet"});
    }
    return findings;
}

std::vector<Finding> OfSilentDomains(const GatewayConfig &config, const NetworkFacts &facts, bool anyNode,
                                     int asked, double seconds)
{
    const bool isFound =
        std::any_of(facts.Domains.begin(), facts.Domains.end(),
                    [](const auto &domain)
                    {
                        return std::any_of(domain.second.begin(), domain.second.end(),
                                           [](const auto &voice) { return voice.second.AreNodes; });
                    });
    if (anyNode || isFound)
    {
        return {};
    }
    const std::string ours = config.Domain < asked ? "" : " and " + std::to_string(config.Domain);
    char text[200];
    std::snprintf(text, sizeof text,
                  "no node is in domains 0 to %d%s; the other domains were only listened to, for %g s, and a "
                  "node may announce itself every 10 s, with a budget every 30 s",
                  asked - 1, ours.c_str(), seconds);
    return {{Level::Note, "other domains", text, "--wait 35, to hear all that are there"}};
}

std::vector<Finding> OfOtherInterfaces(const GatewayConfig &config, const std::vector<Interface> &used,
                                       const NetworkFacts &facts, bool anyNode)
{
    std::vector<Finding> findings;
    const auto ours = facts.Elsewhere.find(config.Domain);
    if (ours == facts.Elsewhere.end())
    {
        return findings;
    }
    std::set<std::string> names;
    for (const Interface &one : used)
    {
        names.insert(one.Name);
    }
    for (const auto &[interface, addresses] : ours->second)
    {
        findings.push_back(
            {anyNode ? Level::Note : Level::Problem, "interface " + interface,
             Listed(addresses) + (addresses.size() == 1 ? " is" : " are") + " heard there in domain " +
                 std::to_string(config.Domain) + ", and cannot be reached: only " + Listed(names) +
                 (names.size() == 1 ? " is used" : " are used"),
             "--interface " + interface +
                 ", and `interfaces` of the nodes; or the other program's interfaces, if it is "
                 "of this fleet"});
    }
    return findings;
}

std::vector<Finding> OfKeys(const GatewayConfig &config, const NetworkFacts &facts,
                            const std::set<std::string> &heard)
{
    std::set<std::string> with;
    std::set<std::string> without;
    if (const auto ours = facts.Domains.find(config.Domain); ours != facts.Domains.end())
    {
        for (const auto &[address, of] : ours->second)
        {
            with.insert(of.WithKeys.begin(), of.WithKeys.end());
            std::set_difference(of.Names.begin(), of.Names.end(), of.WithKeys.begin(), of.WithKeys.end(),
                                std::inserter(without, without.end()));
        }
    }
    const std::string there = " in domain " + std::to_string(config.Domain);
    // `heard` never has plain DDS programs.
    const std::set<std::string> nodes = heard.empty() ? with : NodesWithKeys(config.Domain, facts);
    std::set<std::string> out;
    std::set_difference(nodes.begin(), nodes.end(), heard.begin(), heard.end(),
                        std::inserter(out, out.end()));
    std::vector<Finding> findings;
    if (!with.empty() && !config.Security)
    {
        findings.push_back(
            {Level::Problem, "keys",
             Listed(with) + there + (with.size() == 1 ? " has keys" : " have keys") +
                 ", and this program has none: it stays out",
             "--keys FOLDER; `rabit keys add laptop --tool` makes one where the fleet's keys are"});
    }
    if (!out.empty() && config.Security)
    {
        const bool one = out.size() == 1;
        findings.push_back({Level::Problem, "keys",
                            Listed(out) + there + (one ? " has keys, and does" : " have keys, and do") +
                                " not let this program in",
                            "keys of the same fleet, neither ended nor revoked, and the same level; " +
                                std::string(one ? "its" : "their") + " log says why"});
    }
    if (!without.empty() && config.Security)
    {
        findings.push_back({Level::Note, "keys",
                            Listed(without) + there + (without.size() == 1 ? " has" : " have") +
                                " no keys: what it says is not heard",
                            "`rabit keys add`, if it belongs to this fleet"});
    }
    return findings;
}

std::set<std::string> NodesWithKeys(int domain, const NetworkFacts &facts)
{
    std::set<std::string> names;
    if (const auto ours = facts.Domains.find(domain); ours != facts.Domains.end())
    {
        for (const auto &[address, of] : ours->second)
        {
            names.insert(of.NodesWithKeys.begin(), of.NodesWithKeys.end());
        }
    }
    return names;
}

}  // namespace Rabit::Tool::Doctor
