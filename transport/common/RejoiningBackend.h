// What a backend on a vendor's DDS does itself of a session. The rest is RejoiningSession's.
#pragma once

#include <rabit/transport/Transport.h>

#include <cstddef>
#include <limits>
#include <memory>
#include <vector>

#include "common/DiscoveryRate.h"
#include "common/PeerPlace.h"

namespace Rabit
{

class BackendSession : public TransportSession
{
public:
    // Of the Rabit nodes' sessions that it knows now. Any thread.
    virtual std::vector<PeerPlace> PeerPlaces() const = 0;
};

class RejoiningBackend
{
public:
    virtual ~RejoiningBackend() = default;
    // Joins the network. Of the settings, Interfaces are addresses that this host has; Peers are `address` or
    // `address:port`. Interfaces are empty only if FindsNetworks(). Discovery heeds `rate`.
    // Throws TransportError.
    virtual std::unique_ptr<BackendSession> Open(const TransportSettings &settings, PeerHandler onPeer,
                                                 std::shared_ptr<DiscoveryRate> rate) = 0;
    // Throws TransportError if TransportSettings::BackendConfig cannot be read, or is not accepted by the
    // vendor, as far as that can be told without joining the network.
    virtual void CheckConfig(const TransportSettings &settings) const = 0;
    // Whether the networks are those of TransportSettings::BackendConfig, which makes Interfaces meaningless.
    // Throws TransportError if it cannot be read.
    virtual bool HasOwnNetworks(const TransportSettings &settings) const = 0;
    // Whether the vendor takes all that the host has, loopback too, where no interface is named.
    virtual bool FindsNetworks() const = 0;
    // Whether the vendor sends to only one of a peer's addresses, which is this host itself if the peer has
    // it on a network that only it sees, and this host has the same on another.
    virtual bool IsMisledByDuplicates() const = 0;
    // How many networks one session can use.
    virtual std::size_t MostNetworks() const { return std::numeric_limits<std::size_t>::max(); }
};

}  // namespace Rabit
