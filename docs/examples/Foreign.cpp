// A manager that reads and writes topics of programs without a gateway.
#include <gtest/gtest.h>
#include <rabit/RabitManager.h>
#include <rabit/gateway/ForeignRule.h>
#include <rabit/testing/SimulatedFleet.h>

#include <chrono>
#include <memory>

#include "uav.idl.h"

namespace
{

using namespace std::chrono_literals;

// [foreign]
class Follower : public Rabit::RabitManager
{
public:
    explicit Follower(Rabit::RabitWorkspace &workspace) : RabitManager("Follower", workspace)
    {
        AddPublishSubscribeMessage("Autopilot/Pose", _pose);  // `as` of the configuration
        AddPublishSubscribeMessage("Setpoint", _setpoint);    // `publish` of the configuration
        WakeUpManagerOnMessagePost(_pose);
    }

    void ExecuteUnitOfWork() final
    {
        if (_pose->FetchMessage() && _pose->GetAgeSeconds() < 0.5)
        {
            _setpoint->altitude_m = _pose->altitude_m + 10;
            _setpoint->PostMessage();
        }
    }

private:
    const std::shared_ptr<Uav::Pose> _pose = std::make_shared<Uav::Pose>();
    const std::shared_ptr<Uav::Goto> _setpoint = std::make_shared<Uav::Goto>();
};
// [/foreign]

// [rule]
Rabit::GatewayConfig ConfigWithForeignTopic()
{
    Rabit::ForeignRule rule;
    rule.Topic = "rt/pose";
    rule.Type = "Uav::Pose";
    rule.Local = "Autopilot/Pose";
    rule.Names = Rabit::ForeignRule::WireNames::Ros2;
    rule.StaleAfter = 500ms;
    Rabit::GatewayConfig config;
    config.Node = "uav1";
    config.Foreign.push_back(rule);
    return config;
}
// [/rule]

TEST(ForeignExample, TheFleetMessageTellsWhyNothingComes)
{
    Rabit::SimulatedFleet fleet;
    fleet.Add(ConfigWithForeignTopic(), [](Rabit::SimulatedNode &node, Rabit::GatewayConfig &)
              { node.Reactor.AddManager(std::make_unique<Follower>(node.Workspace)); });
    fleet.RunFor(5s);
    const Rabit::Gateway::Fleet seen = fleet["uav1"].Fleet();
    ASSERT_EQ(seen.foreign.size(), 1u);
    EXPECT_EQ(seen.foreign[0].state, Rabit::Gateway::NodeState::LOST);
    EXPECT_NE(seen.foreign[0].reason, "");
}

}  // namespace
