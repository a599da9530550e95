#include "rtps/QueueingDelay.h"

#include <gtest/gtest.h>

namespace
{

using namespace std::chrono_literals;
using Rabit::Rtps::QueueingDelay;

constexpr QueueingDelay::TimePoint Start{1h};

// Receives a datagram that was sent at `sent` and took `took`. The sender's clock has an offset.
void Arrive(QueueingDelay &delay, QueueingDelay::Duration sent, QueueingDelay::Duration took)
{
    delay.Heard(QueueingDelay::Stamp(Start + sent) + 4'000'000'000u, Start + sent + took);
}

TEST(QueueingDelay, IsWhatDatagramsTakeLongerThanTheQuickest)
{
    QueueingDelay delay;
    EXPECT_FALSE(delay.At(Start).has_value());
    Arrive(delay, 0s, 5ms);
    EXPECT_EQ(delay.At(Start + 5ms), 0ms);
    Arrive(delay, 1s, 805ms);
    EXPECT_EQ(delay.At(Start + 2s), 800ms);
}

TEST(QueueingDelay, OfOneThatHasHeardNothingElseIsHalfOfTheRoundTrip)
{
    QueueingDelay delay;
    Arrive(delay, 0s, 2s);
    EXPECT_EQ(delay.At(Start + 2s), 0ms);
    EXPECT_FALSE(delay.IsByAnswer(Start + 2s));
    Arrive(delay, 2s, 2s);
    delay.Answered(QueueingDelay::Stamp(Start), Start + 4s);
    EXPECT_EQ(delay.At(Start + 4s), 2s);
    EXPECT_TRUE(delay.IsByAnswer(Start + 4s));
    delay.Answered(QueueingDelay::Stamp(Start) - 3'600'000u, Start + 4s);  // a lie
    EXPECT_EQ(delay.At(Start + 4s), 2s);
}

TEST(QueueingDelay, FallsWithTheQueueAfterARoundTripToo)
{
    QueueingDelay delay;
    Arrive(delay, 2s, 2s);
    delay.Answered(QueueingDelay::Stamp(Start), Start + 4s);
    Arrive(delay, 5s, 300ms);
    EXPECT_EQ(delay.At(Start + 5300ms), 300ms);
}

TEST(QueueingDelay, ADelayLongerThanTheRoundTripWasAClockThatStoodStill)
{
    QueueingDelay delay;
    Arrive(delay, 0s, 5ms);
    Arrive(delay, 1s, 3s);  // the peer's computer paused
    EXPECT_EQ(delay.At(Start + 4s), 2995ms);
    Arrive(delay, 5s, 3s);
    delay.Answered(QueueingDelay::Stamp(Start + 7990ms), Start + 8s);
    EXPECT_EQ(delay.At(Start + 8s), 5ms);
    Arrive(delay, 9s, 3s);
    EXPECT_EQ(delay.At(Start + 12s), 5ms);
}

TEST(QueueingDelay, CountsUntilTheAnswerToARequestCanHaveCome)
{
    QueueingDelay delay;
    Arrive(delay, 4s, 4s);
    delay.Answered(QueueingDelay::Stamp(Start), Start + 8s);
    EXPECT_EQ(delay.At(Start + 8s + QueueingDelay::Fresh + 7s), 4s);
    EXPECT_FALSE(delay.At(Start + 8s + QueueingDelay::Fresh + 9s).has_value());
}

TEST(QueueingDelay, SaysNothingOfLongAgo)
{
    QueueingDelay delay;
    Arrive(delay, 0s, 5ms);
    EXPECT_FALSE(delay.At(Start + 5ms + QueueingDelay::Fresh).has_value());
}

TEST(QueueingDelay, TheQuickestIsForgottenAfterTwoWindows)
{
    QueueingDelay delay;
    Arrive(delay, 0s, 0ms);
    for (auto sent = 1s; sent <= 3 * QueueingDelay::Window; sent += 1s)
    {
        Arrive(delay, sent, 300ms);
    }
    EXPECT_EQ(delay.At(Start + 3 * QueueingDelay::Window + 300ms), 0ms);
}

TEST(QueueingDelay, TheQuickestOfTheWindowBeforeIsKnown)
{
    QueueingDelay delay;
    Arrive(delay, 0s, 0ms);
    Arrive(delay, QueueingDelay::Window + 1s, 300ms);
    EXPECT_EQ(delay.At(Start + QueueingDelay::Window + 2s), 300ms);
}

TEST(QueueingDelay, AClockThatStoodStillInEachOfTwoWindowsIsNoQueue)
{
    QueueingDelay delay;
    Arrive(delay, 0s, 0s);
    Arrive(delay, QueueingDelay::Window + 1s, 8s);
    Arrive(delay, QueueingDelay::Window + 2s, 16s);
    EXPECT_EQ(delay.At(Start + QueueingDelay::Window + 18s), 0ms);
}

TEST(QueueingDelay, AClockThatStoodStillIsNoQueue)
{
    QueueingDelay delay;
    Arrive(delay, 0s, 5ms);
    Arrive(delay, 1s, QueueingDelay::Longest + 1s);
    EXPECT_EQ(delay.At(Start + 2s + QueueingDelay::Longest), 0ms);
}

}  // namespace
