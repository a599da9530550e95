#include "Flight.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <sstream>

namespace
{
using Swarm::Between;
using Swarm::Circle;
using Swarm::Flight;
using Swarm::GeoPoint;
using Swarm::Motion;

const GeoPoint Home{49.2574, -123.2432, 50};

Swarm::Track TrackOf(const std::string &rows)
{
    std::istringstream text(
        "time_s,latitude_deg,longitude_deg,altitude_m,velocity_north_mps,velocity_east_mps,velocity_down_mps,"
        "roll_rad,pitch_rad,yaw_rad\n" +
        rows);
    return Swarm::Track::Parse(text, "track");
}

Swarm::Track StandingTrack()
{
    return TrackOf("0,49.2574,-123.2432,50,0,0,0,0,0,0\n");
}

double DistanceM(const GeoPoint &a, const GeoPoint &b)
{
    return Between(a, b).LengthM();
}

double LevelDistanceM(const GeoPoint &a, const GeoPoint &b)
{
    const auto way = Between(a, b);
    return std::hypot(way.NorthM, way.EastM);
}

double SpeedMps(const Motion &motion)
{
    return std::hypot(motion.NorthMps, motion.EastMps);
}

// Seconds from `start` until the flight holds; 1000 if it does not within that time.
double HoldsAfterS(Flight &flight, double start)
{
    for (double t = 0; t < 1000; t += 0.1)
    {
        flight.At(start + t);
        if (flight.Phase() == Uav::FlightPhase::FLIGHT_HOLD)
            return t;
    }
    return 1000;
}

TEST(Flight, OfAPatternStaysOnItsCircleAtItsSpeed)
{
    Flight flight(Circle{Home, 60, 8});
    for (double t = 0; t < 200; t += 0.7)
    {
        const Motion motion = flight.At(t);
        EXPECT_NEAR(DistanceM(Home, motion.Position), 60, 2) << "at " << t;
        EXPECT_NEAR(SpeedMps(motion), 8, 1e-6);
    }
    EXPECT_EQ(flight.Phase(), Uav::FlightPhase::FLIGHT_PATTERN);
}

TEST(Flight, OfATrackFollowsIt)
{
    Flight flight(StandingTrack());
    EXPECT_DOUBLE_EQ(flight.At(3).Position.AltitudeM, 50);
    EXPECT_EQ(flight.Phase(), Uav::FlightPhase::FLIGHT_RECORDING);
}

TEST(Flight, MovesAsItsVelocitySays)
{
    Flight flight(Circle{Home, 60, 8});
    flight.At(1);
    flight.FlyTo(Moved(Home, {300, -400, 30}), 16, 1);
    constexpr double Step = 0.01;
    Motion last = flight.At(1);
    for (double t = 1 + Step; t < 120; t += Step)
    {
        const Motion now = flight.At(t);
        const auto step = Between(last.Position, now.Position);
        // Within one step the velocity changes by the acceleration of the steepest turn, 7 m/s2, at most.
        ASSERT_NEAR(step.NorthM / Step, now.NorthMps, 0.15) << "at " << t;
        ASSERT_NEAR(step.EastM / Step, now.EastMps, 0.15) << "at " << t;
        ASSERT_NEAR(step.UpM / Step, -now.DownMps, 0.05) << "at " << t;
        last = now;
    }
}

TEST(Flight, NeverBanksRollsOrClimbsMoreThanAnAircraftCan)
{
    Flight flight(Circle{Home, 60, 8});
    Motion last = flight.At(0);
    for (int i = 1; i < 6000; ++i)
    {
        const double t = i * 0.05;
        if (i % 500 == 0)
            flight.FlyTo(Moved(Home, {i % 3 * 200.0, i % 7 * -90.0, i % 5 * 40.0}), 16, t);
        const Motion now = flight.At(t);
        EXPECT_LE(std::abs(now.RollRad), Swarm::Airframe::MaxBankRad + 1e-9);
        EXPECT_LE(std::abs(now.RollRad - last.RollRad), Swarm::Airframe::MaxRollRateRadps * 0.05 + 1e-9);
        EXPECT_LE(std::abs(now.DownMps), Swarm::Airframe::MaxClimbMps + 1e-9);
        EXPECT_LE(std::abs(SpeedMps(now) - SpeedMps(last)), 2.5 * 0.05 + 1e-9);
        last = now;
    }
}

TEST(Flight, NeverJumps)
{
    Flight flight(Circle{Home, 60, 8});
    Motion last = flight.At(0);
    for (int i = 1; i < 3000; ++i)
    {
        const double t = i * 0.1;
        if (i % 330 == 0)  // on the way as well as while holding
            flight.FlyTo(Moved(Home, {i % 3 * 50.0, i % 7 * 30.0, i % 5 * 4.0}), 12, t);
        if (i % 1000 == 0)
            flight.Release(t);
        const Motion now = flight.At(t);
        EXPECT_LT(DistanceM(last.Position, now.Position), 0.1 * (12 + 3)) << "at " << t;
        last = now;
    }
}

TEST(Flight, ToAPointKeepsItsSpeedOnTheWay)
{
    Flight flight(Circle{Home, 60, 8});
    flight.FlyTo(Moved(Home, {1000, 0, 0}), 16, 0);
    for (double t = 10; t < 50; t += 1)
        EXPECT_NEAR(SpeedMps(flight.At(t)), 16, 1e-6) << "at " << t;
    EXPECT_EQ(flight.Phase(), Uav::FlightPhase::FLIGHT_COURSE);
    EXPECT_LT(HoldsAfterS(flight, 50), 25);
}

TEST(Flight, HoldsOnACircleAroundThePointAndAtItsHeight)
{
    Flight flight(StandingTrack());
    const GeoPoint point = Moved(Home, {160, 80, 30});
    flight.FlyTo(point, 16, 0);
    const double holds = HoldsAfterS(flight, 0);
    ASSERT_LT(holds, 40);
    for (double t = holds + 15; t < holds + 200; t += 0.3)
    {
        const Motion motion = flight.At(t);
        EXPECT_NEAR(LevelDistanceM(point, motion.Position), Flight::HoldRadiusM, 3) << "at " << t;
        EXPECT_NEAR(motion.Position.AltitudeM, 80, 0.5);
        EXPECT_LE(SpeedMps(motion), Flight::MaxHoldSpeedMps + 1e-6);
        EXPECT_GT(motion.RollRad, 0) << "clockwise";
    }
}

TEST(Flight, ToThePointWhereItIsHoldsAroundIt)
{
    Flight flight(StandingTrack());
    flight.FlyTo(Home, 10, 0);
    flight.At(30);
    EXPECT_EQ(flight.Phase(), Uav::FlightPhase::FLIGHT_HOLD);
    EXPECT_NEAR(LevelDistanceM(Home, flight.At(60).Position), Flight::HoldRadiusM, 3);
}

TEST(Flight, HoldsUntilItIsToldOtherwise)
{
    Flight flight(StandingTrack());
    flight.FlyTo(Moved(Home, {100, 0, 0}), 10, 0);
    flight.At(3600);
    EXPECT_EQ(flight.Phase(), Uav::FlightPhase::FLIGHT_HOLD);
}

TEST(Flight, OfATrackGoesBackToItWhenReleased)
{
    Flight flight(StandingTrack());
    flight.FlyTo(Moved(Home, {300, 0, 0}), 12, 0);
    flight.Release(60);
    EXPECT_EQ(flight.Phase(), Uav::FlightPhase::FLIGHT_RECORDING);
    EXPECT_GT(DistanceM(Home, flight.At(62).Position), 100);
    EXPECT_NEAR(DistanceM(Home, flight.At(100).Position), 0, 0.01);
}

TEST(Flight, OfATrackNeverJumpsOnTheWayThereAndBack)
{
    // 10 m/s to the north, without end for this test.
    const GeoPoint far = Moved(Home, {5000, 0, 0});
    Flight flight(TrackOf("0,49.2574,-123.2432,50,10,0,0,0,0,0\n500," + std::to_string(far.LatitudeDeg) +
                          ",-123.2432,50,10,0,0,0,0,0\n"));
    Motion last = flight.At(0);
    for (int i = 1; i < 3000; ++i)
    {
        const double t = i * 0.1;
        if (i == 20)
            flight.FlyTo(Moved(Home, {190, -140, 12}), 9, t);
        if (i == 600)
            flight.Release(t);
        const Motion now = flight.At(t);
        EXPECT_LT(DistanceM(last.Position, now.Position), 5) << "at " << t;
        last = now;
    }
    EXPECT_NEAR(Between(Home, last.Position).NorthM, 2999, 1);
}

TEST(Flight, OfATrackIsNotDisturbedByARelease)
{
    Flight flight(StandingTrack());
    flight.Release(5);
    EXPECT_NEAR(DistanceM(Home, flight.At(5.1).Position), 0, 1e-9);
}

TEST(Flight, OfAPatternGoesBackToItWhenReleased)
{
    Flight flight(Circle{Home, 60, 8});
    flight.FlyTo(Moved(Home, {300, 0, 0}), 12, 0);
    flight.Release(60);
    EXPECT_EQ(flight.Phase(), Uav::FlightPhase::FLIGHT_PATTERN);
    EXPECT_NEAR(LevelDistanceM(Home, flight.At(200).Position), 60, 3);
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
