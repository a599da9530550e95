#include "doctor/NetworkChecks.h"

#include <rabit/base/NaturalOrder.h>

#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <iterator>
#include <utility>

#include "doctor/MachineChecks.h"
#include "doctor/RtpsCall.h"

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

std::set<std::uint32_t> SealedSessionsIn(const NetworkFacts &facts, int domain)
{
    std::set<std::uint32_t> sessions;
    if (const auto found = facts.Domains.find(domain); found != facts.Domains.end())
    {
        for (const auto &[address, of] : found->second)
        {
            sessions.insert(of.SealedSessions.begin(), of.SealedSessions.end());
        }
    }
    return sessions;
}

// Leaves out this machine's addresses, unless there are no others.
void PreferOthers(std::set<std::string> &addresses, const std::vector<Interface> &used)
{
    std::set<std::string> others = addresses;
    for (const Interface &one : used)
    {
        for (const std::string &own : one.Addresses)
        {
            others.erase(own);
        }
    }
    if (!others.empty())
    {
        addresses = std::move(others);
    }
}

}  // namespace

std::size_t OwnSealedSessions(const GatewayConfig &config)
{
    const std::vector<GatewayConfig> paths = PathConfigsOf(config);
    return static_cast<std::size_t>(std::count_if(
        paths.begin(), paths.end(), [](const GatewayConfig &path) { return path.Security.has_value(); }));
}

bool IsNodeHeard(const NetworkFacts &facts, int domain, std::size_t ownSealedSessions)
{
    const auto found = facts.Domains.find(domain);
    return found != facts.Domains.end() &&
           (std::any_of(found->second.begin(), found->second.end(),
                        [](const auto &voice) { return voice.second.AreNodes; }) ||
            SealedSessionsIn(facts, domain).size() > ownSealedSessions);
}

void NameRosPrograms(const RosNodes::Names &programs, NetworkFacts &facts)
{
    const auto addNames = [&programs](std::set<std::string> &labels)
    {
        for (const auto &[prefix, nodes] : programs)
        {
            if (labels.erase(LabelOfRos(prefix, {})) > 0)
            {
                labels.insert(LabelOfRos(prefix, nodes));
            }
        }
    };
    for (auto &[domain, voices] : facts.Domains)
    {
        for (auto &[address, of] : voices)
        {
            addNames(of.Names);
        }
    }
    addNames(facts.OnLoopbackAlone);
}

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
        // Nodes with keys answer none without.
        const bool hasKeys = SomePathHasKeys(config);
        const std::string silence = hasKeys ? "; nobody without keys answered" : "; nobody answered";
        const bool isGood = hasKeys || !trial.AnsweredFrom.empty();
        findings.push_back(
            {isGood ? Level::Good : Level::Note, subject,
             "it goes out" + (others.empty() ? "" : ", and comes in on " + Listed(others)) +
                 (trial.AnsweredFrom.empty() ? silence : "; answered by " + Listed(trial.AnsweredFrom)) +
                 (trial.HeardFrom.empty() ? "" : "; heard from " + Listed(trial.HeardFrom)),
             !isGood && trial.HeardFrom.empty() ? "if others should be there: docs/how_to/connect.md" : ""});
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

std::vector<Finding> OfLoopback(const GatewayConfig &config, const std::vector<Interface> &used,
                                const NetworkFacts &facts)
{
    const std::set<std::string> &alone = facts.OnLoopbackAlone;
    const auto isLoopback = [](const std::string &peer)
    { return peer.rfind("127.", 0) == 0 || peer == "localhost"; };
    if (alone.empty() || std::any_of(config.Peers.begin(), config.Peers.end(), isLoopback))
    {
        return {};
    }
    const bool isMeant = !used.empty() && std::all_of(used.begin(), used.end(),
                                                      [](const Interface &one) { return one.IsLoopback; });
    const bool isOne = alone.size() == 1;
    return {{isMeant ? Level::Problem : Level::Note, "this machine alone",
             Listed(alone) + (isOne ? " is" : " are") + " in domain " + std::to_string(config.Domain) +
                 " on this machine, and " + (isOne ? "takes" : "take") +
                 " no multicast: nodes without `peers` do not meet " + (isOne ? "it" : "them"),
             "list 127.0.0.1 in `peers`, with lo among the `interfaces`; or start programs of ROS 2 with "
             "ROS_AUTOMATIC_DISCOVERY_RANGE=SUBNET"}};
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
            if (!of.SealedSessions.empty())
            {
                names.insert("a node with keys");
            }
            addresses.insert(address);
            areNodes = areNodes || of.AreNodes || !of.SealedSessions.empty();
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
                    [&](const auto &domain)
                    {
                        const bool isOurs = domain.first == config.Domain;
                        return IsNodeHeard(facts, domain.first, isOurs ? OwnSealedSessions(config) : 0);
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

std::vector<Finding> OfKeys(const GatewayConfig &config, const std::vector<Interface> &used,
                            const NetworkFacts &facts, bool anyNode)
{
    std::set<std::string> addresses;
    std::set<std::string> without;
    if (const auto ours = facts.Domains.find(config.Domain); ours != facts.Domains.end())
    {
        for (const auto &[address, of] : ours->second)
        {
            if (!of.SealedSessions.empty())
            {
                addresses.insert(address);
            }
            without.insert(of.Names.begin(), of.Names.end());
        }
    }
    const std::string domain = " in domain " + std::to_string(config.Domain);
    const bool hasKeys = SomePathHasKeys(config);
    std::vector<Finding> findings;
    if (!addresses.empty() && !hasKeys)
    {
        findings.push_back(
            {Level::Problem, "keys",
             "nodes at " + Listed(addresses) + domain + " have keys, and this program has none: it stays out",
             "--keys FOLDER; `rabit keys add laptop --tool` makes one where the fleet's keys are"});
    }
    // This program hears its own sessions as well.
    const std::size_t sessions = SealedSessionsIn(facts, config.Domain).size();
    if (hasKeys && sessions > OwnSealedSessions(config) && !anyNode)
    {
        PreferOthers(addresses, used);
        findings.push_back({Level::Problem, "keys",
                            "nodes at " + Listed(addresses) + domain +
                                " have keys, and none is heard with the keys of this program",
                            "keys of the same fleet, with its newest bulletin and not revoked: "
                            "`rabit keys check`"});
    }
    if (!without.empty() && hasKeys)
    {
        findings.push_back({Level::Note, "keys",
                            Listed(without) + domain + (without.size() == 1 ? " has" : " have") +
                                " no keys: what it says is not heard",
                            "`rabit keys add`, if it belongs to this fleet"});
    }
    return findings;
}

}  // namespace Rabit::Tool::Doctor
