#include "Autopilot.h"
#include "SimulatedVehicle.h"

#include <rabit/ManualClock.h>
#include <rabit/RabitSteppedReactor.h>

#include <gtest/gtest.h>

#include <chrono>
#include <memory>

namespace
{
using namespace std::chrono_literals;

class Autopilot : public testing::Test
{
protected:
    std::shared_ptr<Rabit::ManualClock> _clock = std::make_shared<Rabit::ManualClock>(1.4e9);
    Rabit::RabitWorkspace _workspace{_clock};
    Rabit::RabitSteppedReactor _reactor{_workspace};
    Uav::Pose _pose;
    Uav::FlightMode _mode;

    void SetUp() override
    {
        const Swarm::Circle pattern{{49.2574, -123.2432, 50}};
        _reactor.AddManager(std::make_unique<Swarm::Autopilot>(
            Swarm::Names("uav1", "uav1"), std::make_unique<Swarm::SimulatedVehicle>(Swarm::Flight(pattern)),
            _workspace));
        _reactor.Start();
    }
    void Run(std::chrono::milliseconds duration)
    {
        _reactor.RunFor(*_clock, duration);
        _workspace.FetchMessage("Pose", &_pose);
        _workspace.FetchMessage("FlightMode", &_mode);
    }
    bool Command(std::uint32_t id)
    {
        auto command = std::make_shared<Uav::Course>();
        command->number = id;
        command->latitude_deg = 49.2584;  // some 50 m beyond the pattern
        command->longitude_deg = -123.2432;
        command->altitude_m = 60;
        command->speed_mps = 10;
        return _workspace.AddMessageToQueue("Autopilot", command);
    }
};

TEST_F(Autopilot, PostsTenPosesASecondAndNumbersThem)
{
    Run(0ms);
    EXPECT_EQ(_pose.number, 1u);
    Run(60s);
    EXPECT_EQ(_pose.number, 601u);
}

TEST_F(Autopilot, KeepsItsRateWhenCommandsWakeIt)
{
    for (int i = 0; i < 1000; ++i)
    {
        Run(7ms);
        ASSERT_TRUE(Command(1));
    }
    EXPECT_EQ(_pose.number, 71u);
}

TEST_F(Autopilot, SaysWhenThePoseWasTrue)
{
    Run(10s);
    EXPECT_NEAR(_pose.gps_time_s, 1.4e9 + 10, 1e-6);
}

TEST_F(Autopilot, FliesItsPatternUntilItIsCommanded)
{
    Run(1s);
    EXPECT_EQ(_mode.phase, Uav::FlightPhase::FLIGHT_PATTERN);
    EXPECT_EQ(_mode.course, 0u);
}

TEST_F(Autopilot, FliesToTheCommandedPointAndHolds)
{
    Run(1s);
    Command(7);
    Run(100ms);
    EXPECT_EQ(_mode.phase, Uav::FlightPhase::FLIGHT_COURSE);
    EXPECT_EQ(_mode.course, 7u);
    Run(30s);
    EXPECT_EQ(_mode.phase, Uav::FlightPhase::FLIGHT_HOLD);
    EXPECT_NEAR(_pose.altitude_m, 60, 0.1);
}

TEST_F(Autopilot, GoesBackToItsPatternWhenTheCourseIsTakenBack)
{
    Command(7);
    Run(30s);
    auto none = std::make_shared<Uav::Course>();
    none->number = 8;
    ASSERT_TRUE(_workspace.AddMessageToQueue("Autopilot", none));
    Run(100ms);
    EXPECT_EQ(_mode.phase, Uav::FlightPhase::FLIGHT_PATTERN);
    EXPECT_EQ(_mode.course, 8u);
}

TEST_F(Autopilot, IgnoresMessagesThatAreNoCommands)
{
    _workspace.AddMessageToQueue("Autopilot", std::make_shared<Uav::TargetReport>());
    Run(1s);
    EXPECT_EQ(_mode.phase, Uav::FlightPhase::FLIGHT_PATTERN);
    EXPECT_EQ(_pose.number, 11u);
}

}  // namespace
