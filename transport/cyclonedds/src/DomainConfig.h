#pragma once

#include <rabit/transport/Transport.h>

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "guard/RtpsGuard.h"

namespace Rabit::Cyclone
{

// Returns the vendor's configuration text for the settings, overridden by TransportSettings::BackendConfig.
// Interfaces, and the hosts of Peers, are addresses. `added`: the bytes by which a seal may lengthen a
// datagram; if there is a seal, the domain is deaf at first. Throws TransportError, as all functions here do
// that get the file, if it cannot be read.
std::string MakeDomainConfig(const TransportSettings &settings, std::size_t added);

// The ports at which the first `count` participants of one host and domain take discovery data.
std::vector<std::uint16_t> UsualDiscoveryPorts(int domain, int count);

// True if a configuration file is given and names interfaces. They then replace our list: the vendor would
// join the two and refuse an interface that is in both.
bool HasOwnInterfaces(const std::string &configFile);

// How much of received datagrams is checked: less if a configuration file enables shared memory.
Rtps::RtpsGuard::Mode GuardMode(const TransportSettings &settings);

}  // namespace Rabit::Cyclone
