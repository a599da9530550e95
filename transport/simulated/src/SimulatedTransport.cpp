#include <rabit/simulated/SimulatedTransport.h>

#include <utility>

#include "NetworkCore.h"
#include "SimulatedSession.h"
#include "common/SettingsCheck.h"

namespace Rabit
{

SimulatedTransport::SimulatedTransport(const SimulatedNetwork &network) : _core(network._core) {}

std::string SimulatedTransport::Name() const
{
    return "simulated";
}

std::unique_ptr<TransportSession> SimulatedTransport::Open(const TransportSettings &settings,
                                                           PeerHandler onPeer)
{
    CheckSettings(settings);
    return std::make_unique<Simulated::SimulatedSession>(_core, settings, std::move(onPeer));
}

std::vector<SettingsProblem> SimulatedTransport::Check(const TransportSettings &settings) const
{
    return FindImpossible(settings);
}

}  // namespace Rabit
