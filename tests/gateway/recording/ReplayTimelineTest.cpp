#include "recording/replay/ReplayTimeline.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

namespace Rabit::Replay
{
namespace
{

using namespace std::chrono_literals;
using ::testing::ElementsAre;
using ::testing::IsEmpty;
using Duration = ReplayTimeline::Duration;

constexpr Time Ms = 1'000'000;
constexpr Time Start = 5'000'000 * Ms;

class ListedItems final : public ReplaySource
{
public:
    // Adds an item, `at` in milliseconds after Start. Its byte is the number of the item.
    void Add(Time at, std::size_t stream = 0, Time age = 0)
    {
        Items.push_back({stream,
                         Start + at * Ms,
                         Start + at * Ms - age * Ms,
                         {static_cast<std::uint8_t>(Items.size() + 1)}});
    }
    void Begin(Time from) override { _at = static_cast<std::size_t>(FirstFrom(from) - Items.begin()); }
    std::optional<ReplayItem> Next() override
    {
        return _at < Items.size() ? std::optional(Items[_at++]) : std::nullopt;
    }
    std::vector<ReplayItem> LastBefore(Time time) override
    {
        std::vector<ReplayItem> last;
        for (auto item = Items.begin(); item != FirstFrom(time); ++item)
        {
            std::erase_if(last, [&item](const ReplayItem &other) { return other.Stream == item->Stream; });
            last.push_back(*item);
        }
        return last;
    }

    std::vector<ReplayItem> Items;

private:
    std::vector<ReplayItem>::iterator FirstFrom(Time from)
    {
        return std::find_if(Items.begin(), Items.end(),
                            [from](const ReplayItem &item) { return item.LogTime >= from; });
    }
    std::size_t _at = 0;
};

class ReplayTimelineTest : public ::testing::Test
{
protected:
    ReplayTimelineTest()
    {
        source.Add(0);
        source.Add(100);
        source.Add(250, 1);
        source.Add(1000);
    }

    ReplayTimeline Make(ReplayTimeline::Settings settings = {})
    {
        settings.From = settings.From == 0 ? Start : settings.From;
        settings.To = settings.To == 0 ? source.Items.back().LogTime : settings.To;
        return ReplayTimeline(source, settings, now);
    }
    // Returns the numbers of the items that are due.
    std::vector<int> Due(ReplayTimeline &timeline)
    {
        std::vector<int> numbers;
        while (const auto due = timeline.Next(now))
        {
            numbers.push_back(due->IsRestored ? -due->Item.Data[0] : due->Item.Data[0]);
        }
        return numbers;
    }

