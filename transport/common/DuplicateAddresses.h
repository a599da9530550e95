// Networks of this host whose address another host also has, on a network of its own: the same fixed address
// inside every vehicle, the same container bridge on every computer.
#pragma once

#include <string>
#include <vector>

#include "common/HostNetworks.h"
#include "common/PeerPlace.h"

namespace Rabit
{

// Remembers a duplicate as long as this host has the address: a peer that also noticed it stops announcing
// it. Pure.
class DuplicateAddresses
{
public:
    // Takes the networks and peers of now. A peer is on another host if it has an address that is not this
    // host's, on another of the usable networks.
    void Look(const std::vector<HostNetwork> &usable, const std::vector<PeerPlace> &peers);
    bool Has(const HostNetwork &network) const;

private:
    std::vector<HostNetwork> _found;
};

}  // namespace Rabit
