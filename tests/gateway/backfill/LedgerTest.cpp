#include "backfill/Ledger.h"

#include <gtest/gtest.h>

namespace Rabit::Backfill
{
namespace
{

const Series Pose{"uav1", "Pose", 7};

TEST(LedgerTest, APostIsTakenOnce)
{
    Ledger ledger;
    EXPECT_TRUE(ledger.Take(Pose, 5));
    EXPECT_FALSE(ledger.Take(Pose, 5));
    EXPECT_TRUE(ledger.Take({"uav1", "Pose", 8}, 5)) << "another incarnation";
    ledger.SetWhole(Pose, {0, 10});
    EXPECT_FALSE(ledger.Take(Pose, 7)) << "a late live value of a range that is whole";
    EXPECT_EQ(ledger.Stamps(), 1U) << "a whole range needs no stamps";
}

TEST(LedgerTest, NothingIsMissingBeforeTheOriginWasAsked)
{
    Ledger ledger;
    ledger.Take(Pose, 5);
    EXPECT_FALSE(ledger.NewestGap("uav1", "Pose", 7, true));
}

TEST(LedgerTest, TheGapTellsWhatIsThereAlready)
{
    Ledger ledger;
    ledger.Take(Pose, 5);
    ledger.SetSpan(Pose, {2, 9});
    const auto gap = ledger.NewestGap("uav1", "Pose", 7, true);
    ASSERT_TRUE(gap);
    EXPECT_EQ(gap->Stamps, (Range{2, 9}));
    EXPECT_EQ(gap->Had, std::vector<Stamp>{5});
    EXPECT_TRUE(gap->IsNewest);
}

TEST(LedgerTest, ANewLiveValueProlongsTheSpan)
{
    Ledger ledger;
    ledger.SetSpan(Pose, {2, 9});
    ledger.SetWhole(Pose, {2, 9});
    EXPECT_FALSE(ledger.NewestGap("uav1", "Pose", 7, true));
    ledger.Take(Pose, 20);
    EXPECT_EQ(ledger.NewestGap("uav1", "Pose", 7, true)->Stamps, (Range{9, 21}));
    EXPECT_FALSE(ledger.NewestGap("uav1", "Pose", 7, false)) << "perhaps nothing is missing";
}

TEST(LedgerTest, ThePresentIncarnationComesFirst)
{
    Ledger ledger;
    ledger.SetSpan(Pose, {100, 200});
    ledger.SetSpan({"uav1", "Pose", 8}, {10, 20});
    ledger.SetSpan({"uav2", "Pose", 9}, {10, 20});
    EXPECT_EQ(ledger.NewestGap("uav1", "Pose", 8, true)->Of.Incarnation, 8U);
    ledger.SetWhole({"uav1", "Pose", 8}, {10, 20});
    EXPECT_EQ(ledger.NewestGap("uav1", "Pose", 8, false)->Of.Incarnation, 7U);
}

// Its clock was put back. The gap at the end of the present incarnation is then no reason to ask again and
// again.
TEST(LedgerTest, ThePresentIncarnationMayHaveALowerNumberThanAFormerOne)
{
    Ledger ledger;
    ledger.SetSpan(Pose, {100, 200});
    ledger.SetSpan({"uav1", "Pose", 5}, {10, 20});
    EXPECT_EQ(ledger.NewestGap("uav1", "Pose", 5, true)->Of.Incarnation, 5U);
    EXPECT_TRUE(ledger.NewestGap("uav1", "Pose", 5, true)->IsNewest);
    EXPECT_EQ(ledger.NewestGap("uav1", "Pose", 5, false)->Of.Incarnation, 7U);
    EXPECT_FALSE(ledger.NewestGap("uav1", "Pose", 5, false)->IsNewest);
    ledger.SetWhole(Pose, {100, 200});
    EXPECT_FALSE(ledger.NewestGap("uav1", "Pose", 5, false));
}

TEST(LedgerTest, AGapWithManyValuesIsReturnedFromItsEnd)
{
    Ledger ledger;
    ledger.SetSpan(Pose, {0, 1});
    for (Stamp stamp = 1; stamp <= 3 * Ledger::MostHad; ++stamp)
    {
        ledger.Take(Pose, stamp);
    }
    const auto gap = ledger.NewestGap("uav1", "Pose", 7, true);
    EXPECT_EQ(gap->Had.size(), Ledger::MostHad);
    EXPECT_EQ(gap->Stamps.First, gap->Had.front());
    EXPECT_EQ(gap->Stamps.End, 3 * Ledger::MostHad + 1);
}

TEST(LedgerTest, StampsAreBounded)
{
    Ledger ledger;
    ledger.SetSpan(Pose, {0, 1});
    for (Stamp stamp = 1; stamp <= Ledger::MostStamps + 10; ++stamp)
    {
        EXPECT_TRUE(ledger.Take(Pose, stamp));
    }
    EXPECT_EQ(ledger.Stamps(), Ledger::MostStamps);
}

}  // namespace
}  // namespace Rabit::Backfill
