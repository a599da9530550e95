// Decides which of a host's networks a session uses, and reports the named ones that it cannot use.
//
// A network is usable if its interface is up and has a carrier and an IPv4 address. If no interface is named,
// it must also be capable of multicast, unless multicast is off or peers are listed. Loopback is used only if
// it is named, or if there is no other.
#pragma once

#include <rabit/transport/Transport.h>

#include <cstddef>
#include <string>
#include <vector>

#include "common/HostNetworks.h"

namespace Rabit
{

struct NetworkChoice
{
    std::vector<HostNetwork> Usable;        // in the order of `host`
    std::vector<SettingsProblem> Problems;  // none of them impossible; one for each interface at fault
};

// Chooses from all the networks of the host by the settings. `most`: number of networks that the backend can
// use.
NetworkChoice ChooseNetworks(const std::vector<HostNetwork> &host, const TransportSettings &settings,
                             std::size_t most);

}  // namespace Rabit
