#include "HealthMonitor.h"

#include <algorithm>
#include <limits>

namespace Swarm
{
namespace
{
// The gateway posts Fleet each second; if Fleet is older than this, the gateway has stopped.
constexpr double FleetIsOldS = 3;
}  // namespace

HealthMonitor::HealthMonitor(const Names &names, const Options &options, Rabit::RabitWorkspace &workspace)
    : RabitManager(names.Own("HealthMonitor"), workspace),
      _names(names),
      _options(options),
      _rule(options.SilenceLimitS)
{
    AddPublishSubscribeMessage("Gateway/Fleet", _fleet);
    AddPublishSubscribeMessage(names.Own("Health"), _health);
    SetWakeupManagerUponMessagePostedToManagersMessageQueue(false);
    SetWakeupTimeDelayMSec(static_cast<int>(std::chrono::milliseconds(Period).count()));
}

void HealthMonitor::Startup()
{
    _start = GetWorkspace().GetClock().Monotonic();
}

void HealthMonitor::ExecuteUnitOfWork()
{
    _health->battery_percent = BatteryPercent();
    const double silentS = GroundSilentS();
    _health->ground_silent_s = static_cast<float>(silentS);
    const std::string news = _rule.Judge(_health->battery_percent, silentS);
    TakeAnswers();
    if (!news.empty())
        _toSend = news;
    _health->reason = _rule.Reason();
    _health->wants_home = !_health->reason.empty();
    _health->PostMessage();
    if (!_toSend.empty())
        SendHome();
}

// If the command was declined, it is sent again: an autopilot that was not ready may be by now.
void HealthMonitor::TakeAnswers()
{
    std::shared_ptr<Rabit::RabitMessage> message;
    while (GetManagerMessageQueue()->GetMessage(message))
    {
        const auto *answer = dynamic_cast<const Uav::CommandAck *>(message.get());
        if (answer && answer->stage == Uav::CommandStage::COMMAND_DECLINED)
            _toSend = _rule.Cause();
    }
}

void HealthMonitor::SendHome()
{
    auto home = std::make_shared<Uav::GoHome>();
    home->reply_to = _names.Own("HealthMonitor");
    home->reason = _toSend;
    if (AddMessageToQueue(_names.Own("MissionControl"), home))
        _toSend.clear();
}

float HealthMonitor::BatteryPercent() const
{
    if (!_options.EnduranceS)
        return std::numeric_limits<float>::quiet_NaN();
    const std::chrono::duration<double> flown = GetWorkspace().GetClock().Monotonic() - _start;
    return static_cast<float>(std::max(0.0, 100 * (1 - flown.count() / *_options.EnduranceS)));
}

// NaN if the ground station was never heard. A gateway that stopped posting counts as hearing nothing.
double HealthMonitor::GroundSilentS()
{
    _fleet->FetchMessage();
    for (const Rabit::Gateway::NodeStatus &node : _fleet->nodes)
        if (node.node == _options.Ground)
        {
            const double age = _fleet->GetAgeSeconds();
            const bool heard = node.state == Rabit::Gateway::NodeState::UP && age < FleetIsOldS;
            return heard ? 0 : node.last_heard_s + age;
        }
    return std::numeric_limits<double>::quiet_NaN();
}

}  // namespace Swarm
