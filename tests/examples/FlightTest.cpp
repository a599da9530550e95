#include "Flight.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <sstream>

namespace
{
using Swarm::Between;
using Swarm::Flight;
using Swarm::FlightPhase;
using Swarm::GeoPoint;
using Swarm::Motion;
using Swarm::Pattern;

const GeoPoint Home{49.2574, -123.2432, 50};

Swarm::Track StandingTrack()
{
    std::istringstream text(
        "time_s,latitude_deg,longitude_deg,altitude_m,velocity_north_mps,velocity_east_mps,velocity_down_mps,"
        "roll_rad,pitch_rad,yaw_rad\n0,49.2574,-123.2432,50,0,0,0,0,0,0\n");
    return Swarm::Track::Parse(text, "track");
}

double DistanceM(const GeoPoint &a, const GeoPoint &b)
{
    return Between(a, b).LengthM();
}

// The largest difference between the reported velocity and the one that the positions show, from time a to b.
double WorstVelocityError(Flight &flight, double a, double b)
{
    double worst = 0;
    constexpr double Step = 0.01;
    Motion last = flight.At(a);
    for (double t = a + Step; t < b; t += Step)
    {
        const Motion now = flight.At(t);
        const auto step = Between(last.Position, now.Position);
        worst =
            std::max({worst, std::abs(step.NorthM / Step - last.NorthMps),
                      std::abs(step.EastM / Step - last.EastMps), std::abs(step.UpM / Step + last.DownMps)});
        last = now;
    }
    return worst;
}

TEST(Flight, OfAPatternStaysOnItsCircleAtItsSpeed)
{
    Flight flight(Pattern{Home, 60, 8});
    for (double t = 0; t < 100; t += 0.7)
    {
        const Motion motion = flight.At(t);
        EXPECT_NEAR(DistanceM(Home, motion.Position), 60, 0.01);
        EXPECT_NEAR(std::hypot(motion.NorthMps, motion.EastMps), 8, 1e-9);
    }
    EXPECT_EQ(flight.Phase(), FlightPhase::Pattern);
}

TEST(Flight, OfAPatternMovesAsItsVelocitySays)
{
    Flight flight(Pattern{Home, 60, 8});
    EXPECT_LT(WorstVelocityError(flight, 0, 60), 0.02);
}

TEST(Flight, OfATrackFollowsIt)
{
    Flight flight(StandingTrack());
    EXPECT_DOUBLE_EQ(flight.At(3).Position.AltitudeM, 50);
    EXPECT_EQ(flight.Phase(), FlightPhase::Track);
}

TEST(Flight, ToAPointTakesAsLongAsItsSpeedSays)
{
    Flight flight(StandingTrack());
    const GeoPoint point = Moved(Home, {120, 0, 0});  // 100 m to the circle of 20 m around it
    flight.FlyTo(point, 5, 10);
    flight.At(29.9);
    EXPECT_EQ(flight.Phase(), FlightPhase::Goto);
    flight.At(30.1);
    EXPECT_EQ(flight.Phase(), FlightPhase::Hold);
}

TEST(Flight, ToAPointMovesAsItsVelocitySays)
{
    Flight flight(StandingTrack());
    flight.FlyTo(Moved(Home, {60, 80, 30}), 10, 0);
    EXPECT_LT(WorstVelocityError(flight, 0, 8), 0.02);
    EXPECT_NEAR(flight.At(1).DownMps, -10.0 * 30 / std::hypot(80, 30), 0.05);
    EXPECT_NEAR(flight.At(1).YawRad, std::atan2(80, 60), 1e-3);
}

TEST(Flight, HoldsOnACircleAroundThePointAndAtItsHeight)
{
    Flight flight(StandingTrack());
    const GeoPoint point = Moved(Home, {60, 80, 30});
    flight.FlyTo(point, 10, 0);
    for (double t = 8.6; t < 13; t += 0.3)
    {
        const Motion motion = flight.At(t);
        EXPECT_NEAR(DistanceM(point, motion.Position), Flight::HoldRadiusM, 0.01);
        EXPECT_DOUBLE_EQ(motion.Position.AltitudeM, 80);
    }
}

TEST(Flight, HoldsNoFasterThanTheHoldSpeed)
{
    Flight flight(StandingTrack());
    flight.FlyTo(Moved(Home, {100, 0, 0}), 40, 0);
    const Motion motion = flight.At(4);
    EXPECT_NEAR(std::hypot(motion.NorthMps, motion.EastMps), Flight::MaxHoldSpeedMps, 1e-9);
}

TEST(Flight, OfATrackGoesBackToItAfterACommand)
{
    Flight flight(StandingTrack());
    flight.FlyTo(Moved(Home, {120, 0, 0}), 10,
                 0);  // there at 10 s, held until 15 s, 120 m or so back at 10 m/s
    flight.At(14.9);
    EXPECT_EQ(flight.Phase(), FlightPhase::Hold);
    flight.At(15.1);
    EXPECT_EQ(flight.Phase(), FlightPhase::Track);
    EXPECT_GT(DistanceM(Home, flight.At(16).Position), 50);
    EXPECT_NEAR(DistanceM(Home, flight.At(30).Position), 0, 0.01);
}

TEST(Flight, OfATrackNeverJumpsOnTheWayThereAndBack)
{
    Flight flight(StandingTrack());
    Motion last = flight.At(0);
    for (int i = 1; i < 600; ++i)
    {
        if (i == 20)
            flight.FlyTo(Moved(Home, {90, -40, 12}), 9, i * 0.1);
        const Motion now = flight.At(i * 0.1);
        EXPECT_LT(DistanceM(last.Position, now.Position), 1.0) << "at " << i * 0.1;
        last = now;
    }
}

TEST(Flight, OfAPatternHoldsUntilItIsToldOtherwise)
{
    Flight flight(Pattern{Home, 60, 8});
    flight.FlyTo(Moved(Home, {100, 0, 0}), 10, 0);
    flight.At(3600);
    EXPECT_EQ(flight.Phase(), FlightPhase::Hold);
}

TEST(Flight, NeverJumps)
{
    Flight flight(Pattern{Home, 60, 8});
    Motion last = flight.At(0);
    for (int i = 1; i < 1200; ++i)
    {
        const double t = i * 0.1;
        if (i % 130 == 0)  // on the way as well as while holding
            flight.FlyTo(Moved(Home, {i % 3 * 50.0, i % 7 * 30.0, i % 5 * 4.0}), 12, t);
        const Motion now = flight.At(t);
        EXPECT_LT(DistanceM(last.Position, now.Position), 12 * 0.1 + 0.01) << "at " << t;
        last = now;
    }
}

TEST(Flight, ToThePointWhereItIsLeavesForTheCircleAroundIt)
{
    Flight flight(StandingTrack());
    flight.FlyTo(Home, 10, 0);
    EXPECT_NEAR(DistanceM(Home, flight.At(1).Position), 10, 0.01);
    EXPECT_NEAR(DistanceM(Home, flight.At(5).Position), Flight::HoldRadiusM, 0.01);
}

TEST(Geo, MovedIsTheOppositeOfBetween)
{
    const GeoPoint there = Moved(Home, {300, -400, 12});
    const auto way = Between(Home, there);
    EXPECT_NEAR(way.NorthM, 300, 1e-6);
    EXPECT_NEAR(way.EastM, -400, 1e-6);
    EXPECT_NEAR(way.UpM, 12, 1e-9);
}

TEST(Geo, WrapRadKeepsTheAngle)
{
    EXPECT_NEAR(Swarm::WrapRad(3 * std::numbers::pi / 2), -std::numbers::pi / 2, 1e-12);
    EXPECT_NEAR(Swarm::WrapRad(-0.25 - 4 * std::numbers::pi), -0.25, 1e-12);
}

}  // namespace
