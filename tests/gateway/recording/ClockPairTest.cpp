#include "recording/merge/ClockPair.h"

#include <gtest/gtest.h>

namespace Rabit::Merge
{
namespace
{

constexpr Moment Ms = 1000000;

// Adds a measurement once a second from `from` to `to`, with round trips that differ a little, like those
// of beats.
void Tell(ClockPair &pair, int from, int to, Moment offset, Moment halfRoundTrip, double drift = 0.0)
{
    for (int second = from; second < to; ++second)
    {
        const Moment first = second * OneSecond;
        pair.Add(first, first + offset + PartOf(first, drift), halfRoundTrip + second % 2);
    }
}

TEST(ClockPair, KnowsNothingBeforeARoundTripWasTold)
{
    ClockPair pair;
    pair.Add(0, 500, std::nullopt);
    pair.Finish();
    EXPECT_FALSE(pair.ToSecond(0).has_value());
    EXPECT_FALSE(pair.ToFirst(500).has_value());
    EXPECT_EQ(pair.Count(), 0U);
}

TEST(ClockPair, ReadsEitherClockByTheOther)
{
    ClockPair pair;
    Tell(pair, 0, 100, 7 * OneSecond, Ms);
    pair.Finish();
    EXPECT_EQ(pair.ToSecond(50 * OneSecond + 3)->Time, 57 * OneSecond + 3);
    EXPECT_EQ(pair.ToFirst(57 * OneSecond + 3)->Time, 50 * OneSecond + 3);
}

TEST(ClockPair, IsWrongByHalfOfARoundTripAndTheDriftThatTheFilterMayHold)
{
    ClockPair pair;
    Tell(pair, 0, 1000, 0, Ms);
    pair.Finish();
    const Moment bound = pair.ToSecond(500 * OneSecond)->Bound;
    EXPECT_GE(bound, Ms);
    EXPECT_LE(bound, Ms + Ms / 2);
}

TEST(ClockPair, TakesTheDriftFromWhatWasTold)
{
    ClockPair even;
    Tell(even, 0, 1000, 0, Ms);
    even.Finish();
    EXPECT_NEAR(even.Drift(), ClockPair::LeastDrift, 1e-9);
    ClockPair bad;
    Tell(bad, 0, 1000, 0, Ms, 300e-6);
    bad.Finish();
    EXPECT_GE(bad.Drift(), 280e-6);
    ClockPair brief;
    Tell(brief, 0, 20, 0, Ms);
    brief.Finish();
    EXPECT_EQ(brief.Drift(), ClockPair::MostDrift);
}

TEST(ClockPair, IsTheMoreUncertainTheFurtherAwayTheLastThatWasTold)
{
    ClockPair pair;
    Tell(pair, 0, 1000, 0, Ms);
    pair.Finish();
    EXPECT_NEAR(
        static_cast<double>(pair.ToSecond(2000 * OneSecond)->Bound - pair.ToSecond(1000 * OneSecond)->Bound),
        pair.Drift() * 1000 * OneSecond, 1000.0);
}

TEST(ClockPair, UsesTheQuickRoundTripsNearASlowOne)
{
    ClockPair pair;
    Tell(pair, 0, 40, 0, 80 * Ms);
    Tell(pair, 40, 60, 0, Ms);
    Tell(pair, 60, 100, 0, 80 * Ms);
    pair.Finish();
    EXPECT_LT(pair.ToSecond(30 * OneSecond)->Bound, 6 * Ms);
    EXPECT_LT(pair.ToSecond(80 * OneSecond)->Bound, 10 * Ms);
}

TEST(ClockPair, TakesWhatIsToldAgainForNothingNew)
{
    ClockPair pair;
    for (int second = 0; second < 1000; ++second)
    {
        pair.Add(second * OneSecond, second * OneSecond, Ms);
    }
    pair.Finish();
    EXPECT_EQ(pair.Count(), 1U);
    EXPECT_GT(pair.ToSecond(900 * OneSecond)->Bound, 80 * Ms);
}

TEST(ClockPair, TakesClocksToDriftEvenlyWhileNothingIsHeard)
{
    ClockPair pair;
    Tell(pair, 0, 100, 0, Ms);
    Tell(pair, 1100, 1200, 30 * Ms, Ms);
    pair.Finish();
    EXPECT_NEAR(static_cast<double>(pair.ToSecond(600 * OneSecond)->Time - 600 * OneSecond),
                static_cast<double>(15 * Ms), static_cast<double>(Ms));
}

TEST(ClockPair, CountsAChangeThatDriftDoesNotExplainAsError)
{
    ClockPair pair;
    Tell(pair, 0, 500, 0, Ms);
    Tell(pair, 500, 1000, 60 * Ms, Ms);
    pair.Finish();
    EXPECT_GE(pair.ToSecond(490 * OneSecond)->Bound, 60 * Ms);
    EXPECT_LT(pair.ToSecond(400 * OneSecond)->Bound, 10 * Ms);
    EXPECT_LT(pair.ToSecond(600 * OneSecond)->Bound, 10 * Ms);
}

TEST(ClockPair, ReadsOnEitherSideOfAStepByWhatWasToldThere)
{
    ClockPair pair;
    Tell(pair, 0, 500, 0, Ms);
    Tell(pair, 500, 1000, 100 * OneSecond, Ms);
    pair.Finish();
    EXPECT_EQ(pair.ToSecond(480 * OneSecond)->Time, 480 * OneSecond);
    EXPECT_LT(pair.ToSecond(480 * OneSecond)->Bound, 10 * Ms);
    EXPECT_EQ(pair.ToSecond(520 * OneSecond)->Time, 620 * OneSecond);
    EXPECT_LT(pair.ToSecond(520 * OneSecond)->Bound, 10 * Ms);
    EXPECT_GE(pair.ToSecond(499 * OneSecond + Ms)->Bound, 100 * OneSecond);
}

TEST(ClockPair, ForgetsWhatALaterReadingOfTheOtherClockContradicts)
{
    // The other clock stood still for 20 s from second 100 on, which was noticed when it went on.
    ClockPair pair;
    Tell(pair, 0, 120, 0, Ms);
    Tell(pair, 120, 300, -20 * OneSecond, Ms);
    pair.Finish();
    EXPECT_EQ(pair.ToFirst(110 * OneSecond)->Time, 130 * OneSecond);
}

TEST(ClockPair, PassesOverWhatGoesBackOrComesTooOften)
{
    ClockPair pair;
    pair.Add(10 * OneSecond, 10 * OneSecond, Ms);
    pair.Add(9 * OneSecond, 9 * OneSecond, 2 * Ms);
    pair.Add(10 * OneSecond + Ms, 10 * OneSecond, 3 * Ms);
    pair.Finish();
    EXPECT_EQ(pair.Count(), 1U);
}

// A node reports at once when a state changes: the first round trip comes soon after a report without one.
TEST(ClockPair, UsesARoundTripThatIsToldSoonAfterAReportWithoutOne)
{
    ClockPair pair;
    pair.Add(10 * OneSecond, 10 * OneSecond, std::nullopt);
    pair.Add(10 * OneSecond + 200 * Ms, 10 * OneSecond + 200 * Ms, Ms);
    pair.Finish();
    EXPECT_EQ(pair.Count(), 1U);
}

TEST(ClockPair, UsesARoundTripOfBeforeAReportWithoutOne)
{
    ClockPair pair;
    pair.Add(100 * OneSecond, 100 * OneSecond, std::nullopt);
    pair.Add(50 * OneSecond, 50 * OneSecond, Ms);
    pair.Finish();
    EXPECT_EQ(pair.Count(), 1U);
    EXPECT_EQ(pair.ToSecond(50 * OneSecond)->Time, 50 * OneSecond);
}

TEST(ClockPair, HoldsWhateverAFileSays)
{
    ClockPair pair;
    pair.Add(-FarthestMoment, FarthestMoment, FarthestMoment);
    pair.Add(0, -FarthestMoment, 0);
    pair.Add(FarthestMoment, 0, FarthestMoment);
    pair.Finish();
    EXPECT_TRUE(pair.ToSecond(FarthestMoment).has_value());
    EXPECT_TRUE(pair.ToFirst(-FarthestMoment).has_value());
}

}  // namespace
}  // namespace Rabit::Merge
