#include "doctor/MachineChecks.h"

#include <rabit/gateway/AirCost.h>

#include <algorithm>
#include <iterator>

namespace Rabit::Tool::Doctor
{
namespace
{

// Bytes that both backends ask for (ParticipantSettings.cpp, DomainConfig.cpp); the kernel grants at most
// net.core.rmem_max.
constexpr std::uint64_t WantedBuffer = 4u << 20;
constexpr std::size_t SmallestDatagram = 1000;

std::string Listed(const std::vector<std::string> &list)
{
    std::string text;
    for (const std::string &entry : list)
    {
        text += (text.empty() ? "" : ", ") + entry;
    }
    return text;
}

bool IsCalled(const Interface &one, const std::string &name)
{
    return one.Name == name ||
           std::find(one.Addresses.begin(), one.Addresses.end(), name) != one.Addresses.end();
}

bool IsOf(const GatewayConfig &path, const Interface &one)
{
    return path.Interfaces.empty() ||
           std::any_of(path.Interfaces.begin(), path.Interfaces.end(),
                       [&one](const std::string &name) { return IsCalled(one, name); });
}

// True for the ports of a domain (OMG DDSI-RTPS 2.3, 9.6.1.1).
bool IsOfDomain(int port, int domain)
{
    const int first = 7400 + 250 * domain;
    return port >= first && port < first + 250;
}

std::uint64_t DropsIn(const MachineFacts &facts, int port)
{
    const auto found = facts.DropsOfPorts.find(port);
    return found == facts.DropsOfPorts.end() ? 0 : found->second;
}

std::string RaiseAdvice()
{
    const std::string wanted = std::to_string(WantedBuffer);
    return "sysctl -w net.core.rmem_max=" + wanted + ", and start the nodes again";
}

}  // namespace

std::vector<Interface> UsedBy(const GatewayConfig &config, const std::vector<Interface> &interfaces)
{
    const std::vector<GatewayConfig> paths = PathConfigsOf(config);
    std::vector<Interface> used;
    std::copy_if(interfaces.begin(), interfaces.end(), std::back_inserter(used),
                 [&paths](const Interface &one)
                 {
                     const bool isNamed =
                         std::any_of(paths.begin(), paths.end(),
                                     [&one](const GatewayConfig &path) { return IsOf(path, one); });
                     return isNamed && one.IsUp && !one.Addresses.empty();
                 });
    return used;
}

std::vector<Interface> UnusedBy(const GatewayConfig &config, const std::vector<Interface> &interfaces)
{
    const std::vector<Interface> used = UsedBy(config, interfaces);
    std::vector<Interface> unused;
    std::copy_if(interfaces.begin(), interfaces.end(), std::back_inserter(unused),
                 [&used](const Interface &one)
                 {
                     return one.IsUp &&
                            std::none_of(used.begin(), used.end(),
                                         [&one](const Interface &other) { return other.Index == one.Index; });
                 });
    return unused;
}

std::vector<Finding> OfInterfaces(const GatewayConfig &config, const std::vector<Interface> &interfaces)
{
    std::vector<Finding> findings;
    if (!config.Paths.empty())
    {
        for (GatewayConfig &path : PathConfigsOf(config))
        {
            path.Paths.clear();
            std::vector<Finding> of = OfInterfaces(path, interfaces);
            std::move(of.begin(), of.end(), std::back_inserter(findings));
        }
        return findings;
    }
    for (const std::string &name : config.Interfaces)
    {
        const auto found = std::find_if(interfaces.begin(), interfaces.end(),
                                        [&name](const Interface &one) { return IsCalled(one, name); });
        if (found == interfaces.end())
        {
            std::vector<std::string> names;
            std::transform(interfaces.begin(), interfaces.end(), std::back_inserter(names),
                           [](const Interface &one) { return one.Name; });
            findings.push_back({Level::Problem, "interface " + name, "this machine has none",
                                "name one of " + Listed(names)});
        }
        else if (!found->IsUp || found->Addresses.empty())
        {
            findings.push_back({Level::Problem, "interface " + name,
                                found->IsUp ? "it has no IPv4 address" : "it is down, or has no carrier",
                                found->IsUp
                                    ? "give it one (ip address add)"
                                    : "ip link set " + found->Name + " up; look at the cable or the radio"});
        }
    }
    const std::vector<Interface> used = UsedBy(config, interfaces);
    for (const Interface &one : used)
    {
        findings.push_back({Level::Good, "interface " + one.Name,
                            Listed(one.Addresses) + ", MTU " + std::to_string(one.Mtu)});
        // Linux does not set the flag on loopback, yet carries multicast on it; NetworkTrial finds out if it
        // does not.
        if (config.Multicast && !one.HasMulticast && !one.IsLoopback)
        {
            findings.push_back({Level::Problem, "interface " + one.Name,
                                "it is not for multicast, by which nodes find each other",
                                "ip link set " + one.Name + " multicast on, or list peers"});
        }
    }
    const bool onlyLoopback =
        std::all_of(used.begin(), used.end(), [](const Interface &one) { return one.IsLoopback; });
    if (config.Interfaces.empty() && onlyLoopback)
    {
        findings.push_back({Level::Problem, "interfaces", "none but loopback is up with an IPv4 address",
                            "connect this machine to the network of the fleet"});
    }
    return findings;
}

std::vector<Finding> OfMtu(const GatewayConfig &config, const std::vector<Interface> &used)
{
    std::vector<Finding> findings;
    const std::size_t largest = config.MaxDatagram + AirCost::IpAndUdp;
    for (const Interface &one : used)
    {
        if (one.Mtu == 0 || largest <= one.Mtu)
        {
            continue;
        }
        const bool canFit = one.Mtu >= SmallestDatagram + AirCost::IpAndUdp;
        findings.push_back(
            {Level::Problem, "MTU of " + one.Name,
             "packets of up to " + std::to_string(largest) + " bytes do not go through in one piece where " +
                 std::to_string(one.Mtu) + " do, and one lost piece loses all",
             canFit
                 ? "max_datagram: " + std::to_string(one.Mtu - AirCost::IpAndUdp) + " in each configuration"
                 : "raise the MTU"});
    }
    return findings;
}

std::vector<Finding> OfBuffers(const GatewayConfig &config, const MachineFacts &before,
                               const MachineFacts &after)
{
    std::vector<Finding> findings;
    std::string socketsText;
    bool isOfDomain = false;
    for (const auto &[port, drops] : after.DropsOfPorts)
    {
        const std::uint64_t now = drops - std::min(drops, DropsIn(before, port));
        if (now > 0 || IsOfDomain(port, config.Domain))
        {
            isOfDomain = isOfDomain || IsOfDomain(port, config.Domain);
            socketsText += (socketsText.empty() ? "port " : ", port ") + std::to_string(port) + " " +
                           std::to_string(drops);
        }
    }
    const std::uint64_t lost = after.Udp.NoRoom - std::min(after.Udp.NoRoom, before.Udp.NoRoom);
    if (lost > 0 || isOfDomain)
    {
        findings.push_back(
            {Level::Problem, "receive buffers",
             "datagrams came faster than programs of this machine read them: " + std::to_string(lost) +
                 " while it was looked at" + (socketsText.empty() ? "" : "; by open sockets " + socketsText),
             after.LargestReceiveBuffer.value_or(WantedBuffer) < WantedBuffer
                 ? RaiseAdvice()
                 : "look what these programs do meanwhile, and what takes the processor"});
    }
    else if (after.LargestReceiveBuffer.value_or(WantedBuffer) < WantedBuffer)
    {
        findings.push_back({Level::Note, "receive buffers",
                            "they may have " + std::to_string(*after.LargestReceiveBuffer) +
                                " bytes, nodes ask for " + std::to_string(WantedBuffer) +
                                "; nothing was lost meanwhile",
                            RaiseAdvice()});
    }
    else
    {
        findings.push_back({Level::Good, "receive buffers", "nothing was lost meanwhile"});
    }
    const std::uint64_t unsent = after.Udp.NotSent - std::min(after.Udp.NotSent, before.Udp.NotSent);
    if (unsent > 0)
    {
        findings.push_back({Level::Problem, "send buffers",
                            std::to_string(unsent) + " datagrams of this machine were not sent meanwhile",
                            "more is sent than the interface takes: radio: budget, or max_rate"});
    }
    return findings;
}

}  // namespace Rabit::Tool::Doctor
