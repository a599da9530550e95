#include "AnnouncementRounds.h"

#include <gmock/gmock.h>

#include <vector>

namespace Rabit::Simulated
{

namespace
{

using namespace std::chrono_literals;
using testing::ElementsAre;
using Time = AnnouncementRounds::Time;

constexpr Time Period = 10s;

// When the next announcements go, if nobody comes.
std::vector<Time> Next(AnnouncementRounds &rounds, int count)
{
    std::vector<Time> times;
    for (int i = 0; i < count; ++i)
    {
        times.push_back(rounds.Next());
        rounds.OnAnnounced(times.back());
    }
    return times;
}

TEST(AnnouncementRounds, TheFirstFollowAtDoublingDistancesThenOneComesEachPeriod)
{
    AnnouncementRounds rounds(Period);
    rounds.OnAnnounced(0ms);
    EXPECT_THAT(Next(rounds, 8), ElementsAre(100ms, 300ms, 700ms, 1500ms, 3100ms, 6300ms, 16300ms, 26300ms));
}

TEST(AnnouncementRounds, ANewcomerIsAnsweredAtOnceAfterARest)
{
    AnnouncementRounds rounds(Period);
    rounds.OnAnnounced(0ms);
    Next(rounds, 7);
    rounds.Owe();
    EXPECT_LE(rounds.Next(), 16300ms + AnnouncementRounds::LongestGap);
}

TEST(AnnouncementRounds, AllWhoComeBeforeTheNextRoundShareIt)
{
    AnnouncementRounds rounds(Period);
    rounds.OnAnnounced(0ms);
    Next(rounds, 6);
    rounds.OnAnnounced(10s);
    for (int i = 0; i < 10; ++i)
    {
        rounds.Owe();
    }
    EXPECT_EQ(rounds.Next(), 10100ms);
    rounds.OnAnnounced(10100ms);
    EXPECT_EQ(rounds.Next(), 20100ms);
}

TEST(AnnouncementRounds, WhereSomebodyAlwaysComesTheDistancesGrow)
{
    AnnouncementRounds rounds(Period);
    rounds.OnAnnounced(0ms);
    Next(rounds, 6);
    rounds.OnAnnounced(10s);
    std::vector<Time> gaps;
    Time last = 10s;
    for (int i = 0; i < 6; ++i)
    {
        rounds.Owe();
        gaps.push_back(rounds.Next() - last);
        last = rounds.Next();
        rounds.OnAnnounced(last);
    }
    EXPECT_THAT(gaps, ElementsAre(100ms, 200ms, 400ms, 800ms, 800ms, 800ms));
}

TEST(AnnouncementRounds, AShortPeriodIsKept)
{
    AnnouncementRounds rounds(50ms);
    rounds.OnAnnounced(0ms);
    EXPECT_THAT(Next(rounds, 3), ElementsAre(50ms, 100ms, 150ms));
}

}  // namespace

}  // namespace Rabit::Simulated
