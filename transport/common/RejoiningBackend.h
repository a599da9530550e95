// The part of a session that a backend on a vendor's DDS implements; RejoiningSession does the rest.
#pragma once

#include <rabit/transport/Transport.h>

#include <cstddef>
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include "common/PeerPlace.h"
#include "common/SessionContext.h"

namespace Rabit
{

class BackendSession
{
public:
    // Closes. All writers and readers must be gone.
    virtual ~BackendSession() = default;
    // As in TransportSession, for topics and QoS that were checked.
    virtual std::unique_ptr<TransportWriter> CreateWriter(const TopicDescription &topic, const TopicQos &qos,
                                                          const std::vector<std::string> &partitions) = 0;
    virtual std::unique_ptr<TransportReader> CreateReader(const TopicDescription &topic, const TopicQos &qos,
                                                          const std::vector<std::string> &partitions,
                                                          SampleHandler handler) = 0;
    // The addresses of each Rabit session that it knows now. Any thread.
    virtual std::vector<PeerPlace> PeerPlaces() const = 0;
    // Problems of the network that it has now: hosts whose programs are refused something for some time
    // (Ledger.h), more endpoints than other nodes are told of (rtps/Meeting.h). Any thread.
    virtual std::vector<SettingsProblem> Problems() const { return {}; }
};

class RejoiningBackend
{
public:
    virtual ~RejoiningBackend() = default;
    // Joins the network. In `settings`, Interfaces are addresses of this host, and empty only if
    // FindsNetworks(); Peers are `address` or `address:port`. Throws TransportError.
    virtual std::unique_ptr<BackendSession> Open(const TransportSettings &settings,
                                                 const SessionContext &context) = 0;
    // Throws TransportError if TransportSettings::BackendConfig cannot be read, or if the vendor refuses it,
    // as far as that can be told without joining the network.
    virtual void CheckConfig(const TransportSettings &settings) const = 0;
    // True if TransportSettings::BackendConfig chooses the networks, which makes Interfaces meaningless.
    // Throws TransportError if it cannot be read.
    virtual bool HasOwnNetworks(const TransportSettings &settings) const = 0;
    // True if the vendor uses all networks of the host, loopback included, where no interface is named.
    virtual bool FindsNetworks() const = 0;
    // True if the vendor sends to only one of a peer's addresses. Where this host has the same address on
    // another network, such a datagram would reach this host instead of the peer.
    virtual bool IsMisledByDuplicates() const = 0;
    // Number of networks that one session can use.
    virtual std::size_t MostNetworks() const { return std::numeric_limits<std::size_t>::max(); }
};

}  // namespace Rabit
