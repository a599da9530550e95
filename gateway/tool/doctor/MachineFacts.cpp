#include "doctor/MachineFacts.h"

#include <arpa/inet.h>
#include <ifaddrs.h>
#include <net/if.h>

#include <algorithm>
#include <charconv>
#include <fstream>
#include <sstream>
#include <string_view>

namespace Rabit::Tool::Doctor
{
namespace
{

std::string TextOf(const std::string &file)
{
    std::ifstream stream(file);
    std::ostringstream text;
    text << stream.rdbuf();
    return text.str();
}

std::vector<std::string> WordsOf(const std::string &line)
{
    std::istringstream stream(line);
    std::vector<std::string> words;
    for (std::string word; stream >> word;)
    {
        words.push_back(word);
    }
    return words;
}

std::optional<std::uint64_t> NumberIn(std::string_view text, int base = 10)
{
    std::uint64_t number = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number, base);
    return error == std::errc() && end != text.data() ? std::optional(number) : std::nullopt;
}

std::vector<Interface> Interfaces()
{
    std::map<std::string, Interface> found;
    ifaddrs *list = nullptr;
    if (::getifaddrs(&list) != 0)
    {
        return {};
    }
    for (const ifaddrs *entry = list; entry != nullptr; entry = entry->ifa_next)
    {
        Interface &one = found[entry->ifa_name];
        one.Name = entry->ifa_name;
        one.IsUp = (entry->ifa_flags & IFF_UP) != 0 && (entry->ifa_flags & IFF_RUNNING) != 0;
        one.HasMulticast = (entry->ifa_flags & IFF_MULTICAST) != 0;
        one.IsLoopback = (entry->ifa_flags & IFF_LOOPBACK) != 0;
        if (entry->ifa_addr != nullptr && entry->ifa_addr->sa_family == AF_INET)
        {
            char text[INET_ADDRSTRLEN] = "";
            const auto *address = reinterpret_cast<const sockaddr_in *>(entry->ifa_addr);
            ::inet_ntop(AF_INET, &address->sin_addr, text, sizeof text);
            one.Addresses.emplace_back(text);
        }
    }
    ::freeifaddrs(list);
    std::vector<Interface> interfaces;
    for (auto &[name, one] : found)
    {
        one.Index = static_cast<int>(::if_nametoindex(name.c_str()));
        one.Mtu = static_cast<unsigned>(NumberIn(TextOf("/sys/class/net/" + name + "/mtu")).value_or(0));
        interfaces.push_back(std::move(one));
    }
    return interfaces;
}

}  // namespace

// Reads the two lines that begin with `Udp:`, the names and the numbers.
UdpCounters UdpCountersIn(const std::string &snmp)
{
    UdpCounters counters;
    std::vector<std::string> names;
    std::istringstream stream(snmp);
    for (std::string line; std::getline(stream, line);)
    {
        const std::vector<std::string> words = WordsOf(line);
        if (words.empty() || words[0] != "Udp:")
        {
            continue;
        }
        if (names.empty())
        {
            names = words;
            continue;
        }
        for (std::size_t i = 1; i < std::min(names.size(), words.size()); ++i)
        {
            const std::uint64_t number = NumberIn(words[i]).value_or(0);
            counters.NoRoom = names[i] == "RcvbufErrors" ? number : counters.NoRoom;
            counters.NotSent = names[i] == "SndbufErrors" ? number : counters.NotSent;
        }
        break;
    }
    return counters;
}

// Reads lines of `sl local_address ... drops`, the address as hexadecimal `ADDRESS:PORT`.
std::map<int, std::uint64_t> DropsIn(const std::string &udp)
{
    constexpr std::size_t columns = 13;
    std::map<int, std::uint64_t> drops;
    std::istringstream stream(udp);
    for (std::string line; std::getline(stream, line);)
    {
        const std::vector<std::string> words = WordsOf(line);
        const std::size_t colon = words.size() < columns ? std::string::npos : words[1].find(':');
        const auto port = colon == std::string::npos
                              ? std::nullopt
                              : NumberIn(std::string_view(words[1]).substr(colon + 1), 16);
        const auto count = words.size() < columns ? std::nullopt : NumberIn(words.back());
        if (port && count && *port <= 65535 && *count > 0)
        {
            drops[static_cast<int>(*port)] += *count;
        }
    }
    return drops;
}

MachineFacts LookAtMachine()
{
    MachineFacts facts;
    facts.Interfaces = Interfaces();
    facts.LargestReceiveBuffer = NumberIn(TextOf("/proc/sys/net/core/rmem_max"));
    facts.Udp = UdpCountersIn(TextOf("/proc/net/snmp"));
    facts.DropsOfPorts = DropsIn(TextOf("/proc/net/udp"));
    return facts;
}

}  // namespace Rabit::Tool::Doctor
