#include "air/DelayReports.h"

#include <gtest/gtest.h>

namespace Rabit
{
namespace
{

using namespace std::chrono_literals;
using Duration = DelayReports::Duration;

constexpr Duration Late = 100ms;

class DelayReportsTest : public ::testing::Test
{
protected:
    void Say(DelayReports::Peer peer, Duration delay, Duration now) { _reports.Add(peer, delay, now, now); }
    bool Agree(Duration now) const { return _reports.Agree(Late, now); }

    DelayReports _reports;
};

TEST_F(DelayReportsTest, NobodyAgreesOnNothing)
{
    EXPECT_FALSE(Agree(0s));
    EXPECT_FALSE(_reports.Latest(0s));
    EXPECT_EQ(_reports.Of(1), nullptr);
}

TEST_F(DelayReportsTest, OnePeerIsBelievedWithThreeReportsInARow)
{
    Say(1, 200ms, 1s);
    Say(1, 200ms, 2s);
    EXPECT_FALSE(Agree(2s));
    Say(1, 50ms, 3s);
    Say(1, 200ms, 4s);
    Say(1, 200ms, 5s);
    EXPECT_FALSE(Agree(5s));
    Say(1, 200ms, 6s);
    EXPECT_TRUE(Agree(6s));
}

TEST_F(DelayReportsTest, TwoPeersAreBelievedWithTwoReportsEach)
{
    Say(1, 200ms, 1s);
    Say(2, 200ms, 1100ms);
    Say(1, 200ms, 1500ms);
    EXPECT_FALSE(Agree(1500ms));
    Say(2, 200ms, 1600ms);
    EXPECT_TRUE(Agree(1600ms));
}

TEST_F(DelayReportsTest, OneOfTwoIsNotBelievedAgainstTheOther)
{
    for (auto now = 1s; now < 60s; now += 1s)
    {
        Say(1, 900ms, now);
        Say(2, 10ms, now + 500ms);
        EXPECT_FALSE(Agree(now + 500ms));
    }
}

TEST_F(DelayReportsTest, OneIsBelievedWhileTheOtherKnowsNothingNewer)
{
    Say(2, 10ms, 900ms);
    Say(1, 200ms, 1500ms);
    Say(1, 400ms, 1800ms);
    Say(1, 600ms, 2000ms);
    EXPECT_FALSE(Agree(2000ms));
    Say(1, 700ms, 2100ms);
    EXPECT_TRUE(Agree(2100ms));
    Say(2, 10ms, 2200ms);
    EXPECT_FALSE(Agree(2200ms));
}

TEST_F(DelayReportsTest, OfManyMoreThanHalfMustSaySo)
{
    for (DelayReports::Peer peer = 1; peer <= 6; ++peer)
    {
        Say(peer, peer <= 3 ? 200ms : 10ms, 1s);
    }
    EXPECT_FALSE(Agree(1s));
    Say(4, 200ms, 1500ms);
    EXPECT_TRUE(Agree(1500ms));
}

TEST_F(DelayReportsTest, WhatIsOldDoesNotCount)
{
    for (int i = 0; i < 3; ++i)
    {
        Say(1, 200ms, 1s + i * 1s);
    }
    EXPECT_TRUE(Agree(8s));
    EXPECT_FALSE(Agree(8001ms));
    EXPECT_FALSE(_reports.Latest(8001ms));
}

TEST_F(DelayReportsTest, TheLowerMedianIsTheDelay)
{
    Say(1, 10ms, 1s);
    Say(2, 30ms, 1s);
    EXPECT_EQ(_reports.Latest(1s), 10ms);
    Say(3, 900ms, 1s);
    EXPECT_EQ(_reports.Latest(1s), 30ms);
    Say(3, 20ms, 2s);
    EXPECT_EQ(_reports.Latest(2s), 20ms);
}

TEST_F(DelayReportsTest, PeersAndReportsAreBounded)
{
    for (DelayReports::Peer peer = 0; peer < 1000; ++peer)
    {
        for (int i = 0; i < 20; ++i)
        {
            Say(peer, 10ms, 1s + peer * 1ms);
        }
    }
    int known = 0;
    for (DelayReports::Peer peer = 0; peer < 1000; ++peer)
    {
        if (const auto *said = _reports.Of(peer))
        {
            EXPECT_EQ(said->size(), DelayReports::MostReports);
            EXPECT_GE(peer, 1000 - DelayReports::MostPeers);
            ++known;
        }
    }
    EXPECT_EQ(known, static_cast<int>(DelayReports::MostPeers));
}

TEST_F(DelayReportsTest, NoDatagramArrivesBeforeItWasSentOrAfterItsReport)
{
    _reports.Add(1, -50ms, 3s, 2s);
    EXPECT_EQ(_reports.Of(1)->back().Delay, 0ms);
    EXPECT_EQ(_reports.Of(1)->back().ArrivedAt, 2s);
}

}  // namespace
}  // namespace Rabit
