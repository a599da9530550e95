// Tests of managers and of fleets, without threads, a network or waiting.
#include <gtest/gtest.h>
#include <rabit/ManualClock.h>
#include <rabit/RabitManager.h>
#include <rabit/RabitSteppedReactor.h>
#include <rabit/testing/Lab.h>
#include <rabit/testing/SimulatedFleet.h>

#include <chrono>
#include <memory>
#include <string>
#include <system_error>

#include "uav.idl.h"

namespace
{

using namespace std::chrono_literals;

// [pilot]
// Flies home if the battery is low.
class Pilot : public Rabit::RabitManager
{
public:
    explicit Pilot(Rabit::RabitWorkspace &workspace) : RabitManager("Pilot", workspace)
    {
        AddPublishSubscribeMessage("Health", _health);
        AddPublishSubscribeMessage("MissionState", _state);
        WakeUpManagerOnMessagePost(_health);
        SetWakeupTimeDelaySec(1.0);  // at the latest
    }

    void ExecuteUnitOfWork() final
    {
        _health->FetchMessage();
        const bool isLow = _health->WasPosted() && _health->battery_percent < 25;
        _state->mode = isLow ? Uav::MissionMode::MISSION_HOME : Uav::MissionMode::MISSION_SEARCH;
        _state->PostMessage();
    }

private:
    const std::shared_ptr<Uav::Health> _health = std::make_shared<Uav::Health>();
    const std::shared_ptr<Uav::MissionState> _state = std::make_shared<Uav::MissionState>();
};
// [/pilot]

// [one]
TEST(PilotTest, FliesHomeIfTheBatteryIsLow)
{
    const auto clock = std::make_shared<Rabit::ManualClock>(1.4e9);  // GPS seconds
    Rabit::RabitWorkspace workspace(clock);
    Rabit::RabitSteppedReactor reactor(workspace);
    const auto health = std::make_shared<Uav::Health>();
    workspace.AddPublishSubscribeMessage("Health", health);
    reactor.AddManager(std::make_unique<Pilot>(workspace));
    reactor.Start();

    health->battery_percent = 20;
    health->PostMessage();
    reactor.RunFor(*clock, 100ms);

    Uav::MissionState state;
    workspace.ForceFetchMessage("MissionState", &state);
    EXPECT_EQ(state.mode, Uav::MissionMode::MISSION_HOME);
}
// [/one]

// [fleet]
Rabit::GatewayConfig ConfigOf(const std::string &node)  // or LoadGatewayConfig("uav.yaml", node)
{
    Rabit::GatewayConfig config;
    config.Node = node;
    config.Publish.push_back({.Message = "MissionState", .Type = "Uav::MissionState"});
    config.Subscribe.push_back({.Message = "MissionState", .Type = "Uav::MissionState"});
    return config;
}

TEST(FleetTest, EachKnowsTheOthersMissionDespiteALoss)
{
    Rabit::SimulatedFleet fleet;  // takes a seed
    for (const std::string name : {"uav1", "uav2"})
    {
        fleet.Add(ConfigOf(name), [](Rabit::SimulatedNode &node, Rabit::GatewayConfig &)
                  { node.Reactor.AddManager(std::make_unique<Pilot>(node.Workspace)); });
    }
    fleet.Network.SetFaults("*", "*", {.Loss = 0.2});  // from, to
    fleet.RunFor(10s);
    EXPECT_EQ(fleet["uav2"].StateOf("uav1"), "UP");
    EXPECT_EQ(fleet["uav2"].Newest<Uav::MissionState>("uav1/MissionState").mode,
              Uav::MissionMode::MISSION_SEARCH);

    fleet.Kill("uav1");  // as by SIGKILL; Stop: in order
    fleet.RunFor(10s);
    EXPECT_EQ(fleet["uav2"].StateOf("uav1"), "LOST");
}
// [/fleet]

// [keys]
TEST(FleetTest, AProgramWithoutKeysIsNotHeard)
{
    Rabit::SimulatedFleet fleet;
    fleet.FlyWithKeys();
    fleet.Add(ConfigOf("uav1"));
    fleet.Add(ConfigOf("uav2"));
    fleet.FlyWithKeys(false);
    fleet.Add(ConfigOf("stranger"));
    fleet.RunFor(10s);
    EXPECT_EQ(fleet["uav2"].StateOf("uav1"), "UP");
    EXPECT_EQ(fleet["uav2"].StateOf("stranger"), "");
}
// [/keys]

// [idle]
TEST(FleetTest, AnIdleManagerKeepsWhatOthersSend)
{
    Rabit::SimulatedFleet fleet;
    Rabit::GatewayConfig config;
    config.Node = "uav1";
    config.Accept.push_back({.Queue = "Mission", .Types = {"Uav::GoHome"}});
    Rabit::IdleManager *mission = nullptr;
    fleet.Add(config, [&mission](Rabit::SimulatedNode &node, Rabit::GatewayConfig &)
              { mission = &node.AddIdleManager("Mission"); });
    config = {};
    config.Node = "ground";
    Rabit::SimulatedNode &ground = fleet.Add(config);
    fleet.RunFor(3s);

    EXPECT_TRUE(ground.Workspace.AddMessageToQueue("uav1/Mission", std::make_shared<Uav::GoHome>()));
    fleet.RunFor(1s);
    EXPECT_EQ(mission->GetManagerMessageQueue()->NoMessagesInQueue(), 1);
}
// [/idle]

// [lab]
// Whole processes over an emulated radio, in real time.
Rabit::LabResult FlyInTheLab(const std::string &program, const std::string &scenario,
                             const std::string &folder)
{
    const Rabit::LabResult flight = Rabit::Lab(program).Run(scenario, folder);
    EXPECT_TRUE(flight || flight.IsImpossible()) << flight;
    return flight;
}
// [/lab]

TEST(LabExample, AProgramThatIsNotThereCannotFly)
{
    EXPECT_THROW(FlyInTheLab("/nowhere/rabit", "flight.yaml", "flight"), std::system_error);
}

}  // namespace
