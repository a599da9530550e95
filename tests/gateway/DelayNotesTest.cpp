#include "presence/DelayNotes.h"

#include <gtest/gtest.h>

namespace Rabit
{
namespace
{

using namespace std::chrono_literals;

TEST(DelayNotes, TellsHowLateTheNewestCameAndForHowLongThatIsKnown)
{
    DelayNotes notes;
    notes.Note(7, 30ms, 1s);
    notes.Note(7, 45ms, 2s);
    const auto told = notes.Take(2100ms, 8);
    ASSERT_EQ(told.size(), 1u);
    EXPECT_EQ(told[0].node, 7u);
    EXPECT_EQ(told[0].delay_ms, 45);
    EXPECT_EQ(told[0].held_ms, 100);
}

TEST(DelayNotes, NothingIsToldTwice)
{
    DelayNotes notes;
    notes.Note(7, 45ms, 1s);
    EXPECT_EQ(notes.Take(1s, 8).size(), 1u);
    EXPECT_EQ(notes.Due(2s, 8), 0u);
    EXPECT_TRUE(notes.Take(9s, 8).empty());
}

TEST(DelayNotes, ThatThereIsNoDelayIsToldNowAndThen)
{
    DelayNotes notes;
    int told = 0;
    for (auto now = 1s + 0ms; now < 11s; now += 500ms)
    {
        notes.Note(7, 2ms, now);
        told += notes.Take(now, 8).empty() ? 0 : 1;
    }
    EXPECT_EQ(told, 5);
}

TEST(DelayNotes, WhoBeatsSeldomTellsThatThereIsNoneWhileItCountsAndNotMoreOften)
{
    DelayNotes notes;
    notes.SetBeatPeriod(2s);
    int told = 0;
    for (auto now = 1s + 0ms; now < 41s; now += 500ms)
    {
        notes.Note(7, 2ms, now);
        told += notes.Take(now, 8).empty() ? 0 : 1;
    }
    EXPECT_EQ(told, 12);  // each 3.5 s
}

TEST(DelayNotes, ThatADelayCameOrWentIsToldAtOnce)
{
    DelayNotes notes;
    notes.Note(7, 2ms, 1s);
    notes.Take(1s, 8);
    notes.Note(7, 20ms, 1500ms);
    EXPECT_EQ(notes.Take(1500ms, 8).size(), 1u);
    notes.Note(7, 2ms, 2s);
    EXPECT_EQ(notes.Take(2s, 8).size(), 1u);
    notes.Note(7, 2ms, 2500ms);
    EXPECT_EQ(notes.Take(2500ms, 8).size(), 0u);
}

TEST(DelayNotes, BeforeNodesHaveMetDiscoveryTellsOfQueues)
{
    DelayNotes notes;
    notes.HeardLate(700ms);
    EXPECT_EQ(notes.Delay(1s), 700ms);
    notes.Note(7, 2ms, 1s);  // the first of a node counts as quick
    EXPECT_EQ(notes.Delay(1s), 700ms);
    notes.HeardLate(0ms);
    EXPECT_EQ(notes.Delay(1s), 2ms);
}

TEST(DelayNotes, NodesTakeTurns)
{
    DelayNotes notes;
    for (std::uint32_t node : {1U, 2U, 3U})
    {
        notes.Note(node, 50ms, 1s);
    }
    EXPECT_EQ(notes.Due(1s, 2), 2u);
    EXPECT_EQ(notes.Take(1s, 2).size(), 2u);
    const auto rest = notes.Take(1s, 2);
    ASSERT_EQ(rest.size(), 1u);
    EXPECT_EQ(rest[0].node, 3u);
}

TEST(DelayNotes, ThatThereIsNoDelayIsToldToAFewAtOnce)
{
    DelayNotes notes;
    for (std::uint32_t node = 0; node < 100; ++node)
    {
        notes.Note(node, 1ms, 1s);
    }
    notes.Note(50, 30ms, 1s);
    EXPECT_EQ(notes.Due(1s, 16), DelayNotes::MostSmall + 1);
    EXPECT_EQ(notes.Take(1s, 16).size(), DelayNotes::MostSmall + 1);
    const auto next = notes.Take(1500ms, 16);
    ASSERT_EQ(next.size(), DelayNotes::MostSmall);
    EXPECT_GT(next[0].node, 50u) << "in turns";
}

TEST(DelayNotes, WhatIsTooLongAgoIsNoNews)
{
    DelayNotes notes;
    notes.Note(7, 50ms, 1s);
    EXPECT_TRUE(notes.Take(62s, 8).empty());
}

TEST(DelayNotes, ADelayThatCannotBeSaidIsTheLargestThatCan)
{
    DelayNotes notes;
    notes.Note(7, 1h, 1s);
    EXPECT_EQ(notes.Take(1s, 8).at(0).delay_ms, 65535);
}

TEST(DelayNotes, MoreNodesThanThereMayBeAreNotNotedUntilOthersAreLongGone)
{
    DelayNotes notes;
    for (std::uint32_t node = 0; node < 3 * DelayNotes::MostNodes; ++node)
    {
        notes.Note(node, 50ms, 1s);
    }
    EXPECT_EQ(notes.Due(1s, 10'000), DelayNotes::MostNodes);
    notes.Note(5000, 50ms, 100s);
    EXPECT_EQ(notes.Due(100s, 10'000), 1u);
}

TEST(DelayNotes, TheDelayIsThatOfTheMiddleOfThoseWhoWereHeardLately)
{
    DelayNotes notes;
    EXPECT_EQ(notes.Delay(1s), 0ms);
    notes.Note(1, 10ms, 1s);
    notes.Note(2, 300ms, 4s);
    notes.Note(3, 9s, 4s);
    notes.Note(4, 200ms, 4s);
    EXPECT_EQ(notes.Delay(4500ms), 300ms);
}

TEST(DelayNotes, AClockThatStoodStillIsNoLongQueue)
{
    DelayNotes notes;
    notes.Note(1, 1h, 4s);
    EXPECT_EQ(notes.Delay(4500ms), DelayNotes::LongestQueue);
}

}  // namespace
}  // namespace Rabit
