#include "backfill/RangeSet.h"

#include <gtest/gtest.h>

namespace Rabit::Backfill
{
namespace
{

TEST(RangeSetTest, AnEmptySetLacksAll)
{
    EXPECT_EQ(RangeSet().NewestGap({3, 9}), (Range{3, 9}));
    EXPECT_FALSE(RangeSet().NewestGap({9, 9}));
}

TEST(RangeSetTest, RangesThatTouchBecomeOne)
{
    RangeSet set;
    set.Add({1, 3});
    set.Add({5, 7});
    EXPECT_EQ(set.Size(), 2U);
    set.Add({3, 5});
    EXPECT_EQ(set.Size(), 1U);
    EXPECT_FALSE(set.NewestGap({1, 7}));
}

TEST(RangeSetTest, ARangeTakesInAllThatItCovers)
{
    RangeSet set;
    set.Add({2, 3});
    set.Add({5, 6});
    set.Add({8, 12});
    set.Add({1, 9});
    EXPECT_EQ(set.Size(), 1U);
    EXPECT_TRUE(set.Contains(1));
    EXPECT_TRUE(set.Contains(11));
    EXPECT_FALSE(set.Contains(12));
    EXPECT_FALSE(set.Contains(0));
}

TEST(RangeSetTest, TheNewestGapComesFirst)
{
    RangeSet set;
    set.Add({10, 20});
    set.Add({30, 40});
    EXPECT_EQ(set.NewestGap({0, 50}), (Range{40, 50}));
    EXPECT_EQ(set.NewestGap({0, 40}), (Range{20, 30}));
    EXPECT_EQ(set.NewestGap({0, 35}), (Range{20, 30}));
    EXPECT_EQ(set.NewestGap({0, 20}), (Range{0, 10}));
    EXPECT_EQ(set.NewestGap({25, 28}), (Range{25, 28}));
    EXPECT_FALSE(set.NewestGap({12, 20}));
}

}  // namespace
}  // namespace Rabit::Backfill
