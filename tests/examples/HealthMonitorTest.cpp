#include "HealthMonitor.h"

#include <rabit/ManualClock.h>
#include <rabit/RabitSteppedReactor.h>

#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <limits>
#include <memory>
#include <string>
#include <vector>

namespace
{
using namespace std::chrono_literals;
using Swarm::HomeRule;

constexpr float NoBattery = std::numeric_limits<float>::quiet_NaN();
constexpr double NeverHeard = std::numeric_limits<double>::quiet_NaN();

TEST(HomeRule, SendsHomeOnceWhenTheBatteryIsLow)
{
    HomeRule rule(10);
    EXPECT_EQ(rule.Judge(25, 0), "");
    EXPECT_EQ(rule.Judge(24.9f, 0), "the battery is low");
    EXPECT_EQ(rule.Judge(24.8f, 0), "");
    EXPECT_EQ(rule.Reason(), "the battery is low");
}

TEST(HomeRule, SendsHomeOnceForEachSilence)
{
    HomeRule rule(10);
    EXPECT_EQ(rule.Judge(90, 10), "");
    EXPECT_EQ(rule.Judge(90, 10.5), "the ground station was silent");
    EXPECT_EQ(rule.Judge(90, 11.5), "");
    EXPECT_EQ(rule.Reason(), "the ground station is silent");
    EXPECT_EQ(rule.Judge(90, 0), "");
    EXPECT_EQ(rule.Reason(), "");
    EXPECT_EQ(rule.Judge(90, 11), "the ground station was silent");
}

TEST(HomeRule, WhatIsNotKnownIsNoCause)
{
    HomeRule rule(10);
    EXPECT_EQ(rule.Judge(NoBattery, NeverHeard), "");
    EXPECT_EQ(rule.Reason(), "");
}

class HealthMonitor : public testing::Test
{
protected:
    std::shared_ptr<Rabit::ManualClock> _clock = std::make_shared<Rabit::ManualClock>(1.4e9);
    Rabit::RabitWorkspace _workspace{_clock};
    std::shared_ptr<Rabit::RabitManager::RabitQueue> _mission =
        std::make_shared<Rabit::RabitManager::RabitQueue>(10, "MissionControl");
    std::shared_ptr<Rabit::Gateway::Fleet> _fleet = std::make_shared<Rabit::Gateway::Fleet>();
    Rabit::RabitSteppedReactor _reactor{_workspace};
    Uav::Health _health;

