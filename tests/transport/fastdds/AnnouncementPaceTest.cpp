// When the announcements of this node's own participant go.
#include "AnnouncementPace.h"

#include <gtest/gtest.h>

#include <vector>

namespace
{

using namespace std::chrono_literals;
using Rabit::FastDds::AnnouncementPace;

class AnnouncementPaceTest : public testing::Test
{
protected:
    bool Send(std::chrono::milliseconds at, AnnouncementPace::Destination destination = 1)
    {
        return Pace.MayGo(destination, Content, Heard, Start + at);
    }
    // Sends whenever an announcement is due, until `end`. Returns the times of all, those that `Pace`
    // requested included.
    std::vector<std::chrono::milliseconds> RunTo(std::chrono::milliseconds end)
    {
        std::vector<std::chrono::milliseconds> sent;
        while (const auto due = Pace.Due())
        {
            const auto at = std::chrono::duration_cast<std::chrono::milliseconds>(*due - Start);
            if (at > end)
            {
                break;
            }
            EXPECT_TRUE(Send(at));
            sent.push_back(at);
        }
        return sent;
    }
    std::optional<std::chrono::milliseconds> Due() const
    {
        const auto due = Pace.Due();
        return due ? std::optional(std::chrono::duration_cast<std::chrono::milliseconds>(*due - Start))
                   : std::nullopt;
    }
    // Lets `Pace` finish all announcements that it makes by itself.
    void Settle()
    {
        Send(-60s);
        RunTo(-1s);
        ASSERT_EQ(Due(), std::nullopt);
    }

    AnnouncementPace Pace{10s};
    AnnouncementPace::TimePoint Start{1h};
    std::uint64_t Content = 7;
    std::uint64_t Heard = 0;
};

TEST_F(AnnouncementPaceTest, WhereACardTellsOfTheNodeOnlyTwoFollowAndLater)
{
    AnnouncementPace pace(10s, true);
    EXPECT_TRUE(pace.MayGo(1, Content, Heard, Start));
    std::vector<std::chrono::milliseconds> sent;
    while (const auto due = pace.Due())
    {
        EXPECT_TRUE(pace.MayGo(1, Content, Heard, *due));
        sent.push_back(std::chrono::duration_cast<std::chrono::milliseconds>(*due - Start));
    }
    EXPECT_EQ(sent, (std::vector<std::chrono::milliseconds>{2s, 6s}));
}

TEST_F(AnnouncementPaceTest, ItAsksForTheFirstFewAtGrowingDistances)
{
    EXPECT_TRUE(Send(0ms));
    EXPECT_EQ(RunTo(60s),
              (std::vector<std::chrono::milliseconds>{100ms, 300ms, 700ms, 1500ms, 3100ms, 6300ms}));
}

TEST_F(AnnouncementPaceTest, WhatTheVendorRepeatsAtOnceIsNotSentAndNotOwed)
{
    Settle();
    ++Heard;
    EXPECT_TRUE(Send(0ms));
    EXPECT_FALSE(Send(0ms));
    EXPECT_FALSE(Send(1ms));
    EXPECT_EQ(Due(), std::nullopt);
}

TEST_F(AnnouncementPaceTest, EachDestinationGetsItsOwn)
{
    Settle();
    EXPECT_TRUE(Send(0ms, 1));
    EXPECT_TRUE(Send(0ms, 2));
    EXPECT_FALSE(Send(1ms, 1));
    EXPECT_TRUE(Send(2ms, 3)) << "one that came in the meantime";
}

TEST_F(AnnouncementPaceTest, WhoCameSinceIsAnsweredLaterNotNever)
{
    Settle();
    ++Heard;
    EXPECT_TRUE(Send(0ms));
    ++Heard;
    EXPECT_FALSE(Send(10ms));
    EXPECT_EQ(Due(), 100ms);
    EXPECT_FALSE(Send(99ms));
    EXPECT_TRUE(Send(100ms));
    EXPECT_EQ(Due(), std::nullopt);
}

TEST_F(AnnouncementPaceTest, AnswersInARowFollowEachOtherAtGrowingDistances)
{
    Settle();
    std::vector<int> sent;
    for (int at = 0; at < 4000; at += 10)
    {
        ++Heard;
        if (Send(std::chrono::milliseconds(at)))
        {
            sent.push_back(at);
        }
    }
    EXPECT_EQ(sent, (std::vector{0, 100, 300, 700, 1500, 2300, 3100, 3900}));
}

TEST_F(AnnouncementPaceTest, AfterARestANewcomerIsAnsweredSoonAgain)
{
    Settle();
    for (int at = 0; at < 2000; at += 10)
    {
        ++Heard;
        Send(std::chrono::milliseconds(at));
    }
    EXPECT_TRUE(Send(10s));
    ++Heard;
    EXPECT_FALSE(Send(10s + 1ms));
    EXPECT_EQ(Due(), 10s + 100ms);
}

TEST_F(AnnouncementPaceTest, WhatIsNewGoesAtOnce)
{
    Settle();
    EXPECT_TRUE(Send(0ms));
    ++Content;
    EXPECT_TRUE(Send(1ms));
    EXPECT_FALSE(Send(2ms));
}

TEST_F(AnnouncementPaceTest, TheVendorsOwnPeriodIsNeverHeldUp)
{
    AnnouncementPace often(100ms);
    for (int at = 0; at < 20000; at += 50)
    {
        EXPECT_TRUE(often.MayGo(1, Content, ++Heard, Start + std::chrono::milliseconds(at)));
    }
}

TEST_F(AnnouncementPaceTest, DestinationsWithoutEndDoNotFillTheMemory)
{
    Settle();
    for (AnnouncementPace::Destination other = 0; other < AnnouncementPace::MostDestinations; ++other)
    {
        EXPECT_TRUE(Send(0ms, other));
    }
    EXPECT_TRUE(Send(0ms, 0)) << "forgotten, so that it got one more";
}

}  // namespace
