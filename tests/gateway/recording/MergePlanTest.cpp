// Recordings of nodes whose clocks are known: the times on the time line must be right within the stated
// bound.
#include "recording/merge/MergePlan.h"

#include <gmock/gmock.h>
#include <rabit/mcap/MessageCursor.h>

#include <array>
#include <tuple>

#include "SyntheticFleet.h"

namespace Rabit::Merge
{
namespace
{

using testing::HasSubstr;
using Time = SyntheticFleet::Time;

constexpr Time Ms = 1000000;
constexpr Time Minute = 60 * OneSecond;

Time Uniform(std::mt19937 &random, Time from, Time to)
{
    return std::uniform_int_distribution<Time>(from, to)(random);
}

// The same delays in both directions, with some jitter.
SyntheticFleet::Network Delays(Time least, Time most)
{
    return [least, most](std::size_t, std::size_t, Time, std::mt19937 &random)
    { return std::optional(Uniform(random, least, most)); };
}

struct Plans
{
    Plans(const SyntheticFleet &fleet, const MergeWishes &wishes)
        : All(ReadLives(fleet.Opener(), fleet.Paths())), Plan(MakePlan(All, wishes))
    {
    }
    std::size_t LifeOf(const std::string &node, std::uint64_t incarnation) const
    {
        for (std::size_t life = 0; life < All.All.size(); ++life)
        {
            if (All.All[life].Node == node && All.All[life].Incarnation == incarnation)
            {
                return life;
            }
        }
        ADD_FAILURE() << "no life of " << node;
        return 0;
    }

