#pragma once

#include <rabit/transport/Transport.h>

#include <string>

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

}  // namespace Rabit::Cyclone