    void Start(std::optional<double> enduranceS)
    {
        _workspace.AddManagerMessageQueue("MissionControl", _mission);
        _workspace.AddPublishSubscribeMessage("Gateway/Fleet", _fleet);
        _reactor.AddManager(std::make_unique<Swarm::HealthMonitor>(
            Swarm::Names("uav1", "uav1"), Swarm::HealthMonitor::Options{.EnduranceS = enduranceS},
            _workspace));
        _reactor.Start();
    }
    void Run(std::chrono::seconds duration)
    {
        _reactor.RunFor(*_clock, duration);
        _workspace.FetchMessage("Health", &_health);
    }
    void HearOfGround(Rabit::Gateway::NodeState state, double lastHeardS)
    {
        _fleet->nodes.resize(1);
        _fleet->nodes[0].node = "ground";
        _fleet->nodes[0].state = state;
        _fleet->nodes[0].last_heard_s = lastHeardS;
        _fleet->PostMessage();
    }
    std::vector<std::string> SentHomeFor()
    {
        std::vector<std::string> reasons;
        std::shared_ptr<Rabit::RabitMessage> message;
        while (_mission->GetMessage(message))
            reasons.push_back(dynamic_cast<const Uav::GoHome &>(*message).reason);
        return reasons;
    }
};

TEST_F(HealthMonitor, DrainsTheBatteryEvenlyAndSendsTheAircraftHomeOnce)
{
    Start(1000.0);
    Run(100s);
    EXPECT_NEAR(_health.battery_percent, 90, 0.2);
    EXPECT_FALSE(_health.wants_home);
    Run(660s);
    EXPECT_TRUE(_health.wants_home);
    EXPECT_EQ(SentHomeFor(), std::vector<std::string>{"the battery is low"});
    Run(1000s);
    EXPECT_EQ(_health.battery_percent, 0);
    EXPECT_TRUE(SentHomeFor().empty());
}

TEST_F(HealthMonitor, DoesNotKnowTheBatteryOfARealAircraft)
{
    Start(std::nullopt);
    Run(10000s);
    EXPECT_TRUE(std::isnan(_health.battery_percent));
    EXPECT_TRUE(SentHomeFor().empty());
}

TEST_F(HealthMonitor, WaitsForAGroundStationThatWasNeverHeard)
{
    Start(std::nullopt);
    Run(1000s);
    EXPECT_TRUE(std::isnan(_health.ground_silent_s));
    EXPECT_TRUE(SentHomeFor().empty());
}

TEST_F(HealthMonitor, SendsTheAircraftHomeWhenTheGroundStationIsLostForLong)
{
    Start(std::nullopt);
    HearOfGround(Rabit::Gateway::NodeState::UP, 0.2);
    Run(1s);
    EXPECT_EQ(_health.ground_silent_s, 0);
    HearOfGround(Rabit::Gateway::NodeState::LOST, 9);
    Run(1s);
    EXPECT_TRUE(SentHomeFor().empty());
    HearOfGround(Rabit::Gateway::NodeState::LOST, 10.1);
    Run(1s);
    EXPECT_EQ(SentHomeFor(), std::vector<std::string>{"the ground station was silent"});
    EXPECT_EQ(_health.reason, "the ground station is silent");
}

TEST_F(HealthMonitor, TakesAGatewayThatTellsNothingForSilence)
{
    Start(std::nullopt);
    HearOfGround(Rabit::Gateway::NodeState::UP, 0.2);
    Run(2s);
    EXPECT_EQ(_health.ground_silent_s, 0);
    Run(10s);
    EXPECT_GT(_health.ground_silent_s, 10);
    EXPECT_EQ(SentHomeFor().size(), 1u);
}

TEST_F(HealthMonitor, SendsTheAircraftHomeLaterIfMissionControlHasNoRoom)
{
    Start(100.0);
    while (_mission->AddMessage(std::make_shared<Uav::Search>()))
    {
    }
    Run(80s);
    _mission->ClearMessageQueue();
    Run(2s);
    EXPECT_EQ(SentHomeFor().size(), 1u);
}

TEST_F(HealthMonitor, SendsTheAircraftHomeAgainEachSecondWhileMissionControlDeclines)
{
    const auto answer = [&](Uav::CommandStage stage)
    {
        auto ack = std::make_shared<Uav::CommandAck>();
        ack->stage = stage;
        EXPECT_TRUE(_workspace.AddMessageToQueue("HealthMonitor", ack));
    };
    Start(100.0);
    Run(80s);
    ASSERT_EQ(SentHomeFor().size(), 1u);
    for (int i = 0; i < 3; ++i)
    {
        answer(Uav::CommandStage::COMMAND_DECLINED);
        Run(1s);
        EXPECT_EQ(SentHomeFor(), std::vector<std::string>{"the battery is low"});
    }
    answer(Uav::CommandStage::COMMAND_ACCEPTED);
    Run(10s);
    EXPECT_TRUE(SentHomeFor().empty());
}

TEST_F(HealthMonitor, DoesNotInsistOnceTheGroundStationIsHeardAgain)
{
    Start(std::nullopt);
    HearOfGround(Rabit::Gateway::NodeState::LOST, 11);
    Run(1s);
    ASSERT_EQ(SentHomeFor().size(), 1u);
    auto ack = std::make_shared<Uav::CommandAck>();
    ack->stage = Uav::CommandStage::COMMAND_DECLINED;
    ASSERT_TRUE(_workspace.AddMessageToQueue("HealthMonitor", ack));
    HearOfGround(Rabit::Gateway::NodeState::UP, 0.1);
    Run(2s);
    EXPECT_TRUE(SentHomeFor().empty());
}

}  // namespace
