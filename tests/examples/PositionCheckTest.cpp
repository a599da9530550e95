#include "PositionCheck.h"

#include <gtest/gtest.h>

#include <limits>
#include <string>

namespace
{
constexpr double NaN = std::numeric_limits<double>::quiet_NaN();

class PositionCheck : public testing::Test
{
protected:
    Ground::PositionCheck _check;
    Uav::Pose _pose;
    double _nowS = 100;

    void SetUp() override
    {
        _pose.latitude_deg = 47.4;
        _pose.longitude_deg = 8.5;
        _pose.altitude_m = 500;
        _pose.velocity_north_mps = 16;
    }
    // Returns the verdict on the pose so long after the last one.
    std::string After(double seconds)
    {
        _nowS += seconds;
        ++_pose.number;
        return _check.Look(_pose, _nowS);
    }
};

TEST_F(PositionCheck, TellsWhichNumberIsOutOfRange)
{
    _pose.latitude_deg = 95;
    EXPECT_EQ(After(0), "latitude must be from -90 to 90, not 95");
    _pose.latitude_deg = 47.4;
    _pose.longitude_deg = -180.5;
    EXPECT_EQ(After(0), "longitude must be from -180 to 180, not -180.5");
    _pose.longitude_deg = 8.5;
    _pose.altitude_m = 1e300;
    EXPECT_EQ(After(0), "altitude must be from -1000 to 30000, not 1e+300");
}

TEST_F(PositionCheck, TellsWhichNumberIsNone)
{
    for (double Uav::Pose::*const number :
         {&Uav::Pose::latitude_deg, &Uav::Pose::longitude_deg, &Uav::Pose::altitude_m})
    {
        Uav::Pose pose = _pose;
        pose.*number = NaN;
        EXPECT_NE(Ground::WhyImpossible(pose), "");
        pose.*number = -std::numeric_limits<double>::infinity();
        EXPECT_NE(Ground::WhyImpossible(pose), "");
    }
    EXPECT_EQ(Ground::WhyImpossible(_pose), "");
}

TEST_F(PositionCheck, BelievesAFlight)
{
    for (int i = 0; i < 100; ++i)
    {
        EXPECT_EQ(After(0.1), "");
        _pose.latitude_deg += 1.6 / 111195;
    }
    _pose.latitude_deg += 600 * 16.0 / 111195;
    EXPECT_EQ(After(600), "") << "it was out of reach meanwhile";
}

TEST_F(PositionCheck, BelievesARecordedFlightThatIsPlayedFast)
{
    for (int i = 0; i < 10; ++i)
    {
        EXPECT_EQ(After(1), "");
        _pose.latitude_deg += 100 * 16.0 / 111195;
        _pose.gps_time_s += 100;
    }
    _pose.latitude_deg += 0.54;
    _pose.gps_time_s = 1e9;
    EXPECT_EQ(After(1), "it jumped 62 km in 1.0 s") << "a clock that is wrong explains nothing";
}

TEST_F(PositionCheck, DoubtsAJumpThatNoSpeedExplains)
{
    EXPECT_EQ(After(0), "");
    _pose.latitude_deg += 0.54;
    EXPECT_EQ(After(0.1), "it jumped 60 km in 0.1 s");
    _pose.latitude_deg -= 0.54;
    EXPECT_EQ(After(0.1), "") << "it is where it was";
}

TEST_F(PositionCheck, DoubtsAJumpInHeight)
{
    EXPECT_EQ(After(0), "");
    _pose.altitude_m = 5500;
    EXPECT_EQ(After(0.1), "it jumped 5000 m in 0.1 s");
}

TEST_F(PositionCheck, ExplainsNoJumpByASpeedThatIsNone)
{
    EXPECT_EQ(After(0), "");
    _pose.latitude_deg += 0.54;
    for (const float speed : {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::max()})
    {
        _pose.velocity_north_mps = speed;
        EXPECT_NE(After(0.1), "");
    }
}

TEST_F(PositionCheck, BelievesAJumpOnceThePositionsAfterItAgree)
{
    EXPECT_EQ(After(0), "");
    _pose.latitude_deg += 0.54;
    EXPECT_NE(After(0.1), "");
    EXPECT_NE(After(Ground::PositionCheck::JumpBelievedS - 0.2), "");
    EXPECT_EQ(After(0.4), "");
    EXPECT_EQ(After(0.1), "");
}

TEST_F(PositionCheck, NeverBelievesPositionsThatDoNotAgree)
{
    EXPECT_EQ(After(0), "");
    for (int i = 0; i < 100; ++i)
    {
        _pose.latitude_deg = i % 2 == 0 ? 50 : 52;
        EXPECT_NE(After(0.5), "");
    }
}

TEST_F(PositionCheck, BelievesTheFirstPositionAfterARestart)
{
    _pose.number = 700;
    EXPECT_EQ(After(0), "");
    _pose.latitude_deg += 0.54;
    _pose.number = 0;
    EXPECT_EQ(After(0.1), "");
}

TEST_F(PositionCheck, TakesNoFixForNeitherAPositionNorAJump)
{
    EXPECT_EQ(After(0), "");
    const Uav::Pose before = _pose;
    _pose.latitude_deg = _pose.longitude_deg = 0;
    EXPECT_EQ(After(0.1), "");
    _pose = before;
    EXPECT_EQ(After(0.1), "");
    _pose.latitude_deg += 0.54;
    EXPECT_NE(After(0.1), "");
}

TEST_F(PositionCheck, BelievesAFlightAcrossTheAntimeridian)
{
    _pose.longitude_deg = 179.9999;
    EXPECT_EQ(After(0), "");
    _pose.longitude_deg = -179.9999;
    EXPECT_EQ(After(0.1), "");
}

}  // namespace
