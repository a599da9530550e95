// A fleet's reports of its targets, counted against the truth.
#include "FleetTargets.h"
#include "TrackingFleet.h"
#include "TrackingScore.h"

#include <gtest/gtest.h>

#include <array>
#include <cstdint>
#include <iostream>
#include <numbers>
#include <vector>

namespace
{
using SwarmTest::TrackingFleet;
using SwarmTest::TrackingScore;

// Without optimization Eigen takes a hundred times as long. Such builds check memory and undefined
// behaviour only, on few flights whose figures mean nothing.
#ifdef NDEBUG
constexpr std::uint64_t Flights = 50;
#else
constexpr std::uint64_t Flights = 1;
#endif

// Returns the list of a ground station that hears all aircraft.
std::vector<Ground::ListedTarget> ListOf(const TrackingFleet &fleet)
{
    std::array<Uav::Targets, TrackingFleet::Aircraft> targets;
    std::vector<Ground::SaidOfTargets> said;
    for (int i = 0; i < TrackingFleet::Aircraft; ++i)
    {
        Uav::Targets &own = targets[static_cast<std::size_t>(i)];
        own = fleet.ReportOf(i);
        said.push_back({TrackingFleet::NameOf(i), &own});
    }
    return Ground::ListTargets(said);
}

TrackingScore Fly(std::uint64_t seed, const Swarm::World &world, double seconds)
{
    TrackingFleet fleet(seed, world);
    TrackingScore score;
    while (fleet.TimeS() < seconds)
    {
        fleet.Step();
        score.Sample(fleet, ListOf(fleet));
    }
    return score;
}

// Prints the figures, to help when the filter is changed.
void Print(const char *what, const TrackingScore &score)
{
    std::cout << what << ": one name too many for " << 100 * score.Duplicates()
              << " % of the time of a target, precision " << score.Precision() << ", recall "
              << score.Recall() << ", identity switches " << score.SwitchesPerHour()
              << " for each target and hour\n";
}

Swarm::WorldTarget TargetAt(double northM, double eastM)
{
    Swarm::WorldTarget target;
    target.Start = Swarm::Moved(SwarmTest::Middle, {northM, eastM, 0});
    return target;
}

// 50 m there and back, again and again.
Swarm::WorldTarget WalkerAt(double northM, double eastM, double headingRad)
{
    Swarm::WorldTarget target = TargetAt(northM, eastM);
    target.SpeedMps = 1.2;
    target.HeadingRad = headingRad;
    target.LengthM = 50;
    return target;
}

TEST(Tracking, NamesTargetsThatAreFarApartOnceEach)
{
    TrackingScore all;
    for (std::uint64_t seed = 1; seed <= Flights; ++seed)
    {
        Swarm::World world;
        world.GroundM = 430;
        const double turn = static_cast<double>(seed);
        world.Targets = {TargetAt(-110, -150), WalkerAt(0, 20, turn), TargetAt(110, -140),
                         WalkerAt(-60, 140, turn + 1)};
        all.Add(Fly(seed, world, 600));
    }
    Print("far apart", all);
    if (Flights < 50)
        return;
    EXPECT_LE(all.Duplicates(), 0.01);
    EXPECT_GE(all.Precision(), 0.95);
    EXPECT_GE(all.Recall(), 0.95);
    EXPECT_LE(all.SwitchesPerHour(), 2);
}

// Eight targets on ten hectares. Five of them walk, two of these across each other's way. After half a
// minute out of sight, these two cannot always be told apart.
TEST(Tracking, SeesThroughACrowd)
{
    TrackingScore all;
    for (std::uint64_t seed = 1; seed <= Flights; ++seed)
        all.Add(Fly(seed, TrackingFleet::RandomWorld(seed), 600));
    Print("crowd", all);
    if (Flights < 50)
        return;
    EXPECT_LE(all.Duplicates(), 0.03);
    EXPECT_GE(all.Precision(), 0.95);
    EXPECT_GE(all.Recall(), 0.95);
    EXPECT_LE(all.SwitchesPerHour(), 20);
}

TEST(Tracking, KeepsTwoThatCrossEachOthersWayTwo)
{
    TrackingScore all;
    for (std::uint64_t seed = 1; seed <= Flights; ++seed)
    {
        Swarm::World world;
        world.GroundM = 430;
        const double quarter = std::numbers::pi / 2;
        world.Targets = {WalkerAt(-25, 0, 0), WalkerAt(0, -25, quarter)};
        all.Add(Fly(seed, world, 300));
    }
    Print("crossing", all);
    if (Flights < 50)
        return;
    EXPECT_LE(all.Duplicates(), 0.03);
    EXPECT_GE(all.Precision(), 0.95);
    EXPECT_GE(all.Recall(), 0.95);
}

}  // namespace
