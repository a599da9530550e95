#pragma once

#include "Frame.h"

#include <string>

namespace Rabit::Radio
{

// An Ethernet device in a network namespace, whose frames a program carries. It is up and has a carrier as
// long as its descriptor is open, and vanishes with the process however that ends. IPv6 is off, so that an
// unused device sends nothing.
class TapDevice
{
public:
    // `space` is a name below /run/netns, or the path of a namespace. Throws std::system_error or
    // std::invalid_argument, which name the step that failed.
    TapDevice(const std::string &space, const std::string &device, const MacAddress &address);
    ~TapDevice();
    TapDevice(const TapDevice &) = delete;
    TapDevice &operator=(const TapDevice &) = delete;

    // Reads and writes frames, without blocking. The caller closes it.
    int Release();

private:
    int _file = -1;
};

}  // namespace Rabit::Radio
