#pragma once

#include <rabit/transport/Transport.h>

#include <memory>
#include <string>
#include <vector>

namespace Rabit
{

// The backends by name, for programs that choose one in a configuration. Only main() programs link this
// (Rabit::Transports): it pulls in every backend that was built.

// Makes the backend that a configuration calls `name`, for instance `fastdds`. For an unknown name it throws
// TransportError, which lists the backends that were built, and the build option of a backend that was left
// out. The simulated transport is not among them: it has no network of its own.
std::unique_ptr<Transport> MakeTransport(const std::string &name);

// The names that MakeTransport knows, in alphabetical order; the build's options RABIT_WITH_<NAME> leave some
// out.
std::vector<std::string> AvailableTransports();

// All names of AvailableTransports, and those that other builds may have.
std::vector<std::string> KnownTransports();

}  // namespace Rabit
