#include "PlanGoto.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace
{
using Ground::PlanGoto;

Uav::Pose At(double latitude, double longitude, double altitude)
{
    Uav::Pose pose;
    pose.latitude_deg = latitude;
    pose.longitude_deg = longitude;
    pose.altitude_m = altitude;
    return pose;
}

TEST(PlanGoto, SendsTheAircraft50MetresAway)
{
    for (std::uint32_t id = 1; id < 20; ++id)
    {
        const Uav::Goto command = PlanGoto(At(49, -123, 50), id);
        const double north = (command.latitude_deg - 49) * 111195;
        const double east = (command.longitude_deg + 123) * 111195 * std::cos(49 * std::numbers::pi / 180);
        EXPECT_NEAR(std::hypot(north, east), 50, 0.1);
        EXPECT_EQ(command.id, id);
    }
}

TEST(PlanGoto, TakesAnotherDirectionEachTime)
{
    const Uav::Goto first = PlanGoto(At(49, -123, 50), 1);
    const Uav::Goto second = PlanGoto(At(49, -123, 50), 2);
    EXPECT_GT(std::abs(first.latitude_deg - second.latitude_deg), 1e-5);
}

TEST(PlanGoto, StaysAboveTheGround)
{
    for (std::uint32_t id = 1; id < 4; ++id)
        EXPECT_GE(PlanGoto(At(49, -123, 0), id).altitude_m, 20);
}

TEST(PlanGoto, StaysOnTheEarth)
{
    for (std::uint32_t id = 1; id < 20; ++id)
    {
        const Uav::Goto command = PlanGoto(At(90, 180, 50), id);
        EXPECT_LE(std::abs(command.latitude_deg), 90);
        EXPECT_LE(std::abs(command.longitude_deg), 180);
    }
}

}  // namespace
