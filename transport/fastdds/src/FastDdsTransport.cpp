#include <rabit/fastdds/FastDdsTransport.h>

#include <memory>
#include <utility>

#include "FastDdsReader.h"
#include "FastDdsWriter.h"
#include "ParticipantSettings.h"
#include "SessionCore.h"
#include "common/RejoiningBackend.h"
#include "common/RejoiningSession.h"
#include "common/VendorSession.h"

namespace Rabit
{

namespace
{

using FastDdsSession = VendorSession<FastDds::SessionCore, FastDds::FastDdsWriter, FastDds::FastDdsReader>;

class FastDdsBackend final : public RejoiningBackend
{
public:
    std::unique_ptr<BackendSession> Open(const TransportSettings &settings,
                                         const SessionContext &context) override
    {
        return std::make_unique<FastDdsSession>(settings, context);
    }
    void CheckConfig(const TransportSettings &settings) const override { FastDds::CheckConfig(settings); }
    bool HasOwnNetworks(const TransportSettings &settings) const override
    {
        return FastDds::HasOwnTransports(settings.BackendConfig);
    }
    bool FindsNetworks() const override { return true; }
    bool IsMisledByDuplicates() const override { return false; }
};

}  // namespace

std::string FastDdsTransport::Name() const
{
    return "fastdds";
}

std::unique_ptr<TransportSession> FastDdsTransport::Open(const TransportSettings &settings,
                                                         PeerHandler onPeer)
{
    return OpenRejoining(settings, std::move(onPeer), std::make_shared<FastDdsBackend>());
}

std::vector<SettingsProblem> FastDdsTransport::Check(const TransportSettings &settings) const
{
    return CheckRejoining(settings, FastDdsBackend());
}

}  // namespace Rabit
