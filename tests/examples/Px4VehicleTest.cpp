// An aircraft whose PX4 uses DDS, by the messages that the gateway makes of PX4's topics.
#include "px4/Px4Vehicle.h"

#include <gtest/gtest.h>
#include <rabit/ManualClock.h>

#include <cmath>
#include <limits>

#include "px4/Px4Topics.h"

namespace Swarm
{
namespace
{

using namespace std::chrono_literals;
namespace Command = px4_msgs::msg::VehicleCommand_Constants;
namespace Answer = px4_msgs::msg::VehicleCommandAck_Constants;

class Px4VehicleTest : public testing::Test
{
protected:
    Px4VehicleTest()
    {
        workspace.AddPublishSubscribeMessage("Px4/Status", status);
        workspace.AddPublishSubscribeMessage("Px4/Position", position);
        workspace.AddPublishSubscribeMessage("Px4/LocalPosition", local);
        workspace.AddPublishSubscribeMessage("Px4/Attitude", attitude);
        workspace.AddPublishSubscribeMessage("Px4/Ack", answer);
        workspace.AddPublishSubscribeMessage("Px4/Command", command);
        command->FetchMessage();
    }

    std::chrono::nanoseconds Now() const { return clock->Monotonic(); }
    void PostStatus(std::uint8_t arming = 2)
    {
        status->arming_state = arming;
        status->system_id = 7;
        status->component_id = 1;
        status->PostMessage();
    }
    void PostPosition(double latitude = 47.0)
    {
        position->lat = latitude;
        position->lon = 8.5;
        position->alt = 510;
        position->lat_lon_valid = true;
        position->alt_valid = true;
        position->PostMessage();
    }
    void PostAnswer(std::uint8_t result)
    {
        answer->command = Command::VEHICLE_CMD_DO_REPOSITION;
        answer->result = result;
        answer->PostMessage();
    }
    // Makes the aircraft ready, and sends it to a point.
    void FlyTo()
    {
        PostStatus();
        PostPosition();
        vehicle.Update(Now());
        vehicle.FlyTo({47.01, 8.5, 520}, 12, Now());
        vehicle.Update(Now());
    }