    const Lives All;
    const MergePlan Plan;
};

struct Errors
{
    Time Worst = 0;
    std::size_t Beyond = 0;  // messages with a larger error than is stated
    std::size_t Messages = 0;
    Time WorstBound = 0;
};

// Returns the errors of all messages that the node posted, against the clock of the other one.
Errors ErrorsOf(const SyntheticFleet &fleet, const Plans &plans, std::size_t life, std::size_t timeLine)
{
    Errors errors;
    const TimeMap &map = plans.Plan.Lives[life].Map;
    for (const LifeFile &file : plans.All.All[life].Files)
    {
        const auto source = fleet.Opener()(file.Path);
        Mcap::MessageCursor cursor(*source, file.Contents, {});
        while (const auto message = cursor.Next())
        {
            const Mcap::Channel &channel = file.Contents.Channels.at(message->ChannelId);
            if (channel.Metadata.at("rabit.kind") != "posted")
            {
                continue;
            }
            const Time expected = fleet.LogAt(timeLine, SyntheticFleet::PostedOf(message->Data));
            const Time error = Apart(map.At(FromFile(message->PublishTime)), expected);
            const Time bound = map.BoundAt(FromFile(message->PublishTime)).value_or(0);
            errors.Worst = std::max(errors.Worst, error);
            errors.WorstBound = std::max(errors.WorstBound, bound);
            errors.Beyond += error > bound ? 1 : 0;
            ++errors.Messages;
        }
    }
    return errors;
}

SyntheticFleet::Spec Node(const std::string &name, Time end, Time wallAhead = 0, double rate = 0)
{
    SyntheticFleet::Spec spec;
    spec.Name = name;
    spec.End = end;
    spec.WallAhead = wallAhead;
    spec.Rate = rate;
    return spec;
}

TEST(MergePlan, PutsNodesWhoseWallClocksDifferByMinutesOnOneTimeLine)
{
    const SyntheticFleet fleet({Node("ground", 3 * Minute), Node("uav1", 3 * Minute, 7 * Minute, 30e-6)},
                               Delays(Ms / 5, 2 * Ms));
    const Plans plans(fleet, {"ground"});
    ASSERT_EQ(plans.Plan.Problem, "");
    const Errors errors = ErrorsOf(fleet, plans, 1, 0);
    EXPECT_GT(errors.Messages, 800U);
    EXPECT_EQ(errors.Beyond, 0U);
    EXPECT_LT(errors.WorstBound, 5 * Ms);
    EXPECT_LT(errors.Worst, 2 * Ms);
}

class AsymmetricDelays : public testing::TestWithParam<std::tuple<Time, Time, Time, double>>
{
};

TEST_P(AsymmetricDelays, StayWithinTheBound)
{
    const Time there = std::get<0>(GetParam());
    const Time back = std::get<1>(GetParam());
    const Time jitter = std::get<2>(GetParam());
    const double rate = std::get<3>(GetParam());
    const SyntheticFleet fleet(
        {Node("ground", 5 * Minute), Node("uav1", 5 * Minute, -3 * Minute, rate)},
        [=](std::size_t from, std::size_t, Time, std::mt19937 &random)
        { return std::optional((from == 0 ? there : back) + Uniform(random, 0, jitter)); });
    const Plans plans(fleet, {"ground"});
    const Errors errors = ErrorsOf(fleet, plans, 1, 0);
    EXPECT_EQ(errors.Beyond, 0U) << "wrong by " << errors.Worst << " where " << errors.WorstBound
                                 << " was stated";
    EXPECT_LT(errors.WorstBound, (there + back + 2 * jitter) / 2 + 10 * Ms);
}

INSTANTIATE_TEST_SUITE_P(
    MergePlan, AsymmetricDelays,
    testing::Values(std::tuple(0, 100 * Ms, 1000, 0.0), std::tuple(100 * Ms, 0, 1000, 50e-6),
                    std::tuple(Ms, 20 * Ms, 80 * Ms, -50e-6), std::tuple(30 * Ms, 5 * Ms, 200 * Ms, 90e-6),
                    std::tuple(0, 0, Ms, -90e-6), std::tuple(400 * Ms, 300 * Ms, 900 * Ms, 20e-6)));

TEST(MergePlan, IsWrongByTenMillisecondsAtMostWhereRoundTripsOfAHundredVary)
{
    const SyntheticFleet fleet({Node("ground", 5 * Minute), Node("uav1", 5 * Minute, Minute, 40e-6)},
                               Delays(Ms, 50 * Ms));
    const Plans plans(fleet, {"ground"});
    const Errors errors = ErrorsOf(fleet, plans, 1, 0);
    EXPECT_EQ(errors.Beyond, 0U);
    EXPECT_LT(errors.Worst, 10 * Ms);
    EXPECT_LT(*plans.Plan.Lives[1].Map.MedianBound(), 10 * Ms);
}

TEST(MergePlan, IsWrongByTenMillisecondsAtMostWhereARoundTripOfAHundredIsTheSameBothWays)
{
    const SyntheticFleet fleet({Node("ground", 5 * Minute), Node("uav1", 5 * Minute, Minute, 40e-6)},
                               Delays(48 * Ms, 50 * Ms));
    const Plans plans(fleet, {"ground"});
    const Errors errors = ErrorsOf(fleet, plans, 1, 0);
    EXPECT_EQ(errors.Beyond, 0U);
    EXPECT_LT(errors.Worst, 10 * Ms);
}

TEST(MergePlan, KeepsLivesOfANodeApart)
{
    auto first = Node("uav1", 2 * Minute, 5 * Minute);
    auto second = Node("uav1", 5 * Minute, -20 * Minute);
    second.Begin = 2 * Minute + 10 * OneSecond;
    second.Incarnation = 2;
    const SyntheticFleet fleet({Node("ground", 5 * Minute), first, second}, Delays(Ms, 4 * Ms));
    const Plans plans(fleet, {});
    ASSERT_EQ(plans.All.All.size(), 3U);
    EXPECT_EQ(plans.All.All[plans.Plan.TimeLine].Node, "ground");
    for (const std::uint64_t incarnation : {1U, 2U})
    {
        const std::size_t life = plans.LifeOf("uav1", incarnation);
        EXPECT_EQ(plans.Plan.Lives[life].Number, incarnation);
        EXPECT_EQ(ErrorsOf(fleet, plans, life, 0).Beyond, 0U);
    }
}

TEST(MergePlan, GoesByANodeThatBothHeardThoughThereIsNoRecordingOfIt)
{
    auto between = Node("relay", 3 * Minute, 0, 20e-6);
    between.IsRecorded = false;
    const SyntheticFleet fleet(
        {Node("uav1", 3 * Minute, 2 * Minute, -20e-6), between, Node("uav2", 3 * Minute, 9 * Minute)},
        [](std::size_t from, std::size_t to, Time, std::mt19937 &random)
        { return from == 1 || to == 1 ? std::optional(Uniform(random, Ms, 3 * Ms)) : std::nullopt; });
    const Plans plans(fleet, {"uav1"});
    ASSERT_EQ(plans.Plan.Problem, "");
    const Errors errors = ErrorsOf(fleet, plans, 1, 0);
    EXPECT_GT(errors.Messages, 800U);
    EXPECT_EQ(errors.Beyond, 0U);
    ASSERT_EQ(plans.Plan.Lives[1].Map.By().size(), 1U);
    EXPECT_EQ(plans.All.Graph.NodeOf(plans.Plan.Lives[1].Map.By()[0]), "relay");
}

TEST(MergePlan, GoesByANodeBetweenWhereTheStraightWayIsWorse)
{
    const SyntheticFleet fleet(
        {Node("uav1", 3 * Minute), Node("ground", 3 * Minute), Node("uav2", 3 * Minute)},
        [](std::size_t from, std::size_t to, Time, std::mt19937 &random)
        { return from == 1 || to == 1 ? Uniform(random, Ms, 3 * Ms) : Uniform(random, 200 * Ms, 300 * Ms); });
    const Plans plans(fleet, {"uav1"});
    const std::size_t life = plans.LifeOf("uav2", 1);
    EXPECT_EQ(ErrorsOf(fleet, plans, life, 0).Beyond, 0U);
    EXPECT_LT(*plans.Plan.Lives[life].Map.MedianBound(), 10 * Ms);
}

TEST(MergePlan, TakesAsTimeLineTheNodeThatHasRelationsWithMost)
{
    const SyntheticFleet fleet(
        {Node("uav1", Minute), Node("uav2", Minute), Node("uav3", Minute)},
        [](std::size_t from, std::size_t to, Time, std::mt19937 &random)
        { return from == 1 || to == 1 ? std::optional(Uniform(random, Ms, 2 * Ms)) : std::nullopt; });
    const Plans plans(fleet, {});
    EXPECT_EQ(plans.All.All[plans.Plan.TimeLine].Node, "uav2");
}

TEST(MergePlan, IsTheMoreUncertainTheLongerNothingWasHeard)
{
    // The nodes do not hear each other for ten minutes, and their clocks drift apart by 50 us a second.
    const SyntheticFleet fleet({Node("ground", 20 * Minute), Node("uav1", 20 * Minute, Minute, 50e-6)},
                               [](std::size_t, std::size_t, Time at, std::mt19937 &random) {
                                   return at > 5 * Minute && at < 15 * Minute
                                              ? std::nullopt
                                              : std::optional(Uniform(random, Ms, 3 * Ms));
                               });
    const Plans plans(fleet, {"ground"});
    EXPECT_EQ(ErrorsOf(fleet, plans, 1, 0).Beyond, 0U);
    const TimeMap &map = plans.Plan.Lives[1].Map;
    EXPECT_LT(*map.BoundAt(fleet.LogAt(1, 4 * Minute)), 8 * Ms);
    EXPECT_GT(*map.BoundAt(fleet.LogAt(1, 10 * Minute)), 12 * Ms);
}

TEST(MergePlan, StaysWithinTheBoundAfterTheTimeLinesNodeHasEnded)
{
    const SyntheticFleet fleet({Node("ground", 5 * Minute), Node("uav1", 15 * Minute, Minute, 40e-6)},
                               Delays(Ms, 3 * Ms));
    const Plans plans(fleet, {"ground"});
    const Errors errors = ErrorsOf(fleet, plans, 1, 0);
    EXPECT_EQ(errors.Beyond, 0U);
    EXPECT_LT(errors.WorstBound, 80 * Ms);
}

TEST(MergePlan, StaysWithinTheBoundWhenAClockStoodStill)
{
    auto paused = Node("uav1", 5 * Minute, Minute, 20e-6);
    paused.Stands = {{2 * Minute, 40 * OneSecond}};
    const SyntheticFleet fleet({Node("ground", 5 * Minute), paused}, Delays(Ms, 3 * Ms));
    for (const char *reference : {"ground", "uav1"})
    {
        const Plans plans(fleet, {reference});
        const bool isGround = std::string(reference) == "ground";
        // An event in the pause of the time line's clock has no time on it.
        const Errors errors = ErrorsOf(fleet, plans, isGround ? 1 : 0, isGround ? 0 : 1);
        EXPECT_EQ(errors.Beyond, 0U) << reference << ": wrong by " << errors.Worst;
        EXPECT_LT(*plans.Plan.Lives[isGround ? 1 : 0].Map.MedianBound(), 8 * Ms);
    }
}

// Three nodes with clocks, delays, jitter, losses and times without contact by chance.
class AnyFleet : public testing::TestWithParam<unsigned>
{
};

TEST_P(AnyFleet, StaysWithinTheBound)
{
    std::mt19937 random(GetParam());
    std::vector<SyntheticFleet::Spec> specs;
    struct Way
    {
        Time Least = 0;
        Time Jitter = 0;
        int Lost = 0;  // of a hundred
        Time OutFrom = 0;
        Time OutTo = 0;
    };
    std::array<std::array<Way, 3>, 3> ways;
    for (std::size_t node = 0; node < 3; ++node)
    {
        const double rate = static_cast<double>(Uniform(random, -50, 50)) * 1e-6;
        specs.push_back(
            Node("uav" + std::to_string(node), 6 * Minute, Uniform(random, -9, 9) * Minute, rate));
        specs.back().Begin = Uniform(random, 0, Minute);
        specs.back().End -= Uniform(random, 0, Minute);
        for (Way &way : ways[node])
        {
            way.Least =
                Uniform(random, 0, 3) == 0 ? Uniform(random, 0, 300 * Ms) : Uniform(random, 0, 3 * Ms);
            way.Jitter =
                1000 + (Uniform(random, 0, 2) == 0 ? Uniform(random, 0, 900 * Ms) : Uniform(random, 0, Ms));
            way.Lost = static_cast<int>(Uniform(random, 0, 2) == 0 ? Uniform(random, 0, 80) : 0);
            way.OutFrom = Uniform(random, 0, 6 * Minute);
            way.OutTo = way.OutFrom + Uniform(random, 0, 2 * Minute);
        }
    }
    if (Uniform(random, 0, 4) == 0)
    {
        specs[1].Stands = {{Uniform(random, 2 * Minute, 3 * Minute), Uniform(random, 2 * OneSecond, Minute)}};
    }
    const SyntheticFleet fleet(
        specs,
        [&ways](std::size_t from, std::size_t to, Time at, std::mt19937 &chance) -> std::optional<Time>
        {
            const Way &way = ways[from][to];
            const bool isOut = at >= way.OutFrom && at < way.OutTo;
            return isOut || Uniform(chance, 0, 99) < way.Lost
                       ? std::nullopt
                       : std::optional(way.Least + Uniform(chance, 0, way.Jitter));
        },
        GetParam());
    const Plans plans(fleet, {"uav0"});
    if (!plans.Plan.Problem.empty())
    {
        return;  // two never heard each other
    }
    for (std::size_t life = 1; life < 3; ++life)
    {
        const Errors errors = ErrorsOf(fleet, plans, life, 0);
        EXPECT_EQ(errors.Beyond, 0U) << errors.Messages << " messages, wrong by " << errors.Worst << " of uav"
                                     << life;
    }
}

INSTANTIATE_TEST_SUITE_P(MergePlan, AnyFleet, testing::Range(1U, 61U));

TEST(MergePlan, RefusesANodeWhoseClockNobodyRelates)
{
    const SyntheticFleet fleet(
        {Node("ground", Minute), Node("uav1", Minute), Node("uav9", Minute, 2 * Minute)},
        [](std::size_t from, std::size_t to, Time, std::mt19937 &random)
        { return from == 2 || to == 2 ? std::nullopt : std::optional(Uniform(random, Ms, 2 * Ms)); });
    const Plans refused(fleet, {});
    EXPECT_THAT(refused.Plan.Problem,
                HasSubstr("uav9_1_1.mcap: nothing relates the clock of uav9 to that of"));
    const Plans taken(fleet, {"ground", true});
    const std::size_t life = taken.LifeOf("uav9", 1);
    EXPECT_EQ(taken.Plan.Problem, "");
    EXPECT_EQ(taken.Plan.Lives[life].By, PlannedLife::Way::WallClock);
    EXPECT_EQ(taken.Plan.Lives[life].Map.At(5 * OneSecond), 5 * OneSecond);
    EXPECT_FALSE(taken.Plan.Lives[life].Map.WorstBound().has_value());
    EXPECT_FALSE(taken.Plan.WorstBound().has_value());
}

TEST(MergePlan, TakesTheWallClockThatAnotherLifeOfTheNodeHad)
{
    auto second = Node("uav1", 3 * Minute, 2 * Minute);
    second.Begin = 2 * Minute;
    second.Incarnation = 2;
    const SyntheticFleet fleet(
        {Node("ground", 3 * Minute), Node("uav1", Minute, 2 * Minute), second},
        [](std::size_t from, std::size_t to, Time, std::mt19937 &random)
        { return from == 2 || to == 2 ? std::nullopt : std::optional(Uniform(random, Ms, 2 * Ms)); });
    const Plans plans(fleet, {"ground", true});
    const std::size_t life = plans.LifeOf("uav1", 2);
    EXPECT_EQ(plans.Plan.Lives[life].By, PlannedLife::Way::WallClock);
    EXPECT_LT(ErrorsOf(fleet, plans, life, 0).Worst, 10 * Ms);
}

TEST(MergePlan, RefusesATimeLineOfWhichThereIsNoRecording)
{
    const SyntheticFleet fleet({Node("ground", Minute)}, Delays(Ms, Ms));
    EXPECT_EQ(Plans(fleet, {"uav7"}).Plan.Problem, "there is no recording of uav7");
}

}  // namespace
}  // namespace Rabit::Merge
