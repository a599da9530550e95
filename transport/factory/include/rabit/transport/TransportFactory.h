#pragma once

#include <rabit/transport/Transport.h>

#include <memory>
#include <string>
#include <vector>

namespace Rabit
{

// The backends by name, for programs that take theirs from a configuration. Only main() programs link this
// (Rabit::Transports): it pulls in every backend that was built.

// The backend that a configuration calls `name`, for instance `fastdds`. Throws TransportError if there is
// none: it names those that were built, and the build's option if the backend was left out. The simulated
// transport is not among them: it has no network of its own.
std::unique_ptr<Transport> MakeTransport(const std::string &name);

// The names that MakeTransport knows, in alphabetical order; depends on the options RABIT_WITH_FASTDDS and
// RABIT_WITH_CYCLONEDDS of the build.
std::vector<std::string> AvailableTransports();

// The same, and those that other builds may have.
std::vector<std::string> KnownTransports();

}  // namespace Rabit