    std::shared_ptr<Rabit::ManualClock> clock = std::make_shared<Rabit::ManualClock>(1.4e9, 100s);
    Rabit::RabitWorkspace workspace{clock};
    Px4Vehicle vehicle{workspace};
    std::shared_ptr<px4_msgs::msg::VehicleStatus> status = std::make_shared<px4_msgs::msg::VehicleStatus>();
    std::shared_ptr<px4_msgs::msg::VehicleGlobalPosition> position =
        std::make_shared<px4_msgs::msg::VehicleGlobalPosition>();
    std::shared_ptr<px4_msgs::msg::VehicleLocalPosition> local =
        std::make_shared<px4_msgs::msg::VehicleLocalPosition>();
    std::shared_ptr<px4_msgs::msg::VehicleAttitude> attitude =
        std::make_shared<px4_msgs::msg::VehicleAttitude>();
    std::shared_ptr<px4_msgs::msg::VehicleCommandAck> answer =
        std::make_shared<px4_msgs::msg::VehicleCommandAck>();
    std::shared_ptr<px4_msgs::msg::VehicleCommand> command =
        std::make_shared<px4_msgs::msg::VehicleCommand>();
};

TEST_F(Px4VehicleTest, TellsEachPositionOnceWithVelocityAndAttitude)
{
    local->vx = 1;
    local->vy = 2;
    local->vz = -3;
    local->PostMessage();
    attitude->q = {std::sqrt(0.5F), 0, 0, std::sqrt(0.5F)};  // turned to the east
    attitude->PostMessage();
    EXPECT_FALSE(vehicle.Update(Now()));
    PostPosition(47.5);
    const auto motion = vehicle.Update(Now());
    ASSERT_TRUE(motion);
    EXPECT_EQ(motion->Position.LatitudeDeg, 47.5);
    EXPECT_EQ(motion->Position.AltitudeM, 510);
    EXPECT_EQ(motion->EastMps, 2);
    EXPECT_EQ(motion->DownMps, -3);
    EXPECT_NEAR(motion->YawRad, 1.5708, 1e-3);
    EXPECT_FALSE(vehicle.Update(Now()));
}

TEST_F(Px4VehicleTest, SaysWhyItWouldNotFly)
{
    EXPECT_EQ(vehicle.NotReady(Now()), "no PX4 is heard on DDS");
    PostStatus(1);
    vehicle.Update(Now());
    EXPECT_EQ(vehicle.NotReady(Now()), "PX4 is not armed");
    PostStatus(2);
    vehicle.Update(Now());
    EXPECT_EQ(vehicle.NotReady(Now()), "PX4 has no position");
    PostPosition();
    vehicle.Update(Now());
    EXPECT_EQ(vehicle.NotReady(Now()), "");
    clock->Advance(4s);
    EXPECT_EQ(vehicle.NotReady(Now()), "no PX4 is heard on DDS");
}

TEST_F(Px4VehicleTest, TellsNoPositionThatPx4DoesNotKnow)
{
    PostStatus();
    PostPosition(std::numeric_limits<double>::quiet_NaN());
    EXPECT_FALSE(vehicle.Update(Now()));
    PostPosition();
    EXPECT_TRUE(vehicle.Update(Now()));
    position->lat_lon_valid = false;
    position->PostMessage();
    EXPECT_FALSE(vehicle.Update(Now()));
    EXPECT_EQ(vehicle.NotReady(Now()), "PX4 has no position");
}

TEST_F(Px4VehicleTest, KeepsTheVelocityThatItKnewWhilePx4DoesNot)
{
    local->vx = 1;
    local->PostMessage();
    PostPosition();
    vehicle.Update(Now());
    local->vx = std::numeric_limits<float>::quiet_NaN();
    local->PostMessage();
    PostPosition();
    EXPECT_EQ(vehicle.Update(Now())->NorthMps, 1);
}

TEST_F(Px4VehicleTest, CommandsAPointAndSaysWhatItFlies)
{
    FlyTo();
    ASSERT_TRUE(command->FetchMessage());
    EXPECT_EQ(command->command, Command::VEHICLE_CMD_DO_REPOSITION);
    EXPECT_EQ(command->param1, 12.0F);
    EXPECT_EQ(command->param2, 1.0F);
    EXPECT_TRUE(std::isnan(command->param4));
    EXPECT_EQ(command->param5, 47.01);
    EXPECT_EQ(command->param6, 8.5);
    EXPECT_EQ(command->param7, 520.0F);
    EXPECT_EQ(command->target_system, 7);
    EXPECT_TRUE(command->from_external);
    EXPECT_EQ(vehicle.Phase(), Uav::FlightPhase::FLIGHT_COURSE);
    PostPosition(47.0099);
    vehicle.Update(Now());
    EXPECT_EQ(vehicle.Phase(), Uav::FlightPhase::FLIGHT_HOLD);
}

TEST_F(Px4VehicleTest, CommandsAgainUntilItIsAnswered)
{
    FlyTo();
    clock->Advance(1s);
    PostStatus();
    vehicle.Update(Now());
    EXPECT_TRUE(command->FetchMessage());
    PostAnswer(Answer::VEHICLE_CMD_RESULT_ACCEPTED);
    clock->Advance(1s);
    vehicle.Update(Now());
    EXPECT_FALSE(command->FetchMessage());
    EXPECT_EQ(vehicle.Phase(), Uav::FlightPhase::FLIGHT_COURSE);
}

TEST_F(Px4VehicleTest, CommandsThreeTimesAtMost)
{
    FlyTo();
    int sent = 0;
    for (int second = 0; second < 6; ++second)
    {
        sent += command->FetchMessage() ? 1 : 0;
        clock->Advance(1s);
        PostStatus();
        vehicle.Update(Now());
    }
    EXPECT_EQ(sent, 3);
}

TEST_F(Px4VehicleTest, SaysThatAndWhyAPointWasRefused)
{
    FlyTo();
    PostAnswer(Answer::VEHICLE_CMD_RESULT_DENIED);
    vehicle.Update(Now());
    EXPECT_EQ(vehicle.Phase(), Uav::FlightPhase::FLIGHT_IDLE);
    EXPECT_EQ(vehicle.NotReady(Now()), "PX4 refused the point: denied");
    clock->Advance(5s);
    PostStatus();
    PostPosition();
    vehicle.Update(Now());
    EXPECT_EQ(vehicle.NotReady(Now()), "");
}

TEST_F(Px4VehicleTest, TakesNoAnswerToSomebodyElsesCommand)
{
    FlyTo();
    answer->command = Command::VEHICLE_CMD_DO_SET_MODE;
    answer->result = Answer::VEHICLE_CMD_RESULT_DENIED;
    answer->PostMessage();
    vehicle.Update(Now());
    EXPECT_EQ(vehicle.Phase(), Uav::FlightPhase::FLIGHT_COURSE);
}

TEST(Px4Topics, AreBelowTheNamespaceOfTheAircraft)
{
    EXPECT_EQ(IsPx4("dds"), "");
    EXPECT_EQ(IsPx4("dds:/px4_1"), "");
    EXPECT_EQ(IsPx4("udp:14550"), "`udp:14550` is no PX4; expected dds or dds:/namespace");
    EXPECT_EQ(Px4Namespace("dds"), "");
    Rabit::GatewayConfig config;
    config.Node = "uav1";
    AddPx4Topics(config, Px4Namespace("dds:/px4_1"));
    ASSERT_EQ(config.Foreign.size(), 6u);
    EXPECT_EQ(config.Foreign[0].Topic, "/px4_1/fmu/out/vehicle_status");
    EXPECT_NO_THROW(Rabit::ValidateGatewayConfig(config));
}

TEST(Px4Topics, AreThoseOfTheConfigurationWhereItHasThem)
{
    Rabit::GatewayConfig config;
    config.Foreign.push_back({.Topic = "rt/fmu/out/vehicle_status_v1",
                              .Type = "px4_msgs::msg::VehicleStatus",
                              .Local = "Px4/Status"});
    AddPx4Topics(config, "");
    ASSERT_EQ(config.Foreign.size(), 6u);
    EXPECT_EQ(config.Foreign[0].Topic, "rt/fmu/out/vehicle_status_v1");
    EXPECT_EQ(config.Foreign[1].Local, "Px4/Position");
}

}  // namespace
}  // namespace Swarm
