// Networks of this host whose address another host has too, on a network of its own: the same fixed address
// inside of every vehicle, the same bridge for containers on every computer.
#pragma once

#include <string>
#include <vector>

#include "common/HostNetworks.h"
#include "common/PeerPlace.h"

namespace Rabit
{

// Remembers them as long as the address is there: a peer that has noticed it too tells of it no more. Pure.
class DuplicateAddresses
{
public:
    // What is there now. A peer is on another host if it has an address of another one of these networks that
    // is not this host's.
    void Look(const std::vector<HostNetwork> &usable, const std::vector<PeerPlace> &peers);
    bool Has(const HostNetwork &network) const;

private:
    std::vector<HostNetwork> _found;
};

}  // namespace Rabit
