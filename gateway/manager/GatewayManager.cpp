#include <rabit/gateway/GatewayManager.h>

#include <algorithm>
#include <stdexcept>
#include <utility>

#include "manager/GatewayParts.h"
#include "manager/TransportSettingsOf.h"

namespace Rabit
{
namespace
{

// Shorter sleeps are not worth it.
constexpr std::chrono::nanoseconds ShortestSleep = std::chrono::microseconds(200);

std::vector<std::shared_ptr<Transport>> Checked(std::vector<std::shared_ptr<Transport>> transports,
                                                std::size_t paths)
{
    if (transports.size() != paths ||
        std::find(transports.begin(), transports.end(), nullptr) != transports.end())
    {
        throw std::invalid_argument("GatewayManager needs a transport for each path");
    }
    return transports;
}

}  // namespace

std::vector<std::shared_ptr<Transport>> TransportsOf(
    const GatewayConfig &config,
    const std::function<std::shared_ptr<Transport>(const std::string &name)> &make)
{
    std::vector<std::shared_ptr<Transport>> transports;
    for (const GatewayConfig &path : PathConfigsOf(config))
    {
        transports.push_back(make(path.Transport));
    }
    return transports;
}

GatewayManager::GatewayManager(const GatewayConfig &config, std::shared_ptr<Transport> transport)
    : GatewayManager(config, std::move(transport), *RabitWorkspace::GetWorkspace())
{
}

GatewayManager::GatewayManager(const GatewayConfig &config, std::shared_ptr<Transport> transport,
                               RabitWorkspace &workspace, RandomSource random)
    : GatewayManager(config,
                     std::vector<std::shared_ptr<Transport>>(std::max<std::size_t>(config.Paths.size(), 1),
                                                             std::move(transport)),
                     workspace, std::move(random))
{
}

GatewayManager::GatewayManager(const GatewayConfig &config,
                               std::vector<std::shared_ptr<Transport>> transports, RabitWorkspace &workspace,
                               RandomSource random)
    : RabitManager(config.Name, workspace),
      _config(config),
      _transports(Checked(std::move(transports), std::max<std::size_t>(config.Paths.size(), 1))),
      _random(std::move(random)),
      _exploration(std::make_unique<Exploration>(WakeUpHandler())),
      _parts(std::make_unique<Parts>(_config, _transports, *this, _random, *_exploration))
{
}

GatewayManager::~GatewayManager() = default;

FleetExplorer &GatewayManager::Explorer()
{
    _exploration->BeWanted();
    return *_exploration;
}

void GatewayManager::Startup()
{
    _exploration->SetServed(true);
    if (!_parts || !_parts->IsOpen())
    {
        _parts.reset();
        _parts = std::make_unique<Parts>(_config, _transports, *this, _random, *_exploration);
    }
}

void GatewayManager::ExecuteUnitOfWork()
{
    const std::uint64_t asked = _exploration->BeginTurn();
    const auto next = _parts->Service();
    _exploration->EndTurn(asked);
    const auto sleep = std::max(next - _parts->Now(), ShortestSleep);
    SetWakeupTimeDelaySec(std::chrono::duration<double>(sleep).count());
}

void GatewayManager::Shutdown()
{
    _exploration->SetServed(false);
    if (_parts)
    {
        _parts->Close();
    }
}

}  // namespace Rabit
