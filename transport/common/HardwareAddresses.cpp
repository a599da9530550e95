#include "common/HardwareAddresses.h"

#include <cstdio>
#include <fstream>
#include <iterator>
#include <sstream>
#include <utility>

namespace Rabit
{
namespace
{

// ATF_COM of <net/if_arp.h>: the entry has a hardware address.
constexpr unsigned HasAddress = 0x02;
// ATF_PUBL: the computer answers requests for the host's address in place of the host (proxy ARP).
constexpr unsigned IsProxy = 0x08;

// Addresses of this computer and of groups.
bool NeedsNoAddress(const HardwareAddresses::Host &host)
{
    return host[0] == 127 || host[0] >= 224;
}

}  // namespace

std::string HardwareAddresses::OfKernel()
{
    std::ifstream table("/proc/net/arp");
    return {std::istreambuf_iterator<char>(table), {}};
}

bool HardwareAddresses::IsAwaited(const Host &host, TimePoint now)
{
    if (NeedsNoAddress(host))
    {
        return false;
    }
    const std::lock_guard lock(_mutex);
    if (!_readAt || now - *_readAt >= RereadAfter(host, now))
    {
        Refresh(now);
    }
    return _awaited.contains(host);
}

HardwareAddresses::Duration HardwareAddresses::RereadAfter(const Host &host, TimePoint now)
{
    if (_known.contains(host))
    {
        return Known;
    }
    if (_awaited.contains(host))
    {
        return Unknown;
    }
    const TimePoint *const since = _absent.Find(host);
    if (since == nullptr)
    {
        _absent.Put(host, now);
    }
    return since == nullptr || now - *since < NewFor ? Unknown : Known;
}

bool HardwareAddresses::HasToAsk(const Host &host, TimePoint now)
{
    const std::lock_guard lock(_mutex);
    const auto awaited = _awaited.find(host);
    if (awaited == _awaited.end() || (awaited->second && now - *awaited->second < AskAgain))
    {
        return awaited == _awaited.end();
    }
    awaited->second = now;
    return true;
}

// A host may have an entry for each of several interfaces. One address is enough.
void HardwareAddresses::Refresh(TimePoint now)
{
    _readAt = now;
    _known.clear();
    const auto before = std::exchange(_awaited, {});
    std::istringstream table(_read());
    for (std::string line; std::getline(table, line);)
    {
        Host host{};
        unsigned flags = 0;
        if (std::sscanf(line.c_str(), "%hhu.%hhu.%hhu.%hhu %*s %x", &host[0], &host[1], &host[2], &host[3],
                        &flags) == 5 &&
            (flags & IsProxy) == 0)
        {
            _absent.Erase(host);
            if ((flags & HasAddress) != 0)
            {
                _known.insert(host);
            }
            else
            {
                const auto asked = before.find(host);
                _awaited.emplace(host, asked == before.end() ? std::nullopt : asked->second);
            }
        }
    }
    for (const Host &host : _known)
    {
        _awaited.erase(host);
    }
}

}  // namespace Rabit
