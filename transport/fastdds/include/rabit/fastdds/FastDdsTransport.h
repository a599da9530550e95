#pragma once

#include <rabit/transport/Transport.h>

#include <memory>
#include <string>

namespace Rabit
{

// The backend on eProsima Fast DDS (RTPS over UDPv4; shared memory on request).
//
// It uses the vendor's RTPS layer. A sample is encoded into the buffer from which it is sent, and delivered
// in the buffer in which it arrived, on the vendor's receiving thread. Samples are limited to 64 MiB.
//
// TransportSettings::BackendConfig is a Fast DDS XML profiles file; the other settings override its default
// participant profile. Transports that it defines replace ours, interfaces included.
//
// Process-wide effect: the first Open switches Fast DDS's intraprocess delivery off, which would run a
// handler inside another session's Write. Environment variables that Fast DDS itself reads stay in force.
class FastDdsTransport final : public Transport
{
public:
    // `fastdds`
    std::string Name() const override;
    // Any number of sessions may be open in one process. Thread-safe.
    std::unique_ptr<TransportSession> Open(const TransportSettings &settings, PeerHandler onPeer) override;
    std::vector<SettingsProblem> Check(const TransportSettings &settings) const override;
};

}  // namespace Rabit
