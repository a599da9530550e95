#include <rabit/ManualClock.h>
#include <rabit/RabitSteppedReactor.h>
#include <rabit/gateway/FleetValues.h>

#include <gtest/gtest.h>

#include <chrono>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "uav.idl.h"

namespace Rabit
{
namespace
{

using namespace std::chrono_literals;

class Follower : public RabitManager
{
public:
    Follower(RabitWorkspace &workspace, FleetValues<Uav::Pose>::Wake wake)
        : RabitManager("Follower", workspace), Poses(*this, "Pose", wake)
    {
        SetWakeupTimeDelaySec(0.5);
    }
    void ExecuteUnitOfWork() final
    {
        ++Passes;
        News += Poses.Fetch() ? 1 : 0;
    }

    FleetValues<Uav::Pose> Poses;
    int Passes = 0;
    int News = 0;
};

class FleetValuesTest : public ::testing::Test
{
protected:
    Follower &Start(FleetValues<Uav::Pose>::Wake wake = FleetValues<Uav::Pose>::Wake::No)
    {
        auto manager = std::make_unique<Follower>(_workspace, wake);
        Follower &follower = *manager;
        _reactor.AddManager(std::move(manager));
        _reactor.Start();
        Run(0s);
        return follower;
    }
    void Run(std::chrono::nanoseconds duration) { _reactor.RunFor(*_clock, duration); }
    // As a gateway does.
    std::shared_ptr<Uav::Pose> Post(const std::string &name, std::uint32_t number)
    {
        auto pose = std::make_shared<Uav::Pose>();
        EXPECT_TRUE(_workspace.AddPublishSubscribeMessage(name, pose));
        pose->number = number;
        pose->PostMessage();
        return pose;
    }

