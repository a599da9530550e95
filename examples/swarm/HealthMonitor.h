#pragma once

#include "Names.h"
#include "mission/HomeRule.h"
#include "uav.idl.h"

#include <rabit/RabitManager.h>
#include <rabit/gateway/Fleet.h>

#include <chrono>
#include <memory>
#include <optional>
#include <string>

namespace Swarm
{

// Watches over the aircraft: the manager `HealthMonitor`.
//
// Fetches: Gateway/Fleet, to know whether the ground station is heard.
// Posts:   Health (Uav::Health), each second.
// Sends:   Uav::GoHome to the queue MissionControl, once when the battery is low or the ground station is
//          silent for too long. Sends it again each second while mission control declines it.
// Queue:   HealthMonitor takes mission control's answers (Uav::CommandAck). They do not wake it.
class HealthMonitor : public Rabit::RabitManager
{
public:
    static constexpr std::chrono::seconds Period{1};

    struct Options
    {
        std::string Ground = "ground";  // the node of the ground station
        double SilenceLimitS = 10;      // after a longer silence the aircraft flies home
        // Endurance of a simulated battery, from full to empty; nothing: the battery is not known.
        std::optional<double> EnduranceS;
    };

    HealthMonitor(const Names &names, const Options &options,
                  Rabit::RabitWorkspace &workspace = *Rabit::RabitWorkspace::GetWorkspace());

    void Startup() final;
    void ExecuteUnitOfWork() final;

private:
    float BatteryPercent() const;
    double GroundSilentS();
    void TakeAnswers();
    void SendHome();

    const Names _names;
    const Options _options;
    HomeRule _rule;
    std::string _toSend;  // reason to fly home that is not sent yet
    std::chrono::nanoseconds _start{0};
    std::shared_ptr<Rabit::Gateway::Fleet> _fleet = std::make_shared<Rabit::Gateway::Fleet>();
    std::shared_ptr<Uav::Health> _health = std::make_shared<Uav::Health>();
};

}  // namespace Swarm
