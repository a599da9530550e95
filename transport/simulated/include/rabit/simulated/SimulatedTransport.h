#pragma once

#include <rabit/simulated/SimulatedNetwork.h>
#include <rabit/transport/Transport.h>

#include <memory>
#include <string>

namespace Rabit
{

// The backend for tests: its sessions communicate over a SimulatedNetwork. Handlers run only inside
// SimulatedNetwork::AdvanceTo, on the thread that calls it.
//
// It uses these settings: Node, Incarnation, Domain, MaxDatagram, Multicast, Peers, Lease, Memory,
// AnnouncementPeriod, Member and Log. Samples are limited to 64 MiB, as with Fast DDS.
//
// With a Member, each datagram takes the bytes that its seal adds, and arrives only where the seal opens. The
// random bytes of the seal follow from the network's seed. SimulatedKeys.h makes members.
class SimulatedTransport final : public Transport
{
public:
    explicit SimulatedTransport(const SimulatedNetwork &network);
    // `simulated`
    std::string Name() const override;
    bool IsStepped() const override { return true; }
    std::unique_ptr<TransportSession> Open(const TransportSettings &settings, PeerHandler onPeer) override;
    std::vector<SettingsProblem> Check(const TransportSettings &settings) const override;

private:
    const std::shared_ptr<Simulated::NetworkCore> _core;
};

}  // namespace Rabit
