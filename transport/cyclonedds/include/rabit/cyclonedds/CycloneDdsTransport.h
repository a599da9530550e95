#pragma once

#include <rabit/transport/Transport.h>

#include <memory>
#include <string>

namespace Rabit
{

// The backend on Eclipse Cyclone DDS 0.10 (RTPS over UDPv4). Samples are limited to 64 MiB. Handlers of
// readers run on the vendor's receiving threads, peer handlers on a thread of the session.
//
// TransportSettings::BackendConfig is a Cyclone DDS XML file, which overrides the other settings. The first
// session takes the vendor's log sink (dds_set_log_sink), of which the process has one.
class CycloneDdsTransport final : public Transport
{
public:
    // `cyclonedds`
    std::string Name() const override;
    std::unique_ptr<TransportSession> Open(const TransportSettings &settings, PeerHandler onPeer) override;
    std::vector<SettingsProblem> Check(const TransportSettings &settings) const override;
};

}  // namespace Rabit
