// When a participant is announced beside its regular period.
#include "AnnouncementRounds.h"

#include <gtest/gtest.h>

#include <vector>

namespace
{

using namespace std::chrono_literals;
using Rabit::Cyclone::AnnouncementRounds;

class AnnouncementRoundsTest : public testing::Test
{
protected:
    // Runs the rounds up to `until`. Returns the times of the announcements, in ms from the start.
    std::vector<int> Live(std::chrono::milliseconds until, bool unheard)
    {
        return Live(Rounds, until, unheard);
    }
    std::vector<int> Live(AnnouncementRounds &rounds, std::chrono::milliseconds until, bool unheard) const
    {
        std::vector<int> announced;
        while (rounds.Due() && *rounds.Due() <= Start + until)
        {
            const auto now = *rounds.Due();
            if (rounds.Next(now, unheard))
            {
                announced.push_back(static_cast<int>((now - Start) / 1ms));
            }
        }
        return announced;
    }

    AnnouncementRounds::TimePoint Start{1h};
    AnnouncementRounds Rounds{100ms, Start};
};

TEST_F(AnnouncementRoundsTest, AtFirstAFewAtDoublingDistances)
{
    EXPECT_EQ(Live(1h, false), (std::vector{200, 600, 1400, 3000, 6200}));
    EXPECT_FALSE(Rounds.Due().has_value());
}

TEST_F(AnnouncementRoundsTest, WhereACardTellsOfTheNodeOnlyTwoFollowAndLater)
{
    AnnouncementRounds rounds(100ms, Start, true);
    EXPECT_EQ(Live(rounds, 1h, false), (std::vector{2000, 6000}));
}

TEST_F(AnnouncementRoundsTest, ANewcomerIsAnsweredOnceIfAllShowThatTheyHeardUs)
{
    Live(1min, false);
    Rounds.OnPeer(Start + 1min);
    EXPECT_EQ(Live(1h, false), std::vector{60100});
}

TEST_F(AnnouncementRoundsTest, WhoDoesNotShowThatItHeardUsIsAnsweredAgain)
{
    Live(1min, false);
    Rounds.OnPeer(Start + 1min);
    EXPECT_EQ(Live(1h, true),
              (std::vector{60100, 60300, 60700, 61500, 63100, 66300, 72700, 85500, 111100, 162300}));
}

TEST_F(AnnouncementRoundsTest, OneAnswerIsForAllWhoComeUntilThen)
{
    Live(1min, false);
    for (const auto after : {0ms, 30ms, 60ms, 90ms})
    {
        Rounds.OnPeer(Start + 1min + after);
    }
    EXPECT_EQ(Live(1h, false), std::vector{60100});
}

TEST_F(AnnouncementRoundsTest, WhoComesLaterIsAnsweredAsSoonAsTheFirst)
{
    Live(1min, false);
    Rounds.OnPeer(Start + 1min);
    Live(70s, true);
    Rounds.OnPeer(Start + 70s);
    EXPECT_EQ(Live(70s + 500ms, true), (std::vector{70100, 70300}));
}

TEST_F(AnnouncementRoundsTest, ThoseWhoComeOneAfterAnotherAreAnsweredTogether)
{
    Live(1min, false);
    std::vector<int> announced;
    for (auto at = 60000ms; at < 64000ms; at += 200ms)
    {
        Rounds.OnPeer(Start + at);
        const auto more = Live(at + 199ms, false);
        announced.insert(announced.end(), more.begin(), more.end());
    }
    EXPECT_EQ(announced,
              (std::vector{60100, 60300, 60500, 60900, 61300, 61700, 62100, 62500, 62900, 63300, 63700}));
}

// Only the first answer of a series is late, by the spacing between announcements.
TEST_F(AnnouncementRoundsTest, WhoComesLastOfSeveralIsAnsweredAtTheUsualDistances)
{
    Live(1min, false);
    for (auto at = 60000ms; at < 62000ms; at += 200ms)
    {
        Rounds.OnPeer(Start + at);
        Live(at + 199ms, false);
    }
    Rounds.OnPeer(Start + 62s);
    const auto answers = Live(65s, true);
    ASSERT_GE(answers.size(), 4u);
    EXPECT_LE(answers[0], 62000 + AnnouncementRounds::LongestSpacing / 1ms);
    EXPECT_EQ(answers[1] - answers[0], 200);
    EXPECT_EQ(answers[2] - answers[1], 400);
}

TEST_F(AnnouncementRoundsTest, WhatWasSaidToNewcomersJustBeforeNeedsNotBeSaidAgain)
{
    Rounds.OnPeer(Start + 60ms);  // answered at 160
    EXPECT_EQ(Live(1h, false), (std::vector{160, 600, 1400, 3000, 6200}));
}

TEST_F(AnnouncementRoundsTest, NothingIsDueTwice)
{
    EXPECT_FALSE(Rounds.Next(Start + 199ms, true));
    EXPECT_TRUE(Rounds.Next(Start + 200ms, true));
    EXPECT_FALSE(Rounds.Next(Start + 200ms, true));
}

}  // namespace
