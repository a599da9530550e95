#include "presence/BeatPace.h"

#include <gtest/gtest.h>

#include <vector>

namespace Rabit
{
namespace
{

using namespace std::chrono_literals;
using Ns = std::chrono::nanoseconds;

// Returns the times of the beats in [from, to) of a node that sends each one when it is due.
std::vector<Ns> BeatsOf(BeatPace &pace, Ns from, Ns to)
{
    std::vector<Ns> beats;
    for (Ns now = std::max(from, pace.Due()); now < to; now = pace.Due())
    {
        beats.push_back(now);
        pace.Sent(now);
    }
    return beats;
}

TEST(BeatPace, BeatsOnceAPeriod)
{
    BeatPace pace;
    EXPECT_EQ(BeatsOf(pace, 1s, 2600ms), (std::vector<Ns>{1s, 1500ms, 2s, 2500ms}));
}

TEST(BeatPace, WhoHasComeHearsBeatsThatFollowEachOtherQuicklyAtFirst)
{
    BeatPace pace;
    pace.Sent(1s);
    pace.Introduce(1200ms);
    EXPECT_EQ(BeatsOf(pace, 1200ms, 3s),
              (std::vector<Ns>{1200ms, 1250ms, 1350ms, 1550ms, 1950ms, 2450ms, 2950ms}));
}

TEST(BeatPace, ThoseWhoComeOneAfterAnotherAreNotEachMetWithQuickBeats)
{
    BeatPace pace;
    pace.Sent(1s);
    std::vector<Ns> beats;
    for (Ns now = 2s; now < 6s; now += 400ms)  // ten
    {
        pace.Introduce(now);
        for (const Ns beat : BeatsOf(pace, now, now + 400ms))
        {
            beats.push_back(beat);
        }
    }
    // Eight beats come with the periods, three for each of the first two, and fewer for the next.
    EXPECT_LE(beats.size(), 8u + 3u + 3u + 2u + 1u);
    EXPECT_EQ(beats.at(1) - beats.at(0), BeatPace::ShortestGap);
    EXPECT_GE(beats.back() - beats.at(beats.size() - 2), 400ms);
}

TEST(BeatPace, AfterSomeQuietANewcomerIsMetWithQuickBeatsAgain)
{
    BeatPace pace;
    pace.Sent(1s);
    pace.Introduce(2s);
    pace.Introduce(2100ms);
    BeatsOf(pace, 2100ms, 2100ms + BeatPace::Quiet);
    pace.Introduce(2100ms + BeatPace::Quiet);
    const auto beats = BeatsOf(pace, 2100ms + BeatPace::Quiet, 3s + BeatPace::Quiet);
    ASSERT_GE(beats.size(), 2u);
    EXPECT_EQ(beats[1] - beats[0], BeatPace::ShortestGap);
}

TEST(BeatPace, NoTwoBeatsFollowEachOtherMoreQuicklyThanTheShortestGap)
{
    BeatPace pace;
    pace.Sent(1s);
    pace.Introduce(1s);
    EXPECT_EQ(pace.Due(), 1s + BeatPace::ShortestGap);
}

TEST(BeatPace, WhoAsksWithoutEndHasItsBeatsAtMostOnceAPeriod)
{
    BeatPace pace;
    pace.Sent(1s);
    std::vector<Ns> gaps;
    for (Ns now = 1s; gaps.size() < 24;)
    {
        const Ns next = std::min(pace.EarliestToAsk(), pace.Due());
        gaps.push_back(next - now);
        now = next;
        pace.Sent(now);
    }
    // Each gap is half as long again as the one before. It grows up to 150 ms for the first twenty, and then
    // to the period.
    std::vector<Ns> expected{50ms, 75ms, 112'500us};
    expected.resize(BeatPace::QuickBeats, 150ms);
    expected.insert(expected.end(), {225ms, 337'500us, 500ms, 500ms});
    EXPECT_EQ(gaps, expected);
}

TEST(BeatPace, AfterSomeQuietABeatMayBeBroughtForwardAtOnceAgain)
{
    BeatPace pace;
    pace.Sent(1s);
    for (int i = 0; i < 4; ++i)
    {
        pace.Sent(pace.EarliestToAsk());
    }
    const auto beats = BeatsOf(pace, 1750ms, 8s);
    EXPECT_EQ(pace.EarliestToAsk(), beats.back() + BeatPace::ShortestGap);
}

TEST(BeatPace, WhileQuestionsWaitForDueBeatsThereIsNoQuiet)
{
    BeatPace pace;
    pace.Sent(1s);
    while (pace.EarliestToAsk() < pace.Due())
    {
        pace.Sent(pace.EarliestToAsk(), 0s, true);
    }
    for (int i = 0; i < 20; ++i)
    {
        pace.Sent(pace.Due(), 0s, true);
        EXPECT_EQ(pace.EarliestToAsk(), pace.Due());
    }
}

TEST(BeatPace, AShorterPeriodHoldsAtOnce)
{
    BeatPace pace;
    pace.SetPeriod(10s);
    pace.Sent(1s);
    pace.SetPeriod(1s);
    EXPECT_EQ(BeatsOf(pace, 1s, 4s), (std::vector<Ns>{2s, 3s}));
}

TEST(BeatPace, ALongerPeriodHoldsFromTheNextBeatOn)
{
    BeatPace pace;
    pace.Sent(1s);
    pace.SetPeriod(5s);
    EXPECT_EQ(BeatsOf(pace, 1s, 12s), (std::vector<Ns>{1500ms, 6500ms, 11500ms}));
}

TEST(BeatPace, APromiseIsWhatTheLastBeatHasTold)
{
    BeatPace pace;
    pace.Sent(1s);
    EXPECT_EQ(pace.Promised(), 1500ms);
    pace.SetPeriod(5s);
    EXPECT_EQ(pace.Promised(), 1500ms);
    pace.Sent(1500ms);
    EXPECT_EQ(pace.Promised(), 6500ms);
}

TEST(BeatPace, ABeatThatGoesEarlyToBeInTimeIsNotBroughtForward)
{
    BeatPace pace;
    pace.Sent(1s);
    pace.SentEarly(1400ms);
    EXPECT_EQ(pace.EarliestToAsk(), 1400ms + BeatPace::ShortestGap);
    EXPECT_EQ(pace.Due(), 1900ms);
    EXPECT_EQ(pace.Promised(), 1900ms);
}

TEST(BeatPace, ABeatComesSoonAfterAState)
{
    BeatPace pace;
    pace.Sent(1s);
    pace.StateWritten(1300ms);
    EXPECT_EQ(BeatsOf(pace, 1s, 2s),
              (std::vector<Ns>{1300ms + BeatPace::AfterState, 1800ms + BeatPace::AfterState}));
}

TEST(BeatPace, SoonAfterTheLastOfSeveralStatesAndWithinThePeriod)
{
    BeatPace pace;
    pace.Sent(1s);
    std::vector<Ns> beats;
    for (Ns now = 1010ms; now < 3s; now += 100ms)
    {
        pace.StateWritten(now);
        const auto more = BeatsOf(pace, now, now + 100ms);
        beats.insert(beats.end(), more.begin(), more.end());
    }
    EXPECT_EQ(beats, (std::vector<Ns>{1500ms, 2s, 2500ms, 3s}));
}

TEST(BeatPace, StatesBringNoMoreThanFiveBeatsASecond)
{
    BeatPace pace;
    pace.Sent(1s);
    std::vector<Ns> beats;
    for (Ns now = 1s; now < 11s; now += 130ms)
    {
        pace.StateWritten(now);
        const auto more = BeatsOf(pace, now, now + 130ms);
        beats.insert(beats.end(), more.begin(), more.end());
    }
    EXPECT_GT(beats.size(), 25u);
    EXPECT_LE(beats.size(), 50u);
}

TEST(BeatPace, ABeatThatComesBeforeHasToldOfTheState)
{
    BeatPace pace;
    pace.Sent(1s);
    pace.StateWritten(1450ms);
    EXPECT_EQ(BeatsOf(pace, 1s, 2200ms), (std::vector<Ns>{1500ms, 2s}));
}

TEST(BeatPace, WhoseBeatsAreSeldomBeatsNoMoreOftenForStates)
{
    BeatPace pace;
    pace.SetPeriod(2s);
    pace.Sent(1s);
    pace.StateWritten(1300ms);
    EXPECT_EQ(pace.Due(), 3s);
}

TEST(BeatPace, BeatsForStatesDoNotHoldUpQuestions)
{
    BeatPace pace;
    pace.Sent(1s);
    for (Ns now = 1300ms; now < 3s; now += 300ms)
    {
        pace.StateWritten(now);
        BeatsOf(pace, now, now + 300ms);
    }
    EXPECT_LE(pace.EarliestToAsk(), 3s + BeatPace::ShortestGap);
}

TEST(BeatPace, APeriodThatIsImpossibleBecomesTheNearestThatIs)
{
    BeatPace pace;
    pace.SetPeriod(0s);
    EXPECT_EQ(pace.Period(), BeatPace::ShortestPeriod);
    pace.SetPeriod(1h);
    EXPECT_EQ(pace.Period(), BeatPace::LongestPeriod);
}

TEST(BeatPaceOfATool, BroughtForwardBeatsComeNoMoreSeldomThanItWantsAnswers)
{
    BeatPace pace;
    pace.SetPeriod(std::chrono::seconds(2));
    pace.SetLongestGap(std::chrono::milliseconds(250));
    BeatPace::Duration now{0};
    for (int i = 0; i < BeatPace::QuickBeats + 2; ++i)
    {
        pace.Sent(now);
        now = pace.EarliestToAsk();
    }
    pace.Sent(now);
    EXPECT_EQ(pace.EarliestToAsk() - now, std::chrono::milliseconds(250));
}

TEST(BeatPace, AQuestionThatWaitsInQueuesIsNotAskedAgainBeforeItsAnswerCanHaveCome)
{
    BeatPace pace;
    pace.Sent(1s);
    pace.Sent(1200ms, 200ms);
    EXPECT_EQ(pace.EarliestToAsk(), Ns(1600ms));
    pace.Sent(1600ms, 5s);
    EXPECT_EQ(pace.EarliestToAsk(), Ns(1600ms + BeatPace::DefaultPeriod));
}

}  // namespace
}  // namespace Rabit
