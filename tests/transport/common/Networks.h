// Networks of a host, as tests describe them.
#pragma once

#include <string>

#include "common/HostNetworks.h"

namespace Rabit
{

inline HostNetwork Network(unsigned index, const std::string &name, const std::string &address)
{
    HostNetwork network;
    network.Index = index;
    network.Interface = name;
    network.Label = name;
    network.Address = address;
    network.Mask = 0xffffff00;
    network.Up = true;
    network.Running = true;
    network.Multicast = true;
    return network;
}

inline HostNetwork Loopback()
{
    HostNetwork network = Network(1, "lo", "127.0.0.1");
    network.Mask = 0xff000000;
    network.Multicast = false;
    network.Loopback = true;
    return network;
}

inline HostNetwork WithoutCarrier(HostNetwork network)
{
    network.Running = false;
    return network;
}

inline HostNetwork SwitchedOff(HostNetwork network)
{
    network.Up = false;
    network.Running = false;
    return network;
}

inline HostNetwork WithoutMulticast(HostNetwork network)
{
    network.Multicast = false;
    return network;
}

}  // namespace Rabit
