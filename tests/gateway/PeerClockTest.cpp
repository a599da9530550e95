#include "clocks/PeerClock.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

namespace Rabit
{
namespace
{

using namespace std::chrono_literals;
using Ns = std::chrono::nanoseconds;

TEST(PeerClock, KnowsNothingBeforeTheFirstBeat)
{
    const PeerClock clock;
    EXPECT_FALSE(clock.ToLocal(1s).has_value());
    EXPECT_FALSE(clock.RoundTrip().has_value());
}

TEST(PeerClock, TurnsAPeersSourceClockIntoOursWhateverItShows)
{
    // The peer's source clock claims 1985, transit takes 10 ms each way.
    PeerClock clock;
    const Ns sourceOfPeer = 500'000'000s;
    for (int i = 0; i < 10; ++i)
    {
        const Ns sent = 20s + i * 500ms;
        clock.OnBeat({sourceOfPeer + sent, 0s}, sent + 10ms);
        clock.OnRoundTrip(20ms, sent + 10ms);
    }
    EXPECT_EQ(clock.ToLocal(sourceOfPeer + 23s), Ns(23s));
    EXPECT_EQ(clock.SentAt(sourceOfPeer + 23s), Ns(23s));
}

TEST(PeerClock, IgnoresBeatsThatWereDelayed)
{
    PeerClock clock;
    clock.OnBeat({1001s, 0s}, 1s + 1ms);
    clock.OnRoundTrip(2ms, 1s + 1ms);
    clock.OnBeat({1002s, 0s}, 2s + 700ms);
    EXPECT_EQ(clock.ToLocal(1002s), Ns(2s));
}

TEST(PeerClock, AStepOfThePeersWallClockChangesTheStampAndNotTheAge)
{
    PeerClock clock;
    clock.OnBeat({1001s, 1001s}, 1s);
    clock.OnBeat({1002s, 1002s + 3600s}, 2s);
    EXPECT_EQ(clock.ToLocal(1002s), Ns(2s));
    EXPECT_EQ(clock.SourceToWall(), Ns(3600s));
}

TEST(PeerClock, ForgetsAnOldMinimumSoThatDriftDoesNotAddUp)
{
    // The peer's monotonic clock runs 1 ms a second slow, far worse than any crystal.
    PeerClock clock;
    Ns now = 0s;
    Ns peer = 0s;
    for (int i = 0; i < 600; ++i)
    {
        now += 500ms;
        peer += 499500us;
        clock.OnBeat({peer, peer}, now);
    }
    const Ns error = now - *clock.ToLocal(peer);
    EXPECT_LE(error, Ns(30ms));
    EXPECT_GE(error, Ns(0));
}

TEST(PeerClock, ForgetsAnOldRoundTripOnAPathThatBecameLonger)
{
    PeerClock clock;
    clock.OnBeat({0s, 0s}, 1ms);
    clock.OnRoundTrip(2ms, 1ms);
    for (int i = 1; i < 100; ++i)
    {
        clock.OnBeat({i * 500ms, i * 500ms}, i * 500ms + 40ms);
        clock.OnRoundTrip(80ms, i * 500ms + 40ms);
    }
    EXPECT_EQ(*clock.SentAt(10s), Ns(10s));
    EXPECT_EQ(clock.RoundTrip(), Ns(80ms));
}

TEST(PeerClock, AQueueThatWasFullWhenTheRoundTripWasMeasuredMakesNothingOlder)
{
    PeerClock clock;
    clock.OnBeat({1001s, 0s}, 1s + 2010ms);
    clock.OnRoundTrip(10ms + 2010ms, 1s + 2010ms);  // the way there took 10 ms
    for (int i = 4; i < 12; ++i)
    {
        clock.OnBeat({1000s + i * 1s, 0s}, i * 1s + 10ms);  // without an echo
    }
    EXPECT_EQ(clock.ToLocal(1011s), Ns(11s));
}

TEST(PeerClock, ThereAndBackMayBeQuickAtDifferentTimes)
{
    PeerClock clock;
    clock.OnBeat({1001s, 0s}, 1s + 10ms);
    clock.OnRoundTrip(1500ms + 10ms, 1s + 10ms);
    clock.OnBeat({1002s, 0s}, 2s + 2s);
    clock.OnRoundTrip(10ms + 2s, 4s);
    EXPECT_EQ(clock.ToLocal(1011s), Ns(11s));
}

TEST(PeerClock, AStandstillOfOurClockThatIsLongerThanTheRoundTripIsSeenAtTheNextEcho)
{
    PeerClock clock;
    clock.OnBeat({1001s, 0s}, 1s + 10ms);
    clock.OnRoundTrip(20ms, 1s + 10ms);
    // For the peer five seconds pass in which no time passes here.
    clock.OnBeat({1007s, 0s}, 2s + 10ms);
    EXPECT_EQ(clock.ToLocal(1007s), Ns(2s)) << "half of the round trip, while there is no other";
    clock.OnBeat({1008s, 0s}, 3s + 10ms);
    clock.OnRoundTrip(30ms, 3s + 10ms);
    EXPECT_EQ(clock.ToLocal(1008s), Ns(3s) - 5ms);
}

TEST(PeerClock, IgnoresANegativeRoundTrip)
{
    PeerClock clock;
    clock.OnRoundTrip(-5ms, 0s);
    EXPECT_FALSE(clock.RoundTrip().has_value());
}

// A peer whose source clock is 1000 s ahead of our monotonic one.
class PeerClockAfterAStandstill : public ::testing::Test
{
protected:
    static PeerClock::Reading ReadingAt(Ns monotonic) { return {.Source = 1000s + monotonic, .Wall = 0s}; }

