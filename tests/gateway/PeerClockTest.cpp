#include "clocks/PeerClock.h"

#include <gtest/gtest.h>

namespace Rabit
{
namespace
{

using namespace std::chrono_literals;
using Ns = std::chrono::nanoseconds;

TEST(PeerClock, KnowsNothingBeforeTheFirstBeat)
{
    const PeerClock clock;
    EXPECT_FALSE(clock.SourceToLocal().has_value());
    EXPECT_FALSE(clock.RoundTrip().has_value());
}

TEST(PeerClock, TurnsAPeersSourceClockIntoOursWhateverItShows)
{
    // The peer's monotonic clock is 100 s ahead of ours, its source clock claims 1985, transit takes 10 ms
    // each way.
    PeerClock clock;
    const Ns sourceOfPeer = 500'000'000s;
    for (int i = 0; i < 10; ++i)
    {
        const Ns sent = 20s + i * 500ms;
        clock.OnBeat({100s + sent, sourceOfPeer + sent, 0s}, sent + 10ms);
        clock.OnRoundTrip(20ms, sent + 10ms);
    }
    ASSERT_TRUE(clock.SourceToLocal().has_value());
    EXPECT_EQ(sourceOfPeer + 23s + *clock.SourceToLocal(), Ns(23s));
    EXPECT_EQ(clock.SentAt(100s + 23s), Ns(23s));
}

TEST(PeerClock, IgnoresBeatsThatWereDelayed)
{
    PeerClock clock;
    clock.OnBeat({1s, 1001s, 0s}, 1s + 1ms);
    clock.OnRoundTrip(2ms, 1s + 1ms);
    clock.OnBeat({2s, 1002s, 0s}, 2s + 700ms);
    EXPECT_EQ(1002s + *clock.SourceToLocal(), Ns(2s));
}

TEST(PeerClock, AStepOfThePeersWallClockChangesTheStampAndNotTheAge)
{
    PeerClock clock;
    clock.OnBeat({1s, 1001s, 1001s}, 1s);
    clock.OnBeat({2s, 1002s, 1002s + 3600s}, 2s);
    EXPECT_EQ(1002s + *clock.SourceToLocal(), Ns(2s));
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
        clock.OnBeat({peer, peer, peer}, now);
    }
    const Ns error = now - (peer + *clock.SourceToLocal());
    EXPECT_LE(error, Ns(30ms));
    EXPECT_GE(error, Ns(0));
}

TEST(PeerClock, ForgetsAnOldRoundTripOnAPathThatBecameLonger)
{
    PeerClock clock;
    clock.OnRoundTrip(2ms, 0s);
    for (int i = 1; i < 100; ++i)
    {
        clock.OnRoundTrip(80ms, i * 500ms);
        clock.OnBeat({i * 500ms, i * 500ms, i * 500ms}, i * 500ms + 40ms);
    }
    EXPECT_EQ(*clock.SentAt(10s), Ns(10s));
    EXPECT_EQ(clock.RoundTrip(), Ns(80ms));
}

TEST(PeerClock, IgnoresANegativeRoundTrip)
{
    PeerClock clock;
    clock.OnRoundTrip(-5ms, 0s);
    EXPECT_FALSE(clock.RoundTrip().has_value());
}

}  // namespace
}  // namespace Rabit
