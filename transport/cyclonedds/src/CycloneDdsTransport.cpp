#include <rabit/cyclonedds/CycloneDdsTransport.h>

#include <algorithm>
#include <utility>

#include "CycloneReader.h"
#include "CycloneWriter.h"
#include "DomainConfig.h"
#include "RemoteParticipant.h"
#include "SealedTraffic.h"
#include "SessionCore.h"
#include "VendorDomain.h"
#include "common/HostNetworks.h"
#include "common/RejoiningBackend.h"
#include "common/RejoiningSession.h"
#include "common/VendorSession.h"

namespace Rabit
{

namespace
{

using namespace Cyclone;

using CycloneSession = VendorSession<SessionCore, CycloneWriter, CycloneReader>;

class CycloneBackend final : public RejoiningBackend
{
public:
    std::unique_ptr<BackendSession> Open(const TransportSettings &settings,
                                         const SessionContext &context) override
    {
        return std::make_unique<CycloneSession>(settings, context);
    }
    void CheckConfig(const TransportSettings &settings) const override
    {
        if (settings.Member != nullptr)
        {
            CheckSealable(settings);
        }
        if (!settings.BackendConfig.empty())
        {
            CheckDomainConfig(settings);
        }
    }
    bool HasOwnNetworks(const TransportSettings &settings) const override
    {
        return HasOwnInterfaces(settings.BackendConfig);
    }
    bool FindsNetworks() const override { return false; }
    bool IsMisledByDuplicates() const override { return true; }
    std::size_t MostNetworks() const override { return RabitCycloneMostInterfaces(); }

private:
    // The vendor reads its configuration only when it creates a domain. That sends nothing to the network as
    // long as the domain has no participant.
    static void CheckDomainConfig(TransportSettings settings)
    {
        HasOwnInterfaces(settings.BackendConfig);
        const auto host = ListHostNetworks().value_or(std::vector<HostNetwork>());
        const auto network = std::find_if(
            host.begin(), host.end(), [](const HostNetwork &one) { return one.Up && !one.Address.empty(); });
        if (network == host.end())
        {
            return;  // it would only report the missing interface
        }
        settings.Interfaces = {network->Address};
        settings.Peers.clear();
        const VendorDomain domain(settings, std::make_shared<SessionLog>(settings),
                                  std::make_shared<DiscoveryTurns>(), std::make_shared<SendingTurn>(),
                                  std::make_shared<Rtps::RecentGoodbyes>(), std::make_shared<Rtps::Ledger>());
    }
};

}  // namespace

std::string CycloneDdsTransport::Name() const
{
    return "cyclonedds";
}

std::unique_ptr<TransportSession> CycloneDdsTransport::Open(const TransportSettings &settings,
                                                            PeerHandler onPeer)
{
    return OpenRejoining(settings, std::move(onPeer), std::make_shared<CycloneBackend>());
}

std::vector<SettingsProblem> CycloneDdsTransport::Check(const TransportSettings &settings) const
{
    return CheckRejoining(settings, CycloneBackend());
}

}  // namespace Rabit
