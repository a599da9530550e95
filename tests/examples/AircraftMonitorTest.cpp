#include "AircraftMonitor.h"

#include <rabit/ManualClock.h>

#include <gtest/gtest.h>

#include <chrono>
#include <memory>

namespace
{
using namespace std::chrono_literals;
using Ground::FleetRow;

class AircraftMonitor : public testing::Test
{
protected:
    std::shared_ptr<Rabit::ManualClock> _clock = std::make_shared<Rabit::ManualClock>(1.4e9);
    Rabit::RabitWorkspace _workspace{_clock};
    std::shared_ptr<Uav::Pose> _pose = std::make_shared<Uav::Pose>();
    std::shared_ptr<Uav::MissionState> _mission = std::make_shared<Uav::MissionState>();
    std::shared_ptr<Uav::Health> _health = std::make_shared<Uav::Health>();
    Ground::AircraftMonitor _monitor{"uav1", _workspace};

    void SetUp() override
    {
        _workspace.AddPublishSubscribeMessage("uav1/Pose", _pose);
        _workspace.AddPublishSubscribeMessage("uav1/MissionState", _mission);
        _workspace.AddPublishSubscribeMessage("uav1/Health", _health);
    }
    FleetRow Shown()
    {
        FleetRow row;
        _monitor.Show(row, _tally);
        return row;
    }
    Ground::CommandTally _tally;
};

TEST_F(AircraftMonitor, ShowsNothingBeforeTheFirstMessages)
{
    EXPECT_FALSE(Shown().AgeS);
    EXPECT_EQ(Shown().Mission, "");
}

TEST_F(AircraftMonitor, ShowsTheLatestPoseAndItsAge)
{
    _pose->latitude_deg = 49;
    _pose->velocity_north_mps = 3;
    _pose->velocity_down_mps = -4;
    _pose->PostMessage();
    _clock->Advance(1500ms);
    const FleetRow row = Shown();
    EXPECT_DOUBLE_EQ(row.LatitudeDeg, 49);
    EXPECT_DOUBLE_EQ(row.SpeedMps, 5);
    ASSERT_TRUE(row.AgeS);
    EXPECT_NEAR(*row.AgeS, 1.5, 1e-9);
}

TEST_F(AircraftMonitor, TellsWhyAPositionIsBadUntilAGoodOneComes)
{
    _pose->latitude_deg = 95;
    _pose->PostMessage();
    EXPECT_EQ(Shown().BadPosition, "latitude must be from -90 to 90, not 95");
    EXPECT_TRUE(Shown().AgeS) << "a pose has come";
    _pose->latitude_deg = 47;
    _pose->PostMessage();
    EXPECT_EQ(Shown().BadPosition, "");
    _clock->Advance(100ms);
    _pose->latitude_deg = 48;
    _pose->PostMessage();
    EXPECT_EQ(Shown().BadPosition, "it jumped 111 km in 0.1 s");
}

TEST_F(AircraftMonitor, LetsAnOldPoseGrowOld)
{
    _pose->PostMessage();
    Shown();
    _clock->Advance(20s);
    EXPECT_NEAR(*Shown().AgeS, 20, 1e-9);
}

TEST_F(AircraftMonitor, ShowsNoBatteryOfAnOldHealth)
{
    _health->battery_percent = 20;
    _health->PostMessage();
    _clock->Advance(3500ms);
    EXPECT_EQ(Shown().BatteryPercent, 20);
    _clock->Advance(1ms);
    EXPECT_EQ(Shown().BatteryPercent, std::nullopt);
}

TEST_F(AircraftMonitor, KeepsTheBatteryWithinAHundredPercent)
{
    _health->battery_percent = -1e30F;
    _health->PostMessage();
    EXPECT_EQ(Shown().BatteryPercent, 0);
    _health->battery_percent = 1e30F;
    _health->PostMessage();
    EXPECT_EQ(Shown().BatteryPercent, 100);
}

TEST_F(AircraftMonitor, ShowsTheMission)
{
    _mission->mode = Uav::MissionMode::MISSION_GOTO;
    _mission->last_command = 1'232'690'012;
    _mission->area_declined = "too low";
    _mission->PostMessage();
    _tally.first_id = 1'232'690'001;
    _tally.commands = 12;
    EXPECT_EQ(Shown().Mission, "GOTO 12") << "by the number that people know";
    EXPECT_EQ(Shown().AreaDeclined, "too low");
}

TEST_F(AircraftMonitor, HasNoNumberForACommandOfSomebodyElse)
{
    _mission->mode = Uav::MissionMode::MISSION_HOLD;
    _mission->last_command = 13;
    _mission->PostMessage();
    _tally.first_id = 1;
    _tally.commands = 12;
    EXPECT_EQ(Shown().Mission, "HOLD");
}

TEST_F(AircraftMonitor, CountsEveryArrivalEvenIfNobodyFetches)
{
    for (std::uint32_t number = 1; number <= 50; ++number)
    {
        _pose->number = number;
        _pose->PostMessage();
        if (number % 10 == 0)
        {
            _mission->poses = number;
            _mission->PostMessage();
        }
    }
    EXPECT_EQ(_monitor.Count().Published(), 40u);
    EXPECT_EQ(_monitor.Count().Heard(), 40u);
}

TEST(AircraftMonitorLife, EndsItsHandlersWithItself)
{
    Rabit::RabitWorkspace workspace;
    auto pose = std::make_shared<Uav::Pose>();
    workspace.AddPublishSubscribeMessage("uav1/Pose", pose);
    {
        const Ground::AircraftMonitor monitor("uav1", workspace);
    }
    EXPECT_NO_THROW(pose->PostMessage());
}

}  // namespace
