#include <gmock/gmock.h>

#include <string>
#include <vector>

#include "SimulatedFleet.h"

namespace Rabit
{
namespace
{

using namespace std::chrono_literals;
using ::testing::IsEmpty;

// Posts its pose ten times a second.
class Poster : public RabitManager
{
public:
    explicit Poster(RabitWorkspace &workspace) : RabitManager("Poster", workspace)
    {
        AddPublishSubscribeMessage("Pose", _pose);
        SetPeriodSec(0.1);
    }
    void ExecuteUnitOfWork() final
    {
        ++_pose->number;
        _pose->PostMessage();
    }

private:
    std::shared_ptr<Uav::Pose> _pose = std::make_shared<Uav::Pose>();
};

void AddPoster(SimulatedNode &node, GatewayConfig & /*config*/)
{
    node.Reactor.AddManager(std::make_unique<Poster>(node.Workspace));
}

// The numbers of the poses that arrive at the ground station.
std::vector<std::uint32_t> PosesHeard(std::uint64_t seed)
{
    SimulatedFleet fleet(seed);
    fleet.Network.SetFaults("*", "*", {.Loss = 0.4});
    fleet.Add(AircraftConfig("uav1"), AddPoster);
    SimulatedNode &ground = fleet.Add(GroundConfig());
    std::vector<std::uint32_t> heard;
    for (int i = 0; i < 100; ++i)
    {
        fleet.RunFor(100ms);
        heard.push_back(ground.Newest<Uav::Pose>("uav1/Pose").number);
    }
    return heard;
}

TEST(SimulatedFleet, RunsTheManagersOfAllNodes)
{
    SimulatedFleet fleet;
    fleet.Add(AircraftConfig("uav1"), AddPoster);
    fleet.Add(GroundConfig());
    fleet.RunFor(10s);
    EXPECT_EQ(fleet["ground"].StateOf("uav1"), "UP");
    EXPECT_EQ(fleet["ground"].StateOf("uav9"), "");
    EXPECT_GE(fleet["ground"].Newest<Uav::Pose>("uav1/Pose").number, 99u);
}

TEST(SimulatedFleet, DoesTheSameAgainWithTheSameSeedAndSomethingElseWithAnother)
{
    EXPECT_EQ(PosesHeard(1), PosesHeard(1));
    EXPECT_NE(PosesHeard(1), PosesHeard(2));
}

TEST(SimulatedFleet, ANodeThatIsKilledSaysNothingMore)
{
    SimulatedFleet fleet;
    SimulatedNode &uav = fleet.Add(AircraftConfig("uav1"));
    uav.AddIdleManager("MissionControl");
    SimulatedNode &ground = fleet.Add(GroundConfig());
    fleet.RunFor(3s);
    fleet.Network.SetFaults("*", "*", {.Cut = true});
    EXPECT_TRUE(ground.Workspace.AddMessageToQueue("uav1/MissionControl", std::make_shared<Uav::Goto>()));
    std::vector<std::string> lines;
    const auto listening =
        RabitLog::Listen([&lines](RabitLogLevel, const std::string &line) { lines.push_back(line); });
    fleet.Kill("ground");
    EXPECT_THAT(lines, IsEmpty());
    fleet.Network.ClearFaults();
    EXPECT_EQ(uav.StateOf("ground"), "UP") << "it said no goodbye";
    fleet.RunFor(10s);
    EXPECT_EQ(uav.StateOf("ground"), "LOST");
}

TEST(SimulatedFleet, StopsAsSoonAsAConditionHolds)
{
    SimulatedFleet fleet;
    SimulatedNode &uav = fleet.Add(AircraftConfig("uav1"));
    fleet.Add(GroundConfig());
    EXPECT_TRUE(fleet.RunUntil([&uav] { return uav.StateOf("ground") == "UP"; }, 10s));
    EXPECT_LT(fleet.Network.Now(), 3s);
    EXPECT_FALSE(fleet.RunUntil([] { return false; }, 1s));
}

}  // namespace
}  // namespace Rabit
