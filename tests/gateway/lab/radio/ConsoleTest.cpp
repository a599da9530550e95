#include "Console.h"

#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

namespace Rabit::Radio
{
namespace
{

using namespace std::chrono_literals;
using nlohmann::json;

class ConsoleTest : public testing::Test
{
protected:
    ConsoleTest()
    {
        medium.Add("ground", {2, 0, 0, 0, 0, 0});
        medium.Add("uav1", {2, 0, 0, 0, 0, 1});
        medium.Add("uav2", {2, 0, 0, 0, 0, 2});
    }

    json Tell(const char *line, Time now = 0s) { return json::parse(console.Answer(now, line)); }

    Medium medium{MediumSettings{1'000'000, 16'000, 0, 1}};
    Console console{medium};
};

TEST_F(ConsoleTest, RateIsSetInBitsPerSecondOrUnlimited)
{
    EXPECT_EQ(Tell("rate 57600"), json({{"ok", true}}));
    EXPECT_EQ(medium.Rate(), 57'600);
    Tell("  rate\tunlimited \r");
    EXPECT_EQ(medium.Rate(), std::nullopt);
}

TEST_F(ConsoleTest, LossIsPercentOfAllLinksOrOfOneWay)
{
    Tell("loss 20 uav1 ground");
    EXPECT_EQ(medium.LinkOf(1, 0).Loss, 0.2);
    EXPECT_EQ(medium.LinkOf(0, 1).Loss, 0);
    Tell("loss 5.5 * uav2");
    EXPECT_EQ(medium.LinkOf(0, 2).Loss, 0.055);
    EXPECT_EQ(medium.LinkOf(2, 0).Loss, 0);
    Tell("loss 0");
    EXPECT_EQ(medium.LinkOf(1, 0).Loss, 0);
}

TEST_F(ConsoleTest, DuplicatesArePercentAndLeaveTheLossAsItIs)
{
    Tell("loss 20");
    Tell("duplicate 5 uav1 ground");
    EXPECT_EQ(medium.LinkOf(1, 0).Duplicate, 0.05);
    EXPECT_EQ(medium.LinkOf(1, 0).Loss, 0.2);
    EXPECT_EQ(medium.LinkOf(0, 1).Duplicate, 0);
}

TEST_F(ConsoleTest, DelayAndJitterAreMillisecondsAndLeaveTheLossAsItIs)
{
    Tell("loss 20");
    Tell("delay 300 jitter 20");
    EXPECT_EQ(medium.LinkOf(1, 2).Delay, 300ms);
    EXPECT_EQ(medium.LinkOf(1, 2).Jitter, 20ms);
    EXPECT_EQ(medium.LinkOf(1, 2).Loss, 0.2);
    Tell("delay 0.5 uav1 uav2");
    EXPECT_EQ(medium.LinkOf(1, 2).Delay, 500us);
    EXPECT_EQ(medium.LinkOf(1, 2).Jitter, 0ms);
    EXPECT_EQ(medium.LinkOf(2, 1).Delay, 300ms);
}

TEST_F(ConsoleTest, DeafNamesTheHearerFirst)
{
    Tell("deaf uav1 uav2");
    EXPECT_TRUE(medium.LinkOf(2, 1).Deaf);
    EXPECT_FALSE(medium.LinkOf(1, 2).Deaf);
    Tell("hear uav1 *");
    EXPECT_FALSE(medium.LinkOf(2, 1).Deaf);
}

TEST_F(ConsoleTest, QueuesOfOneOrAll)
{
    Tell("rate 1");
    Tell("queue 500 uav1");
    for (std::size_t node : {0u, 1u})
    {
        for (int k = 0; k < 3; ++k)
        {
            medium.Offer(0s, node, std::make_shared<const Frame>(Frame(400)));
        }
    }
    EXPECT_EQ(medium.CountersOf(0).Dropped.Frames, 0u);
    EXPECT_EQ(medium.CountersOf(1).Dropped.Frames, 2u);
}

TEST_F(ConsoleTest, OutageAndItsEnd)
{
    Tell("outage on");
    EXPECT_TRUE(medium.IsOut());
    Tell("outage off");
    EXPECT_FALSE(medium.IsOut());
}

TEST_F(ConsoleTest, CountersTellOfTheMediumAndOfEachNode)
{
    Tell("overhead 50");
    Frame frame(950);
    frame[0] = 0xff;
    medium.Offer(0s, 1, std::make_shared<const Frame>(frame));
    medium.Offer(0s, 1, std::make_shared<const Frame>(frame));
    std::vector<Arrival> arrived;
    medium.Advance(20ms, arrived);
    const json later = Tell("counters", 20ms);
    EXPECT_EQ(later["bits_per_s"], 1'000'000);
    EXPECT_EQ(later["seconds"], 0.02);
    EXPECT_EQ(later["sent"]["bytes"], 2000);
    EXPECT_EQ(later["utilisation"], 0.8);
    EXPECT_EQ(later["nodes"]["uav1"]["multicast"]["frames"], 2);
    EXPECT_EQ(later["nodes"]["uav1"]["longest_wait_ms"], 8.0);
    EXPECT_EQ(later["nodes"]["ground"]["heard"]["frames"], 2);
    EXPECT_EQ(Tell("kinds")["uav1"]["multicast ethertype 0"], json({2, 2000}));
    Tell("reset", 20ms);
    EXPECT_EQ(Tell("counters", 30ms)["sent"]["bytes"], 0);
}

TEST_F(ConsoleTest, WhatIsNotUnderstoodIsAnsweredWithTheReasonAndChangesNothing)
{
    for (const char *line : {"",
                             "fly",
                             "rate",
                             "rate 0",
                             "rate -1",
                             "rate nan",
                             "rate 1e99",
                             "rate 5 6",
                             "rate 1x",
                             "loss 101",
                             "duplicate 101",
                             "duplicate -1",
                             "loss -1",
                             "loss 5 uav1",
                             "loss 5 uav1 nobody",
                             "loss 5 uav1 uav2 more",
                             "delay",
                             "delay 5 jitter",
                             "delay 5 jitter x",
                             "delay inf",
                             "deaf uav1",
                             "outage maybe",
                             "outage on now",
                             "queue -1",
                             "queue 5 nobody",
                             "counters now",
                             "reset all",
                             "overhead",
                             "\xff\xfe"})
    {
        EXPECT_TRUE(Tell(line).contains("error")) << line;
    }
    EXPECT_EQ(medium.Rate(), 1'000'000);
    EXPECT_EQ(medium.LinkOf(0, 1).Loss, 0);
    EXPECT_FALSE(medium.IsOut());
}

TEST_F(ConsoleTest, LossMayComeInBursts)
{
    EXPECT_EQ(Tell("loss 20 burst 8 ground uav1"), json({{"ok", true}}));
    EXPECT_EQ(medium.LinkOf(0, 1).Burst, 8);
    EXPECT_EQ(medium.LinkOf(1, 0).Burst, 1);
    EXPECT_EQ(Tell("loss 10 ground uav1"), json({{"ok", true}}));
    EXPECT_EQ(medium.LinkOf(0, 1).Burst, 1);
    EXPECT_TRUE(Tell("loss 10 burst 0").contains("error"));
}

TEST_F(ConsoleTest, NodesAreHiddenFromEachOther)
{
    EXPECT_EQ(Tell("hidden uav1 uav2 on"), json({{"ok", true}}));
    EXPECT_EQ(Tell("hidden * * off"), json({{"ok", true}}));
    EXPECT_TRUE(Tell("hidden uav1 nobody on").contains("error"));
    EXPECT_TRUE(Tell("hidden uav1 uav2").contains("error"));
}

}  // namespace
}  // namespace Rabit::Radio
