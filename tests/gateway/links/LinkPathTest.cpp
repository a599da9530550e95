// How many bytes may be under way: the rules of PathControl, one by one.
#include <gtest/gtest.h>

#include "PathControl.h"

namespace Rabit::Test
{
namespace
{

using namespace std::chrono_literals;

class PathTest : public ::testing::Test
{
protected:
    static constexpr std::size_t One = 1421;  // a datagram, as on the air

    // Fills the window, and acknowledges all of it after `roundTrip`.
    void Round(LinkTime roundTrip)
    {
        const LinkTime sentAt = now;
        std::size_t sent = 0;
        while (path.HasRoom())
        {
            path.Sent(One, now);
            sent += One;
        }
        now += roundTrip;
        path.Acknowledged(sent, now);
        path.Measured(roundTrip, sentAt, now);
    }

    LinkSettings settings;
    std::size_t starting = 0;
    PathControl path{settings, starting};
    LinkTime now{1s};
};

TEST_F(PathTest, BeginsWithFourDatagrams)
{
    EXPECT_EQ(path.Window(), 4 * One);
}

TEST_F(PathTest, DoublesInEachRoundTripWhileNothingWaitsOnTheWay)
{
    for (const std::size_t datagrams : {4U, 8U, 16U, 32U})
    {
        EXPECT_GE(path.Window(), datagrams * One);
        EXPECT_LT(path.Window(), (datagrams + 1) * One);
        Round(100ms);
    }
}

TEST_F(PathTest, SharesTheFirstWindowWithPathsThatStartAtTheSameTime)
{
    PathControl other(settings, starting);
    path.Sent(One, now);
    path.Sent(One, now);
    path.Sent(One, now);
    other.Sent(One, now);
    EXPECT_FALSE(other.HasRoom());
    EXPECT_FALSE(path.HasRoom());
    PathControl third(settings, starting);
    EXPECT_TRUE(third.HasRoom()) << "a datagram in any case";
    third.Sent(One, now);
    EXPECT_FALSE(third.HasRoom());
}

TEST_F(PathTest, APathThatWasUsedInFullNoLongerTakesPartOfTheFirstWindow)
{
    Round(100ms);
    Round(100ms);
    while (path.HasRoom())
    {
        path.Sent(One, now);
    }
    EXPECT_EQ(starting, 0U);
    path.Restart();
    EXPECT_EQ(starting, path.InFlight()) << "until it starts anew";
}

TEST_F(PathTest, APathThatIsGoneTakesNoPartOfTheFirstWindow)
{
    {
        PathControl other(settings, starting);
        other.Sent(One, now);
    }
    EXPECT_EQ(starting, 0U);
}

TEST_F(PathTest, APathWithoutAnswersHoldsUpNoOther)
{
    PathControl silent(settings, starting);
    path.Sent(One, now);
    silent.Sent(One, now);
    silent.Sent(One, now);
    silent.Sent(One, now);
    EXPECT_FALSE(path.HasRoom());
    silent.LeaveStart();
    EXPECT_TRUE(path.HasRoom());
    EXPECT_EQ(starting, One);
}

TEST_F(PathTest, TheFirstProbeWaitsForWhatOtherPathsHaveSentAtTheSameTime)
{
    path.Measured(10ms, now, now);
    const LinkTime alone = path.ProbeTimeout();
    path.Sent(One, now);
    EXPECT_EQ(path.ProbeTimeout(), alone);
    PathControl other(settings, starting);
    other.Sent(One, now);
    const int emptyFrames = static_cast<int>(One / (2 * settings.AirOverhead));
    EXPECT_EQ(path.ProbeTimeout(), alone + emptyFrames * 10ms);
}

TEST_F(PathTest, DoesNotGrowWhileItIsNotUsed)
{
    for (int i = 0; i < 10; ++i)
    {
        path.Sent(One, now);
        now += 10ms;
        path.Acknowledged(One, now);
        path.Measured(10ms, now - 10ms, now);
    }
    EXPECT_EQ(path.Window(), 4 * One);
}

TEST_F(PathTest, GrowsToTheLargestWindowOnAWireAndNotBeyond)
{
    for (int i = 0; i < 40; ++i)
    {
        Round(200us);
    }
    EXPECT_EQ(path.Window(), settings.LargestWindow);
    EXPECT_LE(path.PacedUntil(), now) << "and nothing is paced";
}

TEST_F(PathTest, ShrinksWhenTheDelayRisesAboveTheTarget)
{
    for (int i = 0; i < 4; ++i)
    {
        Round(20ms);
    }
    const std::size_t before = path.Window();
    Round(400ms);
    Round(400ms);
    EXPECT_LT(path.Window(), before / 2);
}

TEST_F(PathTest, IsNeverLessThanADatagram)
{
    Round(20ms);
    for (int i = 0; i < 50; ++i)
    {
        Round(3s);
    }
    EXPECT_GE(path.Window(), One);
    EXPECT_TRUE(path.HasRoom());
}

TEST_F(PathTest, LossAloneDoesNotShrinkItOnARadio)
{
    for (int i = 0; i < 3; ++i)
    {
        Round(100ms);
    }
    const std::size_t before = path.Window();
    for (int i = 0; i < 20; ++i)
    {
        path.Sent(One, now);
        path.Lost(One);
        Round(100ms);
    }
    EXPECT_GE(path.Window(), before);
    EXPECT_GT(path.LossRate(), 0.0);
}

TEST_F(PathTest, LossShrinksItOnAWireDownToWhatARadioNeeds)
{
    for (int i = 0; i < 10; ++i)
    {
        Round(200us);
    }
    const std::size_t before = path.Window();
    path.Sent(One, now);
    path.Lost(One);
    Round(200us);
    EXPECT_LT(path.Window(), before * 3 / 4);
    for (int i = 0; i < 100; ++i)
    {
        path.Sent(One, now);
        path.Lost(One);
        Round(200us);
    }
    EXPECT_GE(path.Window(), 8 * One);
}

TEST_F(PathTest, BeginsAnewAfterAnOutage)
{
    for (int i = 0; i < 6; ++i)
    {
        Round(100ms);
    }
    path.Restart();
    EXPECT_EQ(path.Window(), 4 * One);
    EXPECT_LE(path.PacedUntil(), now);
}

TEST_F(PathTest, MeasuresTheShortestRoundTripAnewWithOneDatagramUnderWay)
{
    Round(20ms);
    bool oneAtATime = false;
    while (now < 1s + settings.PathMemory + 2s)
    {
        Round(50ms);
        path.Sent(One, now);
        oneAtATime = oneAtATime || !path.HasRoom();
        path.Forget(One);
    }
    EXPECT_TRUE(oneAtATime);
    EXPECT_EQ(path.Shortest(), 50ms);
    EXPECT_GT(path.Window(), 2 * One) << "and goes on as before";
}

TEST_F(PathTest, SpreadsAWindowOverTheRoundTrip)
{
    Round(200ms);
    path.Sent(One, now);
    path.Sent(One, now);
    path.Sent(One, now);
    EXPECT_GT(path.PacedUntil(), now + 5ms);
    EXPECT_LT(path.PacedUntil(), now + 100ms);
}

TEST_F(PathTest, TheProbeTimerFollowsTheRoundTripWithinItsBounds)
{
    EXPECT_EQ(path.ProbeTimeout(), settings.FirstResend);
    path.Measured(100ms, now, now);
    EXPECT_EQ(path.ProbeTimeout(), 100ms + 4 * 50ms + 125ms);
    EXPECT_EQ(path.ProbeTimeout(1), 2 * 425ms);
    EXPECT_EQ(path.ProbeTimeout(9), 1s);
    PathControl fast(settings, starting);
    for (int i = 0; i < 100; ++i)
    {
        fast.Measured(100us, now, now);
    }
    EXPECT_EQ(fast.ProbeTimeout(), settings.MinResend);
    PathControl slow(settings, starting);
    slow.Measured(90s, now, now);
    EXPECT_EQ(slow.ProbeTimeout(), 3s) << "one straggler is no reason to fall silent";
}

TEST_F(PathTest, TheProbeTimerWaitsForAnswersThatThePeerHoldsBackUpToTheLimitOfItsBackoff)
{
    const auto answer = [this](LinkTime time, int times)
    {
        for (int i = 0; i < times; ++i)
        {
            path.Answered(time);
        }
        return path.ProbeTimeout();
    };
    EXPECT_EQ(answer(100ms, 4), settings.FirstResend) << "a few answers do not show what is usual";
    EXPECT_EQ(answer(100ms, 1), 300ms) << "without a round trip, too";
    path.Measured(10ms, now, now);
    EXPECT_EQ(path.ProbeTimeout(), 300ms);
    EXPECT_EQ(answer(20s, 3), settings.MaxResend);
}

TEST_F(PathTest, AnAnswerThatCameLateSinceAnEarlierOneWasLostDoesNotSlowTheProbeTimer)
{
    path.Measured(10ms, now, now);
    path.Answered(30ms);
    const LinkTime usual = path.ProbeTimeout();
    for (int i = 0; i < 20; ++i)
    {
        path.Answered(500ms);
        path.Answered(5ms);
        path.Answered(5ms);
        EXPECT_EQ(path.ProbeTimeout(), usual);
    }
}

TEST_F(PathTest, ALongWaitLeavesHowLateThePeerAnswersAndAnotherPathDoesNot)
{
    for (int i = 0; i < 5; ++i)
    {
        path.Answered(20s);
    }
    path.Restart();
    EXPECT_EQ(path.ProbeTimeout(), settings.MaxResend);
    path.Replace();
    EXPECT_EQ(path.ProbeTimeout(), settings.FirstResend);
}

TEST_F(PathTest, AsksForAnAcknowledgementInTimeAndNotForEachDatagram)
{
    for (int i = 0; i < 3; ++i)
    {
        Round(100ms);
    }
    int asked = 0;
    int sent = 0;
    while (path.HasRoom())
    {
        path.Sent(One, now);
        ++sent;
        asked += path.TakeAsk(now) ? 1 : 0;
    }
    EXPECT_GE(asked, 3);
    EXPECT_LE(asked, sent / 3);
}

}  // namespace
}  // namespace Rabit::Test
