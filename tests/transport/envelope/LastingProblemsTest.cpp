// When a problem becomes a row for people, and until when.
#include "envelope/LastingProblems.h"

#include <gtest/gtest.h>

#include <chrono>
#include <cstddef>
#include <string>

namespace
{

using namespace std::chrono_literals;
using namespace Rabit::Envelope;

class LastingProblemsOf : public testing::Test
{
protected:
    // Notes it `times` times, with so much time from one to the next. The last one is now.
    void Note(ProblemKind kind, int times, TimePoint::duration between, const std::string &entry = "uav1")
    {
        for (int i = 0; i < times; ++i)
        {
            Now += between;
            Problems.Note(entry, "is wrong", kind, Now);
        }
    }
    bool IsRow(TimePoint::duration later = 0s) const { return !Problems.Rows(Now + later).empty(); }

    TimePoint Now{1h};
    LastingProblems Problems;
};

TEST_F(LastingProblemsOf, TheUsualKindAreNotedInTenSecondsAndEndTenSecondsLater)
{
    Note(ProblemKind::Usual, 9, 10s);
    EXPECT_FALSE(IsRow());
    Note(ProblemKind::Usual, 1, 10s);
    EXPECT_TRUE(IsRow());
    EXPECT_TRUE(IsRow(10s));
    EXPECT_FALSE(IsRow(10s + 1ns));
}

TEST_F(LastingProblemsOf, ProgramsWithoutKeysAreNotedInFiveSecondsAndEndAHundredSecondsLater)
{
    Note(ProblemKind::WithoutKeys, 4, 100s);
    EXPECT_FALSE(IsRow());
    Note(ProblemKind::WithoutKeys, 1, 100s);
    EXPECT_TRUE(IsRow());
    EXPECT_TRUE(IsRow(100s));
    EXPECT_FALSE(IsRow(100s + 1ns));
}

TEST_F(LastingProblemsOf, EachKindBeginAnewAfterAPause)
{
    for (const ProblemKind kind : {ProblemKind::Usual, ProblemKind::WithoutKeys, ProblemKind::UnknownEpoch})
    {
        Problems = {};
        Note(kind, LastingProblems::SecondsOf(kind) - 1, 1s);
        Note(kind, 1, LastingProblems::PauseOf(kind) + 1ns);
        EXPECT_FALSE(IsRow());
        Note(kind, LastingProblems::SecondsOf(kind) - 1, 1s);
        EXPECT_TRUE(IsRow());
    }
}

TEST_F(LastingProblemsOf, OneSecondCountOnce)
{
    Note(ProblemKind::WithoutKeys, 100, 1ms);
    EXPECT_FALSE(IsRow());
}

TEST_F(LastingProblemsOf, UnknownEpochsEndWithABulletin)
{
    Note(ProblemKind::UnknownEpoch, 10, 1s);
    Note(ProblemKind::Usual, 20, 500ms, "uav2");
    EXPECT_EQ(Problems.Rows(Now).size(), 2u);
    Problems.End(ProblemKind::UnknownEpoch);
    ASSERT_EQ(Problems.Rows(Now).size(), 1u);
    EXPECT_EQ(Problems.Rows(Now)[0].Entry, "uav2");
}

TEST_F(LastingProblemsOf, ForgedAddressesDisplaceNoneThatLasts)
{
    Note(ProblemKind::WithoutKeys, 5, 1s);
    // The others were noted more often, and are no rows yet.
    for (int second = 0; second < 9; ++second)
    {
        Now += 1s;
        for (std::size_t other = 1; other < LastingProblems::Most; ++other)
        {
            Problems.Note(std::to_string(other), "is wrong", ProblemKind::Usual, Now);
        }
    }
    Note(ProblemKind::Usual, 1, 0s, "one more");
    EXPECT_EQ(Problems.Size(), LastingProblems::Most);
    EXPECT_TRUE(IsRow());
}

}  // namespace