    // Receives a beat that was sent at `peerSent`. `roundTrip` is that of the beat and of our beat that it
    // echoes.
    void Beat(Ns peerSent, Ns arrival, Ns roundTrip)
    {
        clock.OnBeat(ReadingAt(peerSent), arrival);
        clock.OnRoundTrip(roundTrip, arrival);
    }

    // Beats on a short path until now = 20 s; then the peer stands still for 60 s.
    void SetUp() override
    {
        for (Ns sent = 0s; sent < 20s; sent += 500ms)
        {
            Beat(sent, sent + 10ms, 20ms);
        }
    }
    static constexpr Ns StoodStill = 60s;

    PeerClock clock;
};

TEST_F(PeerClockAfterAStandstill, ABeatThatIsYoungerThanTheEstimateByItsOwnRoundTripCorrectsIt)
{
    Beat(20s, 20s + StoodStill + 10ms, 20ms);
    EXPECT_EQ(clock.SentAt(1000s + 20s), Ns(20s + StoodStill));
    EXPECT_EQ(clock.ToLocal(1000s + 21s), Ns(21s + StoodStill));
}

TEST_F(PeerClockAfterAStandstill, NoBeatWithoutARoundTripCorrectsTheEstimate)
{
    for (Ns sent = 20s; sent < 25s; sent += 500ms)
    {
        clock.OnBeat(ReadingAt(sent), sent + StoodStill + 10ms);
    }
    EXPECT_EQ(clock.SentAt(1000s + 25s), Ns(25s)) << "they may all have been held up as long";
}

TEST_F(PeerClockAfterAStandstill, AnEchoOfABeatFromBeforeItProvesNothing)
{
    // The peer does not know that it held the echo for 60 s.
    Beat(20s, 20s + StoodStill + 10ms, StoodStill + 20ms);
    EXPECT_EQ(clock.SentAt(1000s + 20s), Ns(20s));
}

TEST_F(PeerClockAfterAStandstill, ABeatThatWasHeldUpIsAsOldAsItIs)
{
    Beat(20s, 20s + StoodStill, StoodStill + 10ms);
    EXPECT_EQ(clock.SentAt(1000s + 20s), Ns(20s));
}

TEST_F(PeerClockAfterAStandstill, WhatWasStampedBeforeItIsNotMadeYounger)
{
    Beat(20s, 20s + StoodStill + 10ms, 20ms);
    EXPECT_EQ(clock.ToLocal(1000s + 5s), Ns(5s));
}

TEST_F(PeerClockAfterAStandstill, WhatWasStampedBeforeSeveralIsNeverMadeYounger)
{
    Beat(20s, 20s + StoodStill + 10ms, 20ms);
    Beat(30s, 30s + 2 * StoodStill + 10ms, 20ms);
    EXPECT_EQ(clock.ToLocal(1000s + 5s), Ns(5s));
    EXPECT_LE(clock.ToLocal(1000s + 25s), Ns(25s + StoodStill));
    EXPECT_EQ(clock.ToLocal(1000s + 31s), Ns(31s + 2 * StoodStill));
}

TEST_F(PeerClockAfterAStandstill, OfOursMovesWhatWasStampedBeforeOneOfThePeersToo)
{
    Beat(20s, 20s + StoodStill + 10ms, 20ms);
    // Our clock stands still for 7 s.
    Beat(37s, 30s + StoodStill + 10ms, 20ms);
    EXPECT_EQ(clock.ToLocal(1000s + 38s), Ns(31s + StoodStill));
    EXPECT_EQ(clock.ToLocal(1000s + 5s), Ns(-2s));
}

TEST(PeerClock, DelaysOfSecondsThatRiseAndFallAreNotTakenForAStandstill)
{
    // A thin radio with full queues: each way takes up to 4 s, slowly varying and in turns.
    for (unsigned seed = 0; seed < 200; ++seed)
    {
        std::mt19937 random(seed);
        const auto step = [&](Ns &delay)
        {
            delay += Ns(std::uniform_int_distribution<std::int64_t>(-300'000'000, 300'000'000)(random));
            delay = std::clamp(delay, Ns(20ms), Ns(4s));
        };
        PeerClock clock;
        Ns there = 20ms;
        Ns back = 20ms;
        Ns shortest = 1h;
        for (Ns sent = 0s; sent < 60s; sent += 500ms)
        {
            step(there);
            step(back);
            const auto before = clock.SentAt(0s);
            clock.OnBeat({sent, 0s}, sent + back);
            shortest = std::min(shortest, back);
            clock.OnRoundTrip(there + back, sent + back);
            if (before && sent < 15s)
            {
                EXPECT_LE(*clock.SentAt(0s), shortest) << "seed " << seed;
            }
            EXPECT_EQ(*clock.ToLocal(sent) - *clock.ToLocal(0s), sent) << "seed " << seed;
        }
    }
}

}  // namespace
}  // namespace Rabit
