#include "common/NetworkChoice.h"

#include <algorithm>
#include <iterator>

namespace Rabit
{

namespace
{

bool CanBeUsed(const HostNetwork &network)
{
    return network.Running && !network.Address.empty();
}

SettingsProblem ProblemOf(const std::string &interface, const std::string &what)
{
    return {"interfaces", interface, "the interface " + interface + " " + what, false};
}

// Says why no network of that name is usable.
SettingsProblem WhyNot(const std::string &name, const std::vector<HostNetwork> &host)
{
    const auto found = std::find_if(host.begin(), host.end(),
                                    [&](const HostNetwork &network) { return network.IsCalled(name); });
    if (found == host.end())
    {
        return ProblemOf(name, "does not exist: waiting for it");
    }
    if (!found->Up)
    {
        return ProblemOf(name, "is down: waiting for it");
    }
    if (!found->Running)
    {
        return ProblemOf(name, "has no carrier: waiting for it");
    }
    return ProblemOf(name, "has no IPv4 address: waiting for one");
}

void ChooseNamed(const std::vector<HostNetwork> &host, const std::vector<std::string> &names,
                 NetworkChoice &choice)
{
    for (const std::string &name : names)
    {
        const auto fits = [&](const HostNetwork &network)
        { return network.IsCalled(name) && CanBeUsed(network); };
        if (std::none_of(host.begin(), host.end(), fits))
        {
            choice.Problems.push_back(WhyNot(name, host));
        }
    }
    const auto isNamed = [&](const HostNetwork &network)
    {
        return CanBeUsed(network) &&
               std::any_of(names.begin(), names.end(),
                           [&](const std::string &name) { return network.IsCalled(name); });
    };
    std::copy_if(host.begin(), host.end(), std::back_inserter(choice.Usable), isNamed);
}

void ChooseAll(const std::vector<HostNetwork> &host, const TransportSettings &settings, NetworkChoice &choice)
{
    const bool byMulticastAlone = settings.Multicast && settings.Peers.empty();
    const auto fits = [&](const HostNetwork &network)
    { return CanBeUsed(network) && !network.Loopback && (network.Multicast || !byMulticastAlone); };
    std::copy_if(host.begin(), host.end(), std::back_inserter(choice.Usable), fits);
    if (choice.Usable.empty())
    {
        const auto isLoopback = [](const HostNetwork &network)
        { return CanBeUsed(network) && network.Loopback; };
        std::copy_if(host.begin(), host.end(), std::back_inserter(choice.Usable), isLoopback);
    }
}

}  // namespace

NetworkChoice ChooseNetworks(const std::vector<HostNetwork> &host, const TransportSettings &settings,
                             std::size_t most)
{
    NetworkChoice choice;
    if (settings.Interfaces.empty())
    {
        ChooseAll(host, settings, choice);
    }
    else
    {
        ChooseNamed(host, settings.Interfaces, choice);
    }
    for (; choice.Usable.size() > most; choice.Usable.pop_back())
    {
        choice.Problems.push_back(
            ProblemOf(choice.Usable.back().Label, "is not used, because the backend takes at most " +
                                                      std::to_string(most) + ": name those that matter"));
    }
    return choice;
}

}  // namespace Rabit