    ListedItems source;
    Duration now = 77s;
};

TEST_F(ReplayTimelineTest, MessagesComeAsTheyCameThen)
{
    ReplayTimeline timeline = Make();
    EXPECT_THAT(Due(timeline), ElementsAre(1));
    EXPECT_EQ(timeline.DueAt(now), now + 100ms);
    now += 99ms;
    EXPECT_THAT(Due(timeline), IsEmpty());
    now += 1ms;
    EXPECT_THAT(Due(timeline), ElementsAre(2));
    now += 900ms;
    EXPECT_THAT(Due(timeline), ElementsAre(3, 4));
    EXPECT_TRUE(timeline.IsAtEnd(now));
    EXPECT_EQ(timeline.DueAt(now), std::nullopt);
}

TEST_F(ReplayTimelineTest, TheRateSaysHowFast)
{
    for (const double rate : {0.1, 4.0, 100.0})
    {
        ReplayTimeline timeline = Make({.Rate = rate});
        EXPECT_THAT(Due(timeline), ElementsAre(1));
        const Duration wait = *timeline.DueAt(now) - now;
        EXPECT_NEAR(static_cast<double>(wait.count()), 1e8 / rate, 2.0) << rate;
    }
}

TEST_F(ReplayTimelineTest, AsFastAsItGoesEverythingIsDueAtOnce)
{
    ReplayTimeline timeline = Make({.Rate = 0.0});
    EXPECT_THAT(Due(timeline), ElementsAre(1, 2, 3, 4));
    EXPECT_TRUE(timeline.IsAtEnd(now));
    EXPECT_EQ(timeline.Position(now), Start + 1000 * Ms);
}

TEST_F(ReplayTimelineTest, AMessageIsAsOldAsItWasWhenItWasRecorded)
{
    source.Items.clear();
    source.Add(0, 0, 30);
    source.Add(10, 0, 0);
    source.Items.back().PublishTime += 5 * Ms;  // clocks are not exact
    ReplayTimeline timeline = Make({.Rate = 0.0});
    EXPECT_EQ(timeline.Next(now)->Age, 30ms);
    EXPECT_EQ(timeline.Next(now)->Age, 0ms);
}

TEST_F(ReplayTimelineTest, WhatWasThereBeforeTheBeginningComesFirstWithItsAgeThere)
{
    ReplayTimeline timeline = Make({.From = Start + 300 * Ms});
    const auto first = timeline.Next(now);
    ASSERT_TRUE(first && first->IsRestored);
    EXPECT_EQ(first->Item.Data[0], 2);
    EXPECT_EQ(first->Age, 200ms);
    EXPECT_THAT(Due(timeline), ElementsAre(-3));
    EXPECT_EQ(timeline.DueAt(now), now + 700ms);
}

TEST_F(ReplayTimelineTest, NothingComesBehindTheEnd)
{
    ReplayTimeline timeline = Make({.To = Start + 500 * Ms});
    now += 250ms;
    EXPECT_THAT(Due(timeline), ElementsAre(1, 2, 3));
    EXPECT_FALSE(timeline.IsAtEnd(now)) << "it was silent then, and is now";
    EXPECT_EQ(timeline.DueAt(now), now + 250ms);
    now += 250ms;
    EXPECT_THAT(Due(timeline), IsEmpty());
    EXPECT_TRUE(timeline.IsAtEnd(now));
    EXPECT_EQ(timeline.Position(now + 1h), Start + 500 * Ms);
}

TEST_F(ReplayTimelineTest, WhileItIsPausedTimeStandsStill)
{
    ReplayTimeline timeline = Make();
    Due(timeline);
    now += 60ms;
    timeline.Pause(now);
    now += 1h;
    EXPECT_THAT(Due(timeline), IsEmpty());
    EXPECT_EQ(timeline.DueAt(now), std::nullopt);
    EXPECT_EQ(timeline.Position(now), Start + 60 * Ms);
    timeline.Resume(now);
    EXPECT_EQ(timeline.DueAt(now), now + 40ms);
}

TEST_F(ReplayTimelineTest, APausedBeginningShowsWhatWasThereBefore)
{
    ReplayTimeline timeline = Make({.From = Start + 50 * Ms, .Paused = true});
    EXPECT_THAT(Due(timeline), ElementsAre(-1));
    EXPECT_TRUE(timeline.IsPaused());
    EXPECT_FALSE(timeline.IsAtEnd(now));
}

TEST_F(ReplayTimelineTest, AStepPausesAndPlaysTheNextMessage)
{
    ReplayTimeline timeline = Make();
    Due(timeline);
    timeline.Step(now);
    EXPECT_TRUE(timeline.IsPaused());
    EXPECT_EQ(timeline.DueAt(now), now);
    EXPECT_THAT(Due(timeline), ElementsAre(2));
    EXPECT_EQ(timeline.Position(now), Start + 100 * Ms);
    timeline.Step(now);
    timeline.Step(now);
    EXPECT_THAT(Due(timeline), ElementsAre(3, 4));
    timeline.Step(now);
    EXPECT_THAT(Due(timeline), IsEmpty()) << "there is none any more";
}

TEST_F(ReplayTimelineTest, AfterAStepItGoesOnFromThere)
{
    ReplayTimeline timeline = Make({.Paused = true});
    timeline.Step(now);
    timeline.Step(now);
    Due(timeline);
    now += 10s;
    timeline.Resume(now);
    EXPECT_EQ(timeline.DueAt(now), now + 150ms);
}

TEST_F(ReplayTimelineTest, ASeekRestoresWhatWasThereAndGoesOn)
{
    ReplayTimeline timeline = Make();
    Due(timeline);
    timeline.Seek(Start + 999 * Ms, now);
    EXPECT_EQ(timeline.Jumps(), 2U);
    EXPECT_THAT(Due(timeline), ElementsAre(-2, -3));
    EXPECT_EQ(timeline.DueAt(now), now + 1ms);
    timeline.Seek(Start + 100 * Ms, now);
    EXPECT_THAT(Due(timeline), ElementsAre(-1, 2)) << "backwards, and what was recorded just then comes too";
}

TEST_F(ReplayTimelineTest, ASeekStaysBetweenBeginningAndEnd)
{
    ReplayTimeline timeline = Make({.From = Start + 50 * Ms, .To = Start + 300 * Ms});
    timeline.Seek(0, now);
    EXPECT_EQ(timeline.Position(now), Start + 50 * Ms);
    timeline.Seek(~Time{0}, now);
    EXPECT_EQ(timeline.Position(now), Start + 300 * Ms);
}

TEST_F(ReplayTimelineTest, AfterTheEndASeekBringsItBack)
{
    ReplayTimeline timeline = Make({.Rate = 0.0});
    Due(timeline);
    timeline.Seek(Start + 200 * Ms, now);
    EXPECT_FALSE(timeline.IsAtEnd(now));
    EXPECT_THAT(Due(timeline), ElementsAre(-2, 3, 4));
}

TEST_F(ReplayTimelineTest, ALoopBeginsAgainWhenItsTimeIsOver)
{
    ReplayTimeline timeline = Make({.To = Start + 2000 * Ms, .Loops = true});
    now += 1s;
    EXPECT_THAT(Due(timeline), ElementsAre(1, 2, 3, 4));
    EXPECT_EQ(timeline.DueAt(now), now + 1s);
    now += 1s;
    EXPECT_THAT(Due(timeline), ElementsAre(1));
    EXPECT_EQ(timeline.Rounds(), 2U);
    EXPECT_FALSE(timeline.IsAtEnd(now));
}

TEST_F(ReplayTimelineTest, ALoopOfAMomentDoesNotSpin)
{
    ReplayTimeline timeline = Make({.To = Start, .Loops = true});
    EXPECT_THAT(Due(timeline), ElementsAre(1));
    EXPECT_EQ(timeline.DueAt(now), now + 1s);
}

TEST_F(ReplayTimelineTest, ALoopOfNothingEnds)
{
    ReplayTimeline timeline =
        Make({.From = Start + 300 * Ms, .To = Start + 400 * Ms, .Rate = 0.0, .Loops = true});
    EXPECT_THAT(Due(timeline), ElementsAre(-2, -3));
    EXPECT_TRUE(timeline.IsAtEnd(now));
    EXPECT_EQ(timeline.DueAt(now), std::nullopt);
}

TEST_F(ReplayTimelineTest, TimesThatNoClockShowsAreBounded)
{
    source.Items.clear();
    source.Add(0);
    source.Items.back().PublishTime = 0;
    source.Add(1);
    source.Items.back().LogTime = ~Time{0};
    ReplayTimeline timeline = Make({.Rate = 0.1});
    EXPECT_LE(timeline.Next(now)->Age, std::chrono::hours(24 * 366 * 50));
    EXPECT_GT(*timeline.DueAt(now), now + std::chrono::hours(24 * 365));
    EXPECT_FALSE(timeline.IsAtEnd(now));
    timeline.Step(now);
    EXPECT_THAT(Due(timeline), ElementsAre(2));
}

TEST_F(ReplayTimelineTest, WhoIsLateGetsWhatWasDueMeanwhileAndIsInTimeAgain)
{
    ReplayTimeline timeline = Make();
    now += 500ms;
    EXPECT_THAT(Due(timeline), ElementsAre(1, 2, 3));
    EXPECT_EQ(timeline.DueAt(now), now + 500ms);
}

}  // namespace
}  // namespace Rabit::Replay
