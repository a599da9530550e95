#pragma once

#include <rabit/transport/Transport.h>

#include <memory>
#include <string>

namespace Rabit
{

// The backend on Eclipse Cyclone DDS 0.10 (RTPS over UDPv4). Samples are limited to 64 MiB. Handlers run on a
// thread of the session.
//
// Cyclone DDS has one configuration per process and domain: sessions of one process in one domain must agree
// on their network settings, else Open throws. TransportSettings::BackendConfig is a Cyclone DDS XML file; it
// is laid over the other settings.
class CycloneDdsTransport final : public Transport
{
public:
    // `cyclonedds`
    std::string Name() const override;
    std::unique_ptr<TransportSession> Open(const TransportSettings &settings, PeerHandler onPeer) override;
};

}  // namespace Rabit
