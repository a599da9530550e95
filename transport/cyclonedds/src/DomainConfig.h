#pragma once

#include <rabit/transport/Transport.h>

#include <string>

namespace Rabit::Cyclone
{

// The settings as the vendor's configuration text, TransportSettings::BackendConfig laid over them. Throws
// TransportError if an interface or peer does not resolve, or the file cannot be read.
std::string MakeDomainConfig(const TransportSettings &settings);

}  // namespace Rabit::Cyclone
