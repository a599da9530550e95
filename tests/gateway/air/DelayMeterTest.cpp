#include "air/DelayMeter.h"

#include <gtest/gtest.h>

namespace Rabit
{
namespace
{

using namespace std::chrono_literals;
using Duration = DelayMeter::Duration;

// The sender's clock is 1000 s ahead of ours, and an undelayed datagram takes a millisecond.
constexpr Duration Ahead = 1000s;
constexpr Duration Way = 1ms;

class DelayMeterTest : public ::testing::Test
{
protected:
    // Hears a datagram that comes `late` later than it could.
    bool Hear(const char *node, Duration sent, Duration late, std::uint64_t incarnation = 1)
    {
        return meter.Heard(node, incarnation, sent + Ahead, sent + Way + late);
    }
    // Returns the reported delay of the newest datagram of uav1; -1: there is nothing to report.
    Duration Told(Duration now)
    {
        const auto &reports = meter.Take(1, now);
        return reports.empty() ? Duration(-1) : reports.front().Delay;
    }

    DelayMeter meter;
};

TEST_F(DelayMeterTest, OfAQuietWireThereIsNothingToTell)
{
    for (Duration sent = 0s; sent < 10s; sent += 100ms)
    {
        EXPECT_FALSE(Hear("uav1", sent, 19ms));
        EXPECT_EQ(Told(sent + 20ms), Duration(-1));
    }
}

TEST_F(DelayMeterTest, ALateDatagramIsToldAgainstTheQuickest)
{
    Hear("uav1", 0s, 5ms);
    Hear("uav1", 1s, 0ms);
    EXPECT_TRUE(Hear("uav1", 2s, 150ms));
    const auto reports = meter.Take(4, 2200ms);
    ASSERT_EQ(reports.size(), 1u);
    EXPECT_EQ(*reports[0].Node, "uav1");
    EXPECT_EQ(reports[0].Delay, 150ms);
    EXPECT_EQ(reports[0].Held, 49ms);
}

TEST_F(DelayMeterTest, EachReportIsAboutANewerDatagram)
{
    Hear("uav1", 0s, 0ms);
    Hear("uav1", 1s, 100ms);
    EXPECT_EQ(Told(2s), 100ms);
    EXPECT_EQ(Told(3s), Duration(-1));
    Hear("uav1", 3s, 90ms);
    EXPECT_EQ(Told(4s), 90ms);
}

TEST_F(DelayMeterTest, WhatWasOvertakenIsNotTold)
{
    Hear("uav1", 0s, 0ms);
    Hear("uav1", 1s, 100ms);
    Hear("uav1", 900ms, 500ms);
    EXPECT_EQ(Told(2s), 100ms);
    EXPECT_EQ(Told(2s), Duration(-1));
}

TEST_F(DelayMeterTest, ThatAllIsWellAgainIsToldForThreeSeconds)
{
    Hear("uav1", 0s, 0ms);
    Hear("uav1", 1s, 100ms);
    EXPECT_EQ(Told(1200ms), 100ms);
    Hear("uav1", 2s, 0ms);
    EXPECT_EQ(Told(2100ms), 0ms);
    Hear("uav1", 4500ms, 0ms);
    EXPECT_EQ(Told(4600ms), Duration(-1));
}

TEST_F(DelayMeterTest, WhoHasWaitedForLongestIsToldFirst)
{
    const std::vector<const char *> nodes = {"uav1", "uav2", "uav3"};
    for (const char *node : nodes)
    {
        Hear(node, 0s, 0ms);
        Hear(node, 1s, 100ms);
    }
    EXPECT_EQ(meter.Take(2, 1200ms).size(), 2u);
    for (const char *node : nodes)
    {
        Hear(node, 2s, 100ms);
    }
    const auto reports = meter.Take(2, 2200ms);
    ASSERT_EQ(reports.size(), 2u);
    EXPECT_EQ(*reports[0].Node, "uav3");
    EXPECT_EQ(*reports[1].Node, "uav1");
}

TEST_F(DelayMeterTest, AnotherLifeIsMeasuredAnew)
{
    Hear("uav1", 0s, 0ms, 1);
    Hear("uav1", 1s, 500ms, 2);  // of another clock
    EXPECT_EQ(Told(2s), Duration(-1));
    Hear("uav1", 2s, 540ms, 2);
    EXPECT_EQ(Told(3s), 40ms);
}

TEST_F(DelayMeterTest, AClockThatRunsSlowlyIsNoDelay)
{
    for (Duration sent = 0s; sent < 1h; sent += 500ms)
    {
        ASSERT_FALSE(Hear("uav1", sent, sent / 10000)) << sent.count();
    }
}

TEST_F(DelayMeterTest, AClockThatStoodStillIsNoDelay)
{
    Hear("uav1", 0s, 0ms);
    Hear("uav1", 1s, 11s);
    EXPECT_EQ(Told(13s), Duration(-1));
    Hear("uav1", 2s, 11100ms);
    EXPECT_EQ(Told(14s), 100ms);
}

TEST_F(DelayMeterTest, ADelayThatStaysForMinutesIsTheWay)
{
    Hear("uav1", 0s, 0ms);
    Duration sent = 1s;
    for (; sent < 130s; sent += 500ms)
    {
        Hear("uav1", sent, 300ms);
        ASSERT_EQ(Told(sent + 301ms), 300ms);
    }
    for (; sent < 160s; sent += 500ms)
    {
        Hear("uav1", sent, 300ms);
        Told(sent + 301ms);
    }
    Hear("uav1", 165s, 300ms);
    EXPECT_EQ(Told(166s), Duration(-1));
}

TEST_F(DelayMeterTest, TimesThatNoClockShowsAreDropped)
{
    Hear("uav1", 0s, 0ms);
    EXPECT_FALSE(meter.Heard("uav1", 1, Duration::max(), 1s));
    EXPECT_FALSE(meter.Heard("uav1", 1, Duration::min(), 1s));
    EXPECT_FALSE(meter.Heard("uav1", 1, Duration(-1), 1s));
    EXPECT_TRUE(Hear("uav1", 1s, 50ms));
    EXPECT_EQ(Told(2s), 50ms);
}

TEST_F(DelayMeterTest, TheOneThatWasSilentForLongestMakesRoom)
{
    Hear("first", 0s, 0ms);
    Hear("second", 1s, 0ms);
    for (std::size_t i = 2; i < DelayMeter::MostPeers; ++i)
    {
        Hear(("uav" + std::to_string(i)).c_str(), 2s, 0ms);
    }
    Hear("new", 3s, 0ms);
    EXPECT_TRUE(Hear("second", 4s, 50ms));
    EXPECT_FALSE(Hear("first", 4s, 50ms));
}

}  // namespace
}  // namespace Rabit
