#include "presence/ReaderWatch.h"

#include <gtest/gtest.h>

namespace Rabit
{
namespace
{

using namespace std::chrono_literals;

TEST(ReaderWatch, SaysOnceThatTheReaderOfWhoHasAppearedIsThere)
{
    ReaderWatch watch;
    watch.Look(3, 1s);
    watch.Expect(10s);
    EXPECT_TRUE(watch.IsExpecting());
    EXPECT_FALSE(watch.Look(3, 10s));
    EXPECT_TRUE(watch.Look(4, 11s));
    EXPECT_FALSE(watch.Look(4, 11s));
    EXPECT_FALSE(watch.IsExpecting());
}

TEST(ReaderWatch, TheReaderMayHaveComeJustBefore)
{
    ReaderWatch watch;
    watch.Look(1, 10s);
    watch.Expect(11s);
    EXPECT_TRUE(watch.Look(1, 11s));
}

TEST(ReaderWatch, AReaderThatCameLongBeforeIsSomebodyElses)
{
    ReaderWatch watch;
    watch.Look(1, 10s);
    watch.Expect(12s);
    EXPECT_FALSE(watch.Look(1, 12s));
}

TEST(ReaderWatch, ReadersThatNobodyExpectsAreNoNews)
{
    ReaderWatch watch;
    EXPECT_FALSE(watch.Look(5, 1s));
    EXPECT_FALSE(watch.IsExpecting());
}

TEST(ReaderWatch, EachOfThoseWhoAppearedIsWaitedFor)
{
    ReaderWatch watch;
    watch.Expect(1s);
    watch.Expect(1s);
    EXPECT_TRUE(watch.Look(1, 2s));
    EXPECT_TRUE(watch.Look(2, 3s));
    EXPECT_FALSE(watch.Look(3, 3s));
}

TEST(ReaderWatch, WhoseReaderDoesNotComeIsNotWaitedForForever)
{
    ReaderWatch watch;
    watch.Expect(1s);
    EXPECT_FALSE(watch.Look(0, 1s + ReaderWatch::Patience + 1ns));
    EXPECT_FALSE(watch.IsExpecting());
}

TEST(ReaderWatch, AReaderThatGoesAndComesIsANewOne)
{
    ReaderWatch watch;
    watch.Look(1, 1s);
    watch.Look(0, 5s);
    watch.Expect(6s);
    EXPECT_TRUE(watch.Look(1, 7s));
}

}  // namespace
}  // namespace Rabit
