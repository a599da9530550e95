// Which of a host's networks a session is to use, and what is wrong with the others that it was told to use.
//
// A network is usable if its interface is up and has a carrier and an IPv4 address. One that nobody named
// must also be capable of multicast, unless multicast is off or there are peers to look for by unicast; and
// loopback is used only if it is named, or if there is no other.
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

// What the settings ask for, of all the networks of the host; `most`: the backend uses no more.
NetworkChoice ChooseNetworks(const std::vector<HostNetwork> &host, const TransportSettings &settings,
                             std::size_t most);

}  // namespace Rabit
