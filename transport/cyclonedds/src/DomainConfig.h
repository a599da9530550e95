#pragma once

#include <rabit/transport/Transport.h>

#include <string>

#include "guard/RtpsGuard.h"

namespace Rabit::Cyclone
{

// The settings as the vendor's configuration text, TransportSettings::BackendConfig laid over them.
// Interfaces are addresses of this host, and so are the hosts of Peers. Throws TransportError if the file
// cannot be read.
std::string MakeDomainConfig(const TransportSettings &settings);

// Whether a configuration file, if there is one, names interfaces, which then takes the place of our list:
// the vendor would add the two and refuse an interface that is in both. Throws TransportError if it cannot be
// read.
bool HasOwnInterfaces(const std::string &configFile);

// What of the network's datagrams is checked: less if a configuration file switches DDS Security on, which
// does that better, or shared memory. Throws TransportError if it cannot be read.
Rtps::RtpsGuard::Mode GuardMode(const TransportSettings &settings);

}  // namespace Rabit::Cyclone
