#include "vision/TargetTable.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/LU>
#include <cmath>
#include <limits>

#include <random>
#include <vector>

namespace
{
using Swarm::Between;
using Swarm::GeoPoint;
using Swarm::Offset;
using Swarm::TargetFilter;
using Swarm::TargetTable;

const GeoPoint Field{47.4, 8.5, 0};
constexpr double Start = 1.4e9;

class Table : public testing::Test
{
protected:
    TargetTable _table{"uav1"};
    std::mt19937_64 _random{1};

    // One frame of a camera that sees targets at these places.
    void See(double time, const std::vector<Offset> &places, const std::string &by = "uav1",
             double noiseM = 0)
    {
        Uav::Detections frame;
        frame.seen_by = by;
        frame.pose.latitude_deg = Field.LatitudeDeg;
        frame.pose.longitude_deg = Field.LongitudeDeg;
        frame.pose.gps_time_s = Start + time;
        std::normal_distribution<double> noise(0, noiseM > 0 ? noiseM : 1);
        for (Offset place : places)
        {
            if (noiseM > 0)
            {
                place.NorthM += noise(_random);
                place.EastM += noise(_random);
            }
            const GeoPoint point = Moved(Field, place);
            Uav::Detection detection;
            detection.latitude_deg = point.LatitudeDeg;
            detection.longitude_deg = point.LongitudeDeg;
            detection.sigma_m = 2.4f;
            frame.items.push_back(detection);
        }
        _table.Add(frame);
    }
    std::vector<Uav::Target> At(double time)
    {
        Uav::Targets targets;
        _table.Report(Start + time, targets);
        EXPECT_EQ(targets.gps_time_s, Start + time);
        return targets.items;
    }
    static Offset PlaceOf(const Uav::Target &target)
    {
        return Between(Field, {target.latitude_deg, target.longitude_deg, 0});
    }
};

TEST_F(Table, ReportsATargetOnceItWasSeenOftenEnough)
{
    for (int i = 0; i < 3; ++i)
    {
        See(i * 0.5, {{10, 20, 0}});
        EXPECT_TRUE(At(i * 0.5).empty());
    }
    See(1.5, {{10, 20, 0}});
    const auto targets = At(1.5);
    ASSERT_EQ(targets.size(), 1u);
    EXPECT_EQ(targets[0].name.number, 1u);
    EXPECT_NEAR(PlaceOf(targets[0]).NorthM, 10, 0.1);
    EXPECT_NEAR(PlaceOf(targets[0]).EastM, 20, 0.1);
    EXPECT_EQ(targets[0].detections, 4u);
}

TEST_F(Table, NeverReportsFalseAlarms)
{
    std::uniform_real_distribution<double> anywhere(-40, 40);
    for (int i = 0; i < 2000; ++i)  // far more of them than a camera has
        if (i % 4 == 0)
            See(i * 0.5, {{anywhere(_random), anywhere(_random), 0}});
    EXPECT_TRUE(At(1000).empty());
}

TEST_F(Table, TellsWhoFoundATargetAndWhoHasSeenIt)
{
    See(0, {{10, 20, 0}}, "uav2");
    for (int i = 1; i < 5; ++i)
        See(i * 0.5, {{10, 20, 0}}, "uav1");
    See(3, {{10, 20, 0}}, "uav3");
    EXPECT_TRUE(At(3).empty()) << "uav2, which found it, is to name it";
    _table.Tell(Start + 4);
    const auto targets = At(3);
    ASSERT_EQ(targets.size(), 1u);
    EXPECT_EQ(targets[0].found_by, "uav2");
    EXPECT_THAT(targets[0].seen_by, testing::ElementsAre("uav2", "uav1", "uav3"));
    EXPECT_EQ(targets[0].own_detections, 4u);
    EXPECT_EQ(targets[0].own_gps_time_s, Start + 2);
    EXPECT_EQ(targets[0].seen_gps_time_s, Start + 3);
    EXPECT_EQ(targets[0].detections, 6u);
}

TEST_F(Table, KeepsTwoTargetsApart)
{
    for (int i = 0; i < 10; ++i)
        See(i * 0.5, {{0, 0, 0}, {0, 25, 0}}, "uav1", 2.4);
    const auto targets = At(5);
    ASSERT_EQ(targets.size(), 2u);
    EXPECT_NEAR(std::abs(PlaceOf(targets[0]).EastM - PlaceOf(targets[1]).EastM), 25, 6);
}

// The filter's covariance fits its errors: over N independent targets, the mean normalized error lies
// within three standard deviations (2 / sqrt N) of 2.
TEST_F(Table, IsAsUncertainAsItIsWrong)
{
    constexpr int targets = 400;
    double sum = 0;
    for (int n = 0; n < targets; ++n)
    {
        TargetFilter filter({0, 0}, 3, 0);
        std::normal_distribution<double> noise(0, 3);
        std::normal_distribution<double> speed(0, TargetFilter::StartSpeedSigmaMps);
        std::normal_distribution<double> push(0, std::sqrt(TargetFilter::NoiseM2ps3 * 0.5));
        Eigen::Vector2d velocity(speed(_random), speed(_random));
        Eigen::Vector2d place(noise(_random), noise(_random));
        for (int i = 1; i <= 20; ++i)
        {
            place += velocity * 0.5;
            velocity += Eigen::Vector2d(push(_random), push(_random));
            filter.Update(place + Eigen::Vector2d(noise(_random), noise(_random)), 3, i * 0.5);
        }
        const auto estimate = filter.At(10);
        const Eigen::Vector2d error = estimate.Position() - place;
        const Eigen::Matrix2d inverse = estimate.PositionCovariance().inverse();
        sum += error.dot(inverse * error);
    }
    EXPECT_NEAR(sum / targets, 2, 3 * 2 / std::sqrt(targets));
}

TEST_F(Table, FollowsAWalkingTarget)
{
    for (int i = 0; i < 60; ++i)
        See(i * 0.5, {{1.2 * i * 0.5, 0, 0}}, "uav1", 2.4);
    const auto targets = At(30);
    ASSERT_EQ(targets.size(), 1u);
    EXPECT_NEAR(targets[0].velocity_north_mps, 1.2, 0.6);
    EXPECT_LT(std::hypot(PlaceOf(targets[0]).NorthM - 36, PlaceOf(targets[0]).EastM),
              3 * targets[0].sigma_major_m);
}

TEST_F(Table, KnowsATargetAgainThatItHasNotSeenForAWhile)
{
    for (int i = 0; i < 6; ++i)
        See(i * 0.5, {{0, 0, 0}});
    for (int i = 0; i < 6; ++i)
        See(60 + i * 0.5, {{5, 5, 0}});
    EXPECT_EQ(At(63).size(), 1u);
}

TEST_F(Table, IsLessSureOfATargetTheLongerItIsUnseen)
{
    for (int i = 0; i < 6; ++i)
        See(i * 0.5, {{0, 0, 0}});
    EXPECT_LT(At(3)[0].sigma_major_m, At(10)[0].sigma_major_m);
    EXPECT_LT(At(10)[0].sigma_major_m, At(100)[0].sigma_major_m);
    EXPECT_NEAR(PlaceOf(At(100)[0]).NorthM, 0, 1) << "it lingers";
}

TEST_F(Table, ForgetsWhatIsNotSeenForLong)
{
    for (int i = 0; i < 6; ++i)
        See(i * 0.5, {{0, 0, 0}});
    See(TargetTable::ForgetAfterS + 1, {{500, 0, 0}});
    EXPECT_EQ(At(TargetTable::ForgetAfterS + 2).size(), 1u);
    See(TargetTable::ForgetAfterS + 4, {{500, 0, 0}});
    EXPECT_TRUE(At(TargetTable::ForgetAfterS + 5).empty());
}

TEST_F(Table, NeverGivesANumberAgain)
{
    for (int i = 0; i < 6; ++i)
        See(i * 0.5, {{0, 0, 0}});
    for (int i = 0; i < 6; ++i)
        See(1400 + i * 0.5, {{0, 0, 0}});
    ASSERT_EQ(At(1403).size(), 1u);
    EXPECT_EQ(At(1403)[0].name.number, 2u);
}

// Returns a report of uav2 with a target at this place.
Uav::Targets ToldBy2(double time, double northM, double sinceS, std::uint32_t number)
{
    const GeoPoint point = Moved(Field, {northM, 0, 0});
    Uav::Target target;
    target.name.aircraft = "uav2";
    target.name.number = number;
    target.name.since_gps_time_s = Start + sinceS;
    target.found_by = "uav2";
    target.latitude_deg = point.LatitudeDeg;
    target.longitude_deg = point.LongitudeDeg;
    target.sigma_major_m = target.sigma_minor_m = 2;
    target.seen_gps_time_s = Start + time;
    target.detections = 9;
    target.seen_by = {"uav2"};
    Uav::Targets told;
    told.told_by = "uav2";
    told.gps_time_s = Start + time;
    told.items = {target};
    return told;
}

class TableThatHears : public Table
{
protected:
    void SetUp() override
    {
        for (int i = 0; i < 6; ++i)
            See(10 + i * 0.5, {{0, 0, 0}});
    }
};

TEST_F(TableThatHears, CallsATargetByTheOlderNameAndKeepsTheOtherAsAFormerOne)
{
    _table.Hear(ToldBy2(12.5, 1, 3, 4));
    const auto targets = At(13);
    ASSERT_EQ(targets.size(), 1u);
    EXPECT_EQ(targets[0].name.aircraft, "uav2");
    EXPECT_EQ(targets[0].name.number, 4u);
    ASSERT_EQ(targets[0].formerly.size(), 1u);
    EXPECT_EQ(targets[0].formerly[0].aircraft, "uav1");
}

TEST_F(TableThatHears, KeepsItsOwnNameIfThatIsOlderAndSaysSo)
{
    _table.Tell(Start + 12.5);
    _table.Hear(ToldBy2(12.5, 1, 12, 4));
    ASSERT_EQ(At(13).size(), 1u);
    EXPECT_EQ(At(13)[0].name.aircraft, "uav1");
    const Uav::Targets told = _table.Tell(Start + 12.6);
    ASSERT_EQ(told.items.size(), 1u);
    EXPECT_EQ(told.items[0].formerly.at(0).aircraft, "uav2");
}

TEST_F(TableThatHears, KnowsATargetThatOnlyAnotherAircraftHasSeen)
{
    _table.Hear(ToldBy2(12.5, 150, 3, 4));
    ASSERT_EQ(At(13).size(), 2u);
    for (int i = 0; i < 6; ++i)
        See(15 + i * 0.5, {{150, 0, 0}});
    ASSERT_EQ(At(18).size(), 2u);
    EXPECT_EQ(At(18)[1].name.aircraft, "uav2") << "it is still called that when its own camera sees it";
}

TEST_F(TableThatHears, GivesNoNumberThatItGaveInAnEarlierLife)
{
    Uav::Targets told = ToldBy2(12.5, 150, 3, 7);
    told.items[0].name.aircraft = "uav1";
    _table.Hear(told);
    for (int i = 0; i < 6; ++i)
        See(15 + i * 0.5, {{-200, 0, 0}});
    EXPECT_EQ(At(18).back().name.number, 8u);
}

TEST_F(TableThatHears, NeverTakesForOneWhatAnotherHasSeenSideBySide)
{
    Uav::Targets told = ToldBy2(12.5, 12, 3, 4);
    told.items[0].beside = {At(12)[0].name};
    _table.Hear(told);
    EXPECT_EQ(At(13).size(), 2u);
    told.items[0].latitude_deg = Field.LatitudeDeg;
    _table.Hear(told);
    EXPECT_EQ(At(13).size(), 2u);
}

TEST_F(TableThatHears, TellsANewcomerAllNames)
{
    _table.Tell(Start + 12.5);
    EXPECT_TRUE(_table.Tell(Start + 13).items.empty());
    See(13, {{300, 0, 0}}, "uav3");
    EXPECT_EQ(_table.Tell(Start + 13).items.size(), 1u);
}

TEST_F(TableThatHears, DropsWhatMakesNoSense)
{
    const double nan = std::numeric_limits<double>::quiet_NaN();
    for (const auto &spoil :
         std::vector<void (*)(Uav::Target &)>{
             [](Uav::Target &target) { target.name.aircraft.clear(); },
             [](Uav::Target &target) { target.name.number = 0; },
             [](Uav::Target &target) { target.name.number = 4'000'000'000; },
             [](Uav::Target &target) { target.name.since_gps_time_s = std::nan(""); },
             [](Uav::Target &target) { target.name.since_gps_time_s += 1000; },
             [](Uav::Target &target) { target.latitude_deg = std::nan(""); },
             [](Uav::Target &target) { target.longitude_deg += 100; },
             [](Uav::Target &target) { target.sigma_major_m = -1; },
             [](Uav::Target &target) { target.seen_gps_time_s = std::nan(""); }})
    {
        Uav::Targets told = ToldBy2(12.5, 150, 3, 4);
        spoil(told.items[0]);
        _table.Hear(told);
    }
    _table.Hear(ToldBy2(nan, 150, 3, 4));
    EXPECT_EQ(At(13).size(), 1u);
    EXPECT_EQ(_table.Dropped(), 10u);
}

TEST_F(Table, IsBounded)
{
    for (int row = 0; row < 100; ++row)
        for (int i = 0; i < 4; ++i)
            See(row * 2 + i * 0.5, {{row * 100.0, 0, 0}});
    const auto targets = At(200);
    EXPECT_EQ(targets.size(), TargetTable::MaxTargets);
    EXPECT_EQ(targets.back().name.number, 100u) << "the longest unseen ones went";
}

TEST_F(Table, DropsWhatMakesNoSense)
{
    const double nan = std::numeric_limits<double>::quiet_NaN();
    See(0, {{0, 0, 0}});
    See(nan, {{0, 0, 0}});
    See(1, {{nan, 0, 0}});
    See(2, {{1e7, 0, 0}});
    See(-10, {{0, 0, 0}});
    EXPECT_EQ(_table.Dropped(), 4u);
}

}  // namespace
