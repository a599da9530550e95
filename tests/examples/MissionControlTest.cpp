#include "MissionControl.h"
#include "mission/WhyNot.h"

#include <rabit/ManualClock.h>
#include <rabit/QueueForwarder.h>
#include <rabit/RabitSteppedReactor.h>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <limits>
#include <memory>
#include <string>
#include <vector>

namespace
{
using namespace std::chrono_literals;
using testing::HasSubstr;

Uav::Goto Command(std::uint32_t id)
{
    Uav::Goto command;
    command.id = id;
    command.reply_to = "ground/Commands";
    command.latitude_deg = 49.2584;
    command.longitude_deg = -123.2432;
    command.altitude_m = 60;
    command.speed_mps = 10;
    return command;
}

// Stands in for a gateway: accepts or refuses messages for other nodes.
class FakeGateway : public Rabit::QueueForwarder
{
public:
    bool Accepts = true;
    std::vector<std::pair<std::string, Uav::CommandAck>> Accepted;
    int Refused = 0;

    bool Handles(const std::string &) const override { return true; }
    bool Forward(const std::string &queue, const std::shared_ptr<Rabit::RabitMessage> &message,
                 const std::shared_ptr<Rabit::RabitQueueReceipt> &) override
    {
        if (!Accepts)
        {
            ++Refused;
            return false;
        }
        Accepted.emplace_back(queue, dynamic_cast<const Uav::CommandAck &>(*message));
        return true;
    }
};

class MissionControl : public testing::Test
{
protected:
    std::shared_ptr<Rabit::ManualClock> _clock = std::make_shared<Rabit::ManualClock>(1.4e9);
    Rabit::RabitWorkspace _workspace{_clock};
    std::shared_ptr<Rabit::RabitMessageQueue<std::shared_ptr<Rabit::RabitMessage>>> _autopilot =
        std::make_shared<Rabit::RabitMessageQueue<std::shared_ptr<Rabit::RabitMessage>>>(2, "Autopilot");
    std::shared_ptr<FakeGateway> _gateway = std::make_shared<FakeGateway>();
    Rabit::RabitSteppedReactor _reactor{_workspace};
    Uav::MissionState _state;
    const Swarm::Floor _floor{{.AboveSeaM = 10}};