    std::shared_ptr<ManualClock> _clock = std::make_shared<ManualClock>(1.4e9);
    RabitWorkspace _workspace{_clock};
    RabitSteppedReactor _reactor{_workspace};
};

// Collects the lines of the log while it lives.
class LogLines
{
public:
    std::vector<std::string> Lines;

private:
    const std::shared_ptr<void> _listening =
        RabitLog::Listen([this](RabitLogLevel, const std::string &line) { Lines.push_back(line); });
};

TEST_F(FleetValuesTest, WarnOnceIfNoneComesWhileAnotherNodeIsUp)
{
    LogLines log;
    Start();
    Post("uav1/Poses", 1);
    Run(10s);
    EXPECT_TRUE(log.Lines.empty()) << "no other node is heard";
    const auto fleet = std::make_shared<Gateway::Fleet>();
    ASSERT_TRUE(_workspace.AddPublishSubscribeMessage("Gateway/Fleet", fleet));
    fleet->nodes.emplace_back().state = Gateway::NodeState::UP;
    fleet->PostMessage();
    Run(4s);
    EXPECT_TRUE(log.Lines.empty());
    Run(20s);
    ASSERT_EQ(log.Lines.size(), 1u);
    EXPECT_EQ(
        log.Lines[0],
        "Follower: other nodes are heard, and no `*/Pose` of its class came in 5 s: a `subscribe` entry of "
        "the gateway's configuration brings it; did you mean `Poses`?");
}

TEST_F(FleetValuesTest, WarnWithTheReasonOfTheGatewayIfItSubscribes)
{
    LogLines log;
    Start();
    const auto fleet = std::make_shared<Gateway::Fleet>();
    ASSERT_TRUE(_workspace.AddPublishSubscribeMessage("Gateway/Fleet", fleet));
    fleet->nodes.emplace_back().state = Gateway::NodeState::UP;
    fleet->problems.push_back({"subscribe Poses", "uav1", "another message"});
    fleet->problems.push_back({"subscribe Pose", "uav1", "uav1 does not publish `Pose`"});
    fleet->PostMessage();
    Run(20s);
    ASSERT_EQ(log.Lines.size(), 1u);
    EXPECT_EQ(log.Lines[0],
              "Follower: other nodes are heard, and no `*/Pose` of its class came in 5 s: uav1 does not "
              "publish `Pose`");
}

TEST_F(FleetValuesTest, WarnOfValuesOfAnotherClass)
{
    LogLines log;
    Start();
    const auto other = std::make_shared<Gateway::Fleet>();
    ASSERT_TRUE(_workspace.AddPublishSubscribeMessage("uav1/Pose", other));
    const auto fleet = std::make_shared<Gateway::Fleet>();
    ASSERT_TRUE(_workspace.AddPublishSubscribeMessage("Gateway/Fleet", fleet));
    fleet->nodes.emplace_back().state = Gateway::NodeState::UP;
    fleet->PostMessage();
    Run(20s);
    ASSERT_EQ(log.Lines.size(), 1u);
    EXPECT_EQ(log.Lines[0],
              "Follower: other nodes are heard, and no `*/Pose` of its class came in 5 s: `uav1/Pose` is of "
              "another class");
}

TEST_F(FleetValuesTest, DoNotCallAMessageOfTheirClassOneOfAnotherClass)
{
    LogLines log;
    Start();
    Post("uav1/nose/Pose", 1);
    const auto fleet = std::make_shared<Gateway::Fleet>();
    ASSERT_TRUE(_workspace.AddPublishSubscribeMessage("Gateway/Fleet", fleet));
    fleet->nodes.emplace_back().state = Gateway::NodeState::UP;
    fleet->PostMessage();
    Run(20s);
    ASSERT_EQ(log.Lines.size(), 1u);
    EXPECT_EQ(log.Lines[0].find("is of another class"), std::string::npos) << log.Lines[0];
}

TEST_F(FleetValuesTest, DoNotGuessAMessageWithAnotherName)
{
    LogLines log;
    Start();
    Post("uav1/Health", 1);
    const auto fleet = std::make_shared<Gateway::Fleet>();
    ASSERT_TRUE(_workspace.AddPublishSubscribeMessage("Gateway/Fleet", fleet));
    fleet->nodes.emplace_back().state = Gateway::NodeState::UP;
    fleet->PostMessage();
    Run(20s);
    ASSERT_EQ(log.Lines.size(), 1u);
    EXPECT_EQ(
        log.Lines[0],
        "Follower: other nodes are heard, and no `*/Pose` of its class came in 5 s: a `subscribe` entry "
        "of the gateway's configuration brings it");
}

TEST_F(FleetValuesTest, DoNotWarnOnceAValueHasCome)
{
    LogLines log;
    Start();
    const auto fleet = std::make_shared<Gateway::Fleet>();
    ASSERT_TRUE(_workspace.AddPublishSubscribeMessage("Gateway/Fleet", fleet));
    fleet->nodes.emplace_back().state = Gateway::NodeState::UP;
    fleet->PostMessage();
    Post("uav1/Pose", 1);
    Run(20s);
    EXPECT_TRUE(log.Lines.empty());
}

TEST(FleetRow, IsFoundByTheNodesName)
{
    Gateway::Fleet fleet;
    EXPECT_EQ(Gateway::FindNode(fleet, "uav1"), nullptr);
    fleet.nodes.resize(2);
    fleet.nodes[1].node = "uav1";
    EXPECT_EQ(Gateway::FindNode(fleet, "uav1"), &fleet.nodes[1]);
}

TEST_F(FleetValuesTest, HaveTheNewestValueOfEachNodeThatComesAtAnyTime)
{
    Follower &follower = Start();
    EXPECT_TRUE(follower.Poses.All().empty());
    Post("uav1/Pose", 1);
    Post("uav2/Pose", 2);
    Run(1s);
    Post("uav2/Pose", 3);
    Run(500ms);
    const auto all = follower.Poses.All();
    ASSERT_EQ(all.size(), 2u);
    EXPECT_EQ(all.at("uav1")->number, 1u);
    EXPECT_EQ(all.at("uav2")->number, 3u);
    EXPECT_EQ(follower.Poses.Of("uav2"), all.at("uav2"));
    EXPECT_EQ(follower.Poses.Of("uav3"), nullptr);
    EXPECT_EQ(follower.News, 2);
}

TEST_F(FleetValuesTest, AreOfThatMessageAlone)
{
    _workspace.AddPublishSubscribeMessage("uav1/Pose", std::make_shared<Uav::Pose>());  // never posted
    Post("Pose", 1);
    Post("uav1/LastPose", 2);
    Post("a/b/Pose", 3);
    auto other = std::make_shared<Uav::Health>();
    _workspace.AddPublishSubscribeMessage("uav2/Pose", other);
    other->PostMessage();
    EXPECT_TRUE(Start().Poses.All().empty());
}

TEST_F(FleetValuesTest, AreLeftOutWhenTheyAreTooOldButKept)
{
    Post("uav1/Pose", 1);
    Follower &follower = Start();
    EXPECT_EQ(follower.Poses.YoungerThan(0.5).size(), 1u);
    Run(500ms);
    EXPECT_TRUE(follower.Poses.YoungerThan(0.5).empty());
    EXPECT_EQ(follower.Poses.All().size(), 1u);
    EXPECT_DOUBLE_EQ(follower.Poses.Of("uav1")->GetAgeSeconds(), 0.5);
}

TEST_F(FleetValuesTest, WakeTheManagerIfItAsksForThat)
{
    using Wake = FleetValues<Uav::Pose>::Wake;
    Post("uav1/Pose", 1);
    Follower &follower = Start(Wake::OnEach);
    const int passes = follower.Passes;
    Post("uav1/Pose", 2);
    Run(0s);
    EXPECT_EQ(follower.Passes, passes + 1);
    EXPECT_EQ(follower.Poses.Of("uav1")->number, 2u);
}

}  // namespace
}  // namespace Rabit
