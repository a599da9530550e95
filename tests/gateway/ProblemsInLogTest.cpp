// The log lines of a process about data that do not come: whole nodes on the simulated network.
#include <gmock/gmock.h>

#include <string>
#include <vector>

#include "../core/CapturedLog.h"
#include "SimulatedFleet.h"

namespace Rabit
{
namespace
{

using namespace std::chrono_literals;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::UnorderedElementsAre;

class ProblemsInLog : public ::testing::Test
{
protected:
    // Adds an aircraft without a problem.
    void AddAircraft(const std::string &name)
    {
        SimulatedNode &uav = fleet.Add(AircraftConfig(name));
        uav.AddIdleManager("MissionControl");
        _poses.push_back(uav.Register<Uav::Pose>("Pose"));
        uav.Register<Uav::MissionState>("MissionState")->PostMessage();
    }

    // The aircraft post poses meanwhile.
    void Fly(std::chrono::milliseconds duration)
    {
        for (auto flown = 0ms; flown < duration; flown += 100ms)
        {
            for (const auto &pose : _poses)
            {
                pose->PostMessage();
            }
            fleet.RunFor(100ms);
        }
    }

    static bool Command(SimulatedNode &ground, const std::string &node)
    {
        return ground.Workspace.AddMessageToQueue(node + "/MissionControl", std::make_shared<Uav::Goto>());
    }

    RabitTest::CapturedLog log;
    SimulatedFleet fleet{1};

private:
    std::vector<std::shared_ptr<Uav::Pose>> _poses;
};

TEST_F(ProblemsInLog, EachIsToldByNameWithinFiveSeconds)
{
    AddAircraft("uav1");
    GatewayConfig config;
    config.Node = "ground";
    config.Subscribe.push_back({.Message = "Pse", .Type = "Uav::Pose"});
    config.Subscribe.push_back({.Message = "Pose", .Type = "Uav::MissionState", .From = {"uav1"}});
    config.Subscribe.push_back({.Message = "MissionState", .Type = "Uav::MissionState", .From = {"uav9"}});
    config.Accept.push_back({.Queue = "Ground", .Types = {"Uav::CommandAck"}});
    SimulatedNode &ground = fleet.Add(config);
    ground.Workspace.AddManagerMessageQueue("Ground", std::make_shared<RabitMessageQueue<int>>(10, "Ground"));
    ground.Workspace.AddMessageToQueue("uav1/MissionControl", std::make_shared<Uav::Pose>());
    fleet.RunFor(5s);
    // Both transports report by themselves that they differ in the type of a topic.
    const auto gateways = [this]
    {
        std::vector<std::string> lines = log.Lines();
        std::erase_if(lines, [](const std::string &line) { return line.starts_with("transport: "); });
        return lines;
    };
    EXPECT_THAT(gateways(),
                UnorderedElementsAre(HasSubstr("subscribe Pse, uav1: uav1 does not publish `Pse`"),
                                     HasSubstr("subscribe Pose, uav1: uav1 publishes `Pose` as `Uav::Pose`"),
                                     HasSubstr("subscribe MissionState: no node named `uav9` has been heard"),
                                     HasSubstr("accept Ground: the local queue `Ground` does not hold"),
                                     HasSubstr("send uav1/MissionControl: ")));
    fleet.RunFor(10min);
    EXPECT_EQ(log.Lines().size(), 8u) << "each once, and that the refused message is over";
    EXPECT_THAT(log.Lines().back(), HasSubstr("no longer: send uav1/MissionControl: "));
}

TEST_F(ProblemsInLog, EachIsToldOnceMoreWhenItIsGone)
{
    fleet.Add(GroundConfig()).AddIdleManager("Commands");
    fleet.RunFor(9s);  // after 10 s it says as well that it is lonely
    EXPECT_THAT(log.Lines(),
                ElementsAre("ground: gateway: subscribe Pose, MissionState: no node named `uav*` has "
                            "been heard"));
    AddAircraft("uav1");
    Fly(5s);
    ASSERT_EQ(log.Lines().size(), 2u);
    EXPECT_EQ(log.Lines()[1],
              "ground: gateway: no longer: subscribe MissionState, Pose: no node named `uav*` has "
              "been heard");
}

TEST_F(ProblemsInLog, NodesThatStartOneAfterTheOtherAreNone)
{
    SimulatedNode &ground = fleet.Add(GroundConfig());
    ground.AddIdleManager("Commands");
    for (const char *name : {"uav1", "uav2", "uav3"})
    {
        Fly(1s);
        AddAircraft(name);
        EXPECT_FALSE(Command(ground, name)) << "too early";
        Fly(1500ms);
        EXPECT_TRUE(Command(ground, name));
    }
    Fly(20s);
    EXPECT_THAT(log.Lines(), IsEmpty());
}

TEST_F(ProblemsInLog, ARefusalIsToldEvenIfTheProcessEndsAtOnce)
{
    EXPECT_FALSE(Command(fleet.Add(GroundConfig()), "uav1"));
    fleet.Stop("ground");
    EXPECT_THAT(log.Lines(), ElementsAre(HasSubstr("gateway: send uav1/MissionControl: ")));
}

TEST_F(ProblemsInLog, ALoopThatIsRefusedFloodsNothing)
{
    AddAircraft("uav1");
    SimulatedNode &ground = fleet.Add(GroundConfig());
    ground.AddIdleManager("Commands");
    for (int i = 0; i < 600; ++i)
    {
        ground.Workspace.AddMessageToQueue("uav1/MissionControl", std::make_shared<Uav::Pose>());
        ground.Workspace.AddMessageToQueue("uav1/MissionControl", std::make_shared<Uav::Health>());
        Fly(100ms);
        Command(ground, "uav1");
        Command(ground, "nobody");
    }
    EXPECT_LE(log.Lines().size(), 8u);
}

}  // namespace
}  // namespace Rabit