    void SetUp() override
    {
        _workspace.AddManagerMessageQueue("Autopilot", _autopilot);
        _workspace.SetQueueForwarder(_gateway);
        _reactor.AddManager(std::make_unique<Swarm::MissionControl>(Swarm::Names("uav1", "uav1"), "ground",
                                                                    _floor, _workspace));
        _reactor.Start();
    }
    void Receive(const Uav::Goto &command)
    {
        ASSERT_TRUE(_workspace.AddMessageToQueue("MissionControl", std::make_shared<Uav::Goto>(command)));
        Run(0ms);
    }
    void Run(std::chrono::milliseconds duration)
    {
        _reactor.RunFor(*_clock, duration);
        _workspace.FetchMessage("MissionState", &_state);
    }
};

TEST_F(MissionControl, PassesACommandOnAndAnswersWhoAskedForIt)
{
    Receive(Command(5));
    std::shared_ptr<Rabit::RabitMessage> passed;
    ASSERT_TRUE(_autopilot->GetMessage(passed));
    EXPECT_EQ(dynamic_cast<Uav::Course &>(*passed).number, 1u);
    EXPECT_EQ(dynamic_cast<Uav::Course &>(*passed).altitude_m, 60);
    ASSERT_EQ(_gateway->Accepted.size(), 1u);
    const auto &[queue, ack] = _gateway->Accepted[0];
    EXPECT_EQ(queue, "ground/Commands");
    EXPECT_EQ(ack.id, 5u);
    EXPECT_EQ(ack.node, "uav1");
    EXPECT_EQ(ack.stage, Uav::CommandStage::COMMAND_ACCEPTED);
    EXPECT_EQ(ack.reason, "");
}

TEST_F(MissionControl, DeclinesACommandThatCannotBeFlownAndSaysWhy)
{
    Uav::Goto command = Command(5);
    command.speed_mps = 0;
    Receive(command);
    EXPECT_TRUE(_autopilot->IsEmpty());
    ASSERT_EQ(_gateway->Accepted.size(), 1u);
    EXPECT_EQ(_gateway->Accepted[0].second.stage, Uav::CommandStage::COMMAND_DECLINED);
    EXPECT_EQ(_gateway->Accepted[0].second.reason, "speed_mps must be from 0.1 to 50, not 0");
}

TEST_F(MissionControl, SaysWhyItDeclinedACommandEvenIfNobodyWantsTheAnswer)
{
    Uav::Goto command = Command(0);
    command.reply_to.clear();
    command.speed_mps = -1;
    testing::internal::CaptureStderr();
    Receive(command);
    Receive(command);
    const std::string log = testing::internal::GetCapturedStderr();
    const std::string line = "a command is declined: speed_mps must be from 0.1 to 50, not -1";
    ASSERT_THAT(log, HasSubstr(line));
    EXPECT_EQ(log.find(line, log.find(line) + 1), std::string::npos) << "the same reason is logged once";
    EXPECT_EQ(_state.text, "declined: speed_mps must be from 0.1 to 50, not -1");
    Run(61s);
    EXPECT_EQ(_state.text, "");
    Receive(command);
    Receive(Command(6));
    EXPECT_EQ(_state.text, "") << "a command that is accepted ends it";
}

TEST_F(MissionControl, KeepsTheGeofenceOfItsGroundStation)
{
    const auto fence = std::make_shared<Uav::Geofence>();
    _workspace.AddPublishSubscribeMessage("ground/Geofence", fence);
    fence->latitude_deg = Command(5).latitude_deg + 1;
    fence->longitude_deg = Command(5).longitude_deg;
    fence->radius_m = 1000;
    fence->PostMessage();
    Run(0ms);
    Receive(Command(5));
    EXPECT_TRUE(_autopilot->IsEmpty());
    ASSERT_EQ(_gateway->Accepted.size(), 1u);
    EXPECT_EQ(_gateway->Accepted[0].second.stage, Uav::CommandStage::COMMAND_DECLINED);
    EXPECT_EQ(_gateway->Accepted[0].second.reason, "110.2 km outside of the geofence");
}

TEST_F(MissionControl, DeclinesACommandBelowItsFloorAndSaysWhy)
{
    Uav::Goto command = Command(5);
    command.altitude_m = 9;
    Receive(command);
    EXPECT_TRUE(_autopilot->IsEmpty());
    ASSERT_EQ(_gateway->Accepted.size(), 1u);
    EXPECT_EQ(_gateway->Accepted[0].second.stage, Uav::CommandStage::COMMAND_DECLINED);
    EXPECT_EQ(_gateway->Accepted[0].second.reason, "9 m above sea level is below the floor of 10 m");
}

TEST_F(MissionControl, PublishesWhyItDeclinesASearchArea)
{
    auto area = std::make_shared<Uav::SearchArea>();
    _workspace.AddPublishSubscribeMessage("ground/SearchArea", area);
    area->number = 1;
    area->latitude_deg = 49.2584;
    area->longitude_deg = -123.2432;
    area->north_m = area->east_m = 400;
    area->altitude_m = 9;
    area->speed_mps = 10;
    area->lane_m = 60;
    area->PostMessage();
    Run(10ms);
    EXPECT_EQ(_state.area_declined, "9 m above sea level is below the floor of 10 m");
    EXPECT_EQ(_state.search_area, 0u);
    EXPECT_TRUE(_state.has_floor);
    EXPECT_EQ(_state.floor_m, 10);
}

TEST_F(MissionControl, DeclinesACommandThatTheAutopilotDoesNotTake)
{
    for (std::uint32_t id = 1; id <= 3; ++id)
        Receive(Command(id));
    EXPECT_EQ(_gateway->Accepted.back().second.id, 3u);
    EXPECT_EQ(_gateway->Accepted.back().second.stage, Uav::CommandStage::COMMAND_DECLINED);
    EXPECT_EQ(_gateway->Accepted.back().second.reason, "the autopilot takes no commands now");
}

TEST_F(MissionControl, DeclinesACommandThatTheAutopilotWouldNotFlyAndSaysWhy)
{
    auto mode = std::make_shared<Uav::FlightMode>();
    _workspace.AddPublishSubscribeMessage("FlightMode", mode);
    mode->not_ready = "no autopilot is heard";
    mode->PostMessage();
    Receive(Command(7));
    ASSERT_EQ(_gateway->Accepted.size(), 1u);
    EXPECT_EQ(_gateway->Accepted[0].second.stage, Uav::CommandStage::COMMAND_DECLINED);
    EXPECT_EQ(_gateway->Accepted[0].second.reason, "no autopilot is heard");
}

TEST_F(MissionControl, SendsNoAnswerThatNobodyWants)
{
    Uav::Goto command = Command(5);
    command.reply_to = "";
    Receive(command);
    EXPECT_FALSE(_autopilot->IsEmpty());
    EXPECT_TRUE(_gateway->Accepted.empty());
}

TEST_F(MissionControl, KeepsAnAnswerThatIsRefusedAndSendsItLaterOnce)
{
    _gateway->Accepts = false;
    Receive(Command(5));
    Run(3s);
    EXPECT_THAT(_state.text, HasSubstr("1 answers wait"));
    _gateway->Accepts = true;
    Run(3s);
    ASSERT_EQ(_gateway->Accepted.size(), 1u);
    EXPECT_EQ(_gateway->Accepted[0].second.id, 5u);
    EXPECT_EQ(_state.text, "");
}

TEST_F(MissionControl, KeepsTheOrderOfRefusedAnswers)
{
    _gateway->Accepts = false;
    Receive(Command(5));
    Receive(Command(6));
    _gateway->Accepts = true;
    Run(1s);
    ASSERT_EQ(_gateway->Accepted.size(), 3u);
    EXPECT_EQ(_gateway->Accepted[0].second.id, 5u);
    EXPECT_EQ(_gateway->Accepted[1].second.id, 5u);
    EXPECT_EQ(_gateway->Accepted[1].second.stage, Uav::CommandStage::COMMAND_REPLACED);
    EXPECT_EQ(_gateway->Accepted[2].second.id, 6u);
}

TEST_F(MissionControl, GivesAnAnswerUpAfterHalfAMinuteAndSaysSo)
{
    _gateway->Accepts = false;
    Receive(Command(5));
    Run(31s);
    const int refused = _gateway->Refused;
    Run(5s);
    EXPECT_EQ(_gateway->Refused, refused);
    EXPECT_EQ(_state.text, "1 answers given up");
}

TEST_F(MissionControl, PostsItsStateEverySecond)
{
    Run(0ms);
    const auto posts = _workspace.FindGlobalMessage("MissionState")->GetNumberOfPosts();
    Run(10s);
    EXPECT_EQ(_workspace.FindGlobalMessage("MissionState")->GetNumberOfPosts() - posts, 10u);
}

TEST_F(MissionControl, PostsItsStateAtOnceWhenTheModeChanges)
{
    Receive(Command(5));
    Run(500ms);
    ASSERT_EQ(_state.mode, Uav::MissionMode::MISSION_GOTO);
    auto posted = std::make_shared<Uav::FlightMode>();
    _workspace.AddPublishSubscribeMessage("FlightMode", posted);
    posted->phase = Uav::FlightPhase::FLIGHT_HOLD;
    posted->course = 1;
    posted->PostMessage();
    Run(0ms);
    EXPECT_EQ(_state.mode, Uav::MissionMode::MISSION_HOLD);
}

TEST_F(MissionControl, SaysWhichSearchAreaHoldsAndRefusesOneThatMakesNoSense)
{
    auto area = std::make_shared<Uav::SearchArea>();
    _workspace.AddPublishSubscribeMessage("ground/SearchArea", area);
    area->number = 4;
    area->altitude_m = 60;
    area->north_m = area->east_m = 300;
    area->speed_mps = 15;
    area->lane_m = 50;
    area->PostMessage();
    Run(0ms);
    EXPECT_EQ(_state.search_area, 4u);
    area->number = 5;
    area->lane_m = 0;
    area->PostMessage();
    Run(1s);
    EXPECT_EQ(_state.search_area, 4u);
}

TEST_F(MissionControl, CountsCommandsAndPoses)
{
    auto pose = std::make_shared<Uav::Pose>();
    _workspace.AddPublishSubscribeMessage("Pose", pose);
    pose->number = 123;
    pose->PostMessage();
    Receive(Command(5));
    Run(1s);
    EXPECT_EQ(_state.poses, 123u);
    EXPECT_EQ(_state.commands, 1u);
    EXPECT_EQ(_state.last_command, 5u);
}

TEST_F(MissionControl, IgnoresMessagesThatAreNoCommands)
{
    _workspace.AddMessageToQueue("MissionControl", std::make_shared<Uav::TargetReport>());
    Run(1s);
    EXPECT_TRUE(_gateway->Accepted.empty());
    EXPECT_TRUE(_autopilot->IsEmpty());
}

TEST(WhyNot, AcceptsTheLimits)
{
    Uav::Goto command = Command(1);
    command.latitude_deg = -90;
    command.longitude_deg = 180;
    command.altitude_m = 10000;
    command.speed_mps = 50;
    EXPECT_EQ(Swarm::WhyNot(command), "");
}

TEST(WhyNot, RefusesWhatIsOutOfRangeOrNoNumber)
{
    const double nan = std::numeric_limits<double>::quiet_NaN();
    Uav::Goto command = Command(1);
    command.latitude_deg = nan;
    EXPECT_THAT(Swarm::WhyNot(command), HasSubstr("latitude_deg"));
    command = Command(1);
    command.longitude_deg = 180.1;
    EXPECT_THAT(Swarm::WhyNot(command), HasSubstr("longitude_deg"));
    command = Command(1);
    command.altitude_m = std::numeric_limits<double>::infinity();
    EXPECT_THAT(Swarm::WhyNot(command), HasSubstr("altitude_m"));
    command = Command(1);
    command.speed_mps = 50.5f;
    EXPECT_THAT(Swarm::WhyNot(command), HasSubstr("speed_mps"));
}

TEST(WhyNot, RefusesASearchAreaThatCannotBeSearched)
{
    Uav::SearchArea area;
    area.north_m = 10;
    area.east_m = 20000;
    area.speed_mps = 50;
    area.lane_m = 5;
    EXPECT_EQ(Swarm::WhyNot(area), "");
    for (const auto &[member, name] :
         {std::pair(&Uav::SearchArea::north_m, "north_m"), std::pair(&Uav::SearchArea::east_m, "east_m"),
          std::pair(&Uav::SearchArea::lane_m, "lane_m"), std::pair(&Uav::SearchArea::speed_mps, "speed_mps"),
          std::pair(&Uav::SearchArea::altitude_m, "altitude_m")})
    {
        Uav::SearchArea wrong = area;
        wrong.*member = std::numeric_limits<float>::quiet_NaN();
        EXPECT_THAT(Swarm::WhyNot(wrong), HasSubstr(name));
        wrong.*member = 1e6f;
        EXPECT_THAT(Swarm::WhyNot(wrong), HasSubstr(name));
    }
}

}  // namespace
