// Media that nodes of the simulated network share: rate, queues, turns, and the bytes that are sent.
#include <gmock/gmock.h>

#include <algorithm>
#include <chrono>
#include <sstream>

#include "../conformance/Recorder.h"
#include "../conformance/TestSample.h"
#include "SimulatedHarness.h"

namespace Rabit::Conformance
{

namespace
{

using namespace std::chrono_literals;
using testing::ElementsAre;
using testing::SizeIs;

// A sample that takes `bytes` bytes on the air, headers included.
RawSample SampleOnAir(std::size_t bytes)
{
    constexpr std::size_t Headers =
        20 + 8 + 20 + 12 + 24 + 4;  // IPv4, UDP, RTPS, INFO_TS, DATA, encapsulation
    return RawSample{std::vector<std::uint8_t>(bytes - Headers)};
}

std::string Numbered(std::string text, int number)
{
    text += std::to_string(number);
    return text;
}

SimulatedFaults AtOnce()
{
    SimulatedFaults faults;
    faults.Delay = 0ms;
    return faults;
}

// Writers of telemetry at uav1 and uav2, readers of both at ground and tower, all matched and quiet. The
// lease is so long that no node sends anything by itself.
class SimulatedMediumTest : public testing::Test
{
protected:
    explicit SimulatedMediumTest(bool multicast = true) : _multicast(multicast)
    {
        Net.Network().SetFaults("*", "*", AtOnce());
        EXPECT_TRUE(Net.Until(
            [&]
            {
                return FromUav1->MatchedReaders() == 2 && FromUav2->MatchedReaders() == 2 &&
                       AtGround->MatchedWriters() == 2 && AtTower->MatchedWriters() == 2;
            }));
        Net.Pass(20s);
        Start = Net.Network().Now();
    }

    std::unique_ptr<TransportSession> Open(const std::string &node)
    {
        TransportSettings settings = Net.SettingsFor(node, 1);
        settings.Multicast = _multicast;
        settings.Memory = settings.Lease = 3h;
        settings.AnnouncementPeriod = 1h;
        return Net.Backend().Open(settings, {});
    }
    // Logs the arrival of each sample: its sender, and the time in milliseconds after the start.
    SampleHandler Log(std::vector<std::string> &log)
    {
        return [this, &log](SampleBytes, const SampleInfo &info)
        {
            const auto at =
                std::chrono::duration_cast<std::chrono::milliseconds>(Net.Network().Now() - Start);
            log.push_back(std::string(info.Node) + " " + std::to_string(at.count()));
        };
    }
    static void Write(TransportWriter &writer, std::size_t bytes, int count = 1)
    {
        for (int i = 0; i < count; ++i)
        {
            ASSERT_EQ(writer.Write(SampleOnAir(bytes), 1), WriteResult::Ok);
        }
    }

    const bool _multicast;
    SimulatedHarness Net;
    std::chrono::nanoseconds Start{0};
    std::vector<std::string> Heard;       // at ground
    std::vector<std::string> HeardThere;  // at tower
    std::unique_ptr<TransportSession> Uav1 = Open("uav1");
    std::unique_ptr<TransportSession> Uav2 = Open("uav2");
    std::unique_ptr<TransportSession> Ground = Open("ground");
    std::unique_ptr<TransportSession> Tower = Open("tower");
    std::unique_ptr<TransportWriter> FromUav1 = Uav1->CreateWriter(TextTopic(), Telemetry(), {});
    std::unique_ptr<TransportWriter> FromUav2 = Uav2->CreateWriter(TextTopic(), Telemetry(), {});
    std::unique_ptr<TransportReader> AtGround =
        Ground->CreateReader(TextTopic(), Telemetry(), {}, Log(Heard));
    std::unique_ptr<TransportReader> AtTower =
        Tower->CreateReader(TextTopic(), Telemetry(), {}, Log(HeardThere));
};

class SimulatedUnicastMediumTest : public SimulatedMediumTest
{
protected:
    SimulatedUnicastMediumTest() : SimulatedMediumTest(false) {}
};

TEST_F(SimulatedMediumTest, WithoutAMediumNothingTakesTime)
{
    Write(*FromUav1, 1000, 100);
    Net.Pass(0ms);
    EXPECT_THAT(Heard, SizeIs(100));
}

TEST_F(SimulatedMediumTest, ADatagramTakesItsSizeOfTheAir)
{
    Net.Network().SetMedium("*", {.BytesPerSecond = 10'000});
    Write(*FromUav1, 1000, 2);
    Write(*FromUav1, 500);
    Net.Pass(1s);
    EXPECT_THAT(Heard, ElementsAre("uav1 100", "uav1 200", "uav1 250"));
    EXPECT_EQ(Net.Network().Air("*").Carried, 3u);
    EXPECT_EQ(Net.Network().Air("*").CarriedBytes, 2500u);
    EXPECT_EQ(Net.Network().Air("*").LongestWait, 200ms);
}

TEST_F(SimulatedMediumTest, TheDelayOfADirectionComesOnTop)
{
    SimulatedFaults far;
    far.Delay = 300ms;
    Net.Network().SetFaults("uav1", "ground", far);
    Net.Network().SetMedium("*", {.BytesPerSecond = 10'000});
    Write(*FromUav1, 1000);
    Net.Pass(1s);
    EXPECT_THAT(Heard, ElementsAre("uav1 400"));
    EXPECT_THAT(HeardThere, ElementsAre("uav1 100"));
}

TEST_F(SimulatedMediumTest, TheOverheadOfEachDatagramTakesTimeToo)
{
    Net.Network().SetMedium("*", {.BytesPerSecond = 10'000, .Overhead = 500});
    Write(*FromUav1, 1000, 2);
    Net.Pass(1s);
    EXPECT_THAT(Heard, ElementsAre("uav1 150", "uav1 300"));
    EXPECT_EQ(Net.Network().Air("*").CarriedBytes, 3000u);
}

TEST_F(SimulatedMediumTest, WhatDoesNotFitIntoTheQueueIsDropped)
{
    Net.Network().SetMedium("*", {.BytesPerSecond = 10'000, .QueueBytes = 2500});
    Write(*FromUav1, 1000, 5);  // one is on the air, two wait
    Write(*FromUav1, 500);
    Net.Pass(10s);
    EXPECT_THAT(Heard, ElementsAre("uav1 100", "uav1 200", "uav1 300", "uav1 350"));
    EXPECT_EQ(Net.Network().Air("*").Dropped, 2u);
    EXPECT_EQ(Net.Network().Air("*").DroppedBytes, 2000u);
    EXPECT_EQ(Ground->Counters().SamplesLost, 2u);
}

TEST_F(SimulatedMediumTest, AQueueHasRoomAgainWhenItsFirstHasBegun)
{
    Net.Network().SetMedium("*", {.BytesPerSecond = 10'000, .QueueBytes = 1000});
    Write(*FromUav1, 1000, 2);
    Net.Pass(100ms);
    Write(*FromUav1, 1000);
    Net.Pass(1s);
    EXPECT_THAT(Heard, ElementsAre("uav1 100", "uav1 200", "uav1 300"));
}

TEST_F(SimulatedMediumTest, NodesThatHaveSomethingTakeTurns)
{
    Net.Network().SetMedium("*", {.BytesPerSecond = 10'000});
    Write(*FromUav1, 1000, 4);
    Write(*FromUav2, 1000, 2);
    Net.Pass(1s);
    EXPECT_THAT(Heard, ElementsAre("uav1 100", "uav2 200", "uav1 300", "uav2 400", "uav1 500", "uav1 600"));
}

TEST_F(SimulatedMediumTest, AFullQueueDropsNothingOfTheOthers)
{
    Net.Network().SetMedium("*", {.BytesPerSecond = 10'000, .QueueBytes = 1000});
    Write(*FromUav1, 1000, 10);
    Write(*FromUav2, 1000);
    Net.Pass(1s);
    EXPECT_THAT(Heard, ElementsAre("uav1 100", "uav2 200", "uav1 300"));
}

TEST_F(SimulatedMediumTest, WhatGoesByMulticastTakesTheAirOnce)
{
    Net.Network().SetMedium("*", {.BytesPerSecond = 10'000});
    const std::uint64_t before = Net.Network().Sent("uav1").Bytes;
    Write(*FromUav1, 1000, 2);
    Net.Pass(1s);
    EXPECT_THAT(Heard, ElementsAre("uav1 100", "uav1 200"));
    EXPECT_EQ(HeardThere, Heard);
    EXPECT_EQ(Net.Network().Air("*").CarriedBytes, 2000u);
    EXPECT_EQ(Net.Network().Sent("uav1").Bytes - before, 2000u);
}

TEST_F(SimulatedUnicastMediumTest, WhatGoesByUnicastTakesTheAirOnceForEachReceiver)
{
    Net.Network().SetMedium("*", {.BytesPerSecond = 10'000});
    const std::uint64_t before = Net.Network().Sent("uav1").Bytes;
    Write(*FromUav1, 1000, 2);
    Net.Pass(1s);
    EXPECT_THAT(Heard, ElementsAre("uav1 100", "uav1 300"));
    EXPECT_THAT(HeardThere, ElementsAre("uav1 200", "uav1 400"));
    EXPECT_EQ(Net.Network().Air("*").CarriedBytes, 4000u);
    EXPECT_EQ(Net.Network().Sent("uav1").Bytes - before, 4000u);
}

TEST_F(SimulatedUnicastMediumTest, AReceiverWhoseDatagramIsDroppedMissesItAlone)
{
    Net.Network().SetMedium("*", {.BytesPerSecond = 10'000, .QueueBytes = 1000});
    Write(*FromUav1, 1000, 2);
    Net.Pass(1s);
    EXPECT_THAT(Heard, SizeIs(1));
    EXPECT_THAT(HeardThere, SizeIs(1));
}

TEST_F(SimulatedMediumTest, TwoReadersOfOneSessionShareTheDatagram)
{
    std::vector<std::string> more;
    const auto second = Ground->CreateReader(TextTopic(), Telemetry(), {}, Log(more));
    ASSERT_TRUE(Net.Until([&] { return FromUav1->MatchedReaders() == 3 && second->MatchedWriters() == 2; }));
    Net.Pass(20s);
    Start = Net.Network().Now();
    Net.Network().SetMedium("*", {.BytesPerSecond = 10'000});
    Write(*FromUav1, 1000);
    Net.Pass(1s);
    EXPECT_THAT(Heard, ElementsAre("uav1 100"));
    EXPECT_EQ(more, Heard);
    EXPECT_EQ(Net.Network().Air("*").CarriedBytes, 1000u);
}

TEST_F(SimulatedMediumTest, WhatIsWrittenToOneNodeTakesTheAirOnceAndReachesItAlone)
{
    Net.Network().SetMedium("*", {.BytesPerSecond = 10'000});
    ASSERT_EQ(FromUav1->WriteTo("tower", SampleOnAir(1000), 1), WriteResult::Ok);
    Net.Pass(1s);
    EXPECT_THAT(Heard, SizeIs(0));
    EXPECT_THAT(HeardThere, ElementsAre("uav1 100"));
    EXPECT_EQ(Net.Network().Air("*").CarriedBytes, 1000u);
}

TEST_F(SimulatedMediumTest, ALostDatagramHasTakenTheAir)
{
    SimulatedFaults cut;
    cut.Cut = true;
    Net.Network().SetFaults("uav1", "*", cut);
    Net.Network().SetMedium("*", {.BytesPerSecond = 10'000});
    Write(*FromUav1, 1000);
    Write(*FromUav2, 1000);
    Net.Pass(1s);
    EXPECT_THAT(Heard, ElementsAre("uav2 200"));
}

TEST_F(SimulatedMediumTest, ANewRateHoldsForWhatWaitsAndNotForWhatHasBegun)
{
    Net.Network().SetMedium("*", {.BytesPerSecond = 10'000});
    Write(*FromUav1, 1000, 4);
    Net.Pass(50ms);
    Net.Network().SetMedium("*", {.BytesPerSecond = 2'000});
    Net.Pass(150ms);
    Net.Network().SetMedium("*", {.BytesPerSecond = 10'000});
    Net.Pass(2s);
    EXPECT_THAT(Heard, ElementsAre("uav1 100", "uav1 600", "uav1 700", "uav1 800"));
}

TEST_F(SimulatedMediumTest, AMediumThatBecomesUnlimitedLetsEverythingGoInOrder)
{
    Net.Network().SetMedium("*", {.BytesPerSecond = 10'000});
    Write(*FromUav1, 1000, 3);
    Net.Network().SetMedium("*", {});
    Write(*FromUav1, 500);  // does not overtake
    Net.Pass(1s);
    Write(*FromUav1, 500);
    Net.Pass(0s);
    EXPECT_THAT(Heard, ElementsAre("uav1 100", "uav1 100", "uav1 100", "uav1 100", "uav1 1000"));
    EXPECT_EQ(FromUav1->MatchedReaders(), 2);
}

TEST_F(SimulatedMediumTest, ASmallerQueueDropsWhatComesAndKeepsWhatItHas)
{
    Net.Network().SetMedium("*", {.BytesPerSecond = 10'000});
    Write(*FromUav1, 1000, 3);
    Net.Network().SetMedium("*", {.BytesPerSecond = 10'000, .QueueBytes = 100});
    Write(*FromUav1, 1000);
    Net.Pass(1s);
    EXPECT_THAT(Heard, ElementsAre("uav1 100", "uav1 200", "uav1 300"));
}

TEST_F(SimulatedMediumTest, NodesOfTwoMediaDoNotWaitForEachOther)
{
    Net.Network().SetMedium("*", {.BytesPerSecond = 10'000});
    Net.Network().SetMedium("uav2", {.BytesPerSecond = 20'000});
    Write(*FromUav1, 1000);
    Write(*FromUav2, 1000);
    Net.Pass(1s);
    EXPECT_THAT(Heard, ElementsAre("uav2 50", "uav1 100"));
    EXPECT_EQ(Net.Network().Air("uav2").CarriedBytes, 1000u);
}

TEST_F(SimulatedMediumTest, WhatWaitsIsSentThoughItsNodeIsDead)
{
    Net.Network().SetMedium("*", {.BytesPerSecond = 10'000});
    Write(*FromUav1, 1000, 2);
    Net.Network().CrashNode("uav1");
    Net.Pass(1s);
    EXPECT_THAT(Heard, ElementsAre("uav1 100", "uav1 200"));
}

TEST_F(SimulatedMediumTest, NobodyHearsWhatPassesAfterHisEnd)
{
    Net.Network().SetMedium("*", {.BytesPerSecond = 10'000});
    Write(*FromUav1, 1000);
    Net.Network().CrashNode("tower");
    Net.Pass(1s);
    EXPECT_THAT(Heard, ElementsAre("uav1 100"));
    EXPECT_THAT(HeardThere, SizeIs(0));
}

TEST_F(SimulatedMediumTest, OthersTakeTheirTurnsBetweenThePartsOfALargeSample)
{
    Net.Network().SetMedium("*", {.BytesPerSecond = 10'000});
    const std::size_t parts = 3;
    ASSERT_EQ(FromUav1->Write(RawSample{std::vector<std::uint8_t>(parts * 1400 - 4)}, 1), WriteResult::Ok);
    Write(*FromUav2, 1000, 2);
    Net.Pass(1s);
    // A part is 1484 bytes on the air.
    EXPECT_THAT(Heard, ElementsAre("uav2 248", "uav2 496", "uav1 645"));
    EXPECT_EQ(Net.Network().Air("*").Carried, parts + 2);
}

TEST_F(SimulatedMediumTest, ALargeSampleOfWhichAPartIsDroppedIsLost)
{
    Net.Network().SetMedium("*", {.BytesPerSecond = 10'000, .QueueBytes = 2 * 1484});
    ASSERT_EQ(FromUav1->Write(RawSample{std::vector<std::uint8_t>(4 * 1400 - 4)}, 1), WriteResult::Ok);
    Net.Pass(1s);
    EXPECT_THAT(Heard, SizeIs(0));
    EXPECT_EQ(Net.Network().Air("*").Carried, 3u);
    EXPECT_EQ(Net.Network().Air("*").Dropped, 1u);
}

TEST_F(SimulatedMediumTest, OfALargeReliableSampleOnlyTheDroppedPartsAreSentAgain)
{
    const auto writer = Uav1->CreateWriter(TextTopic(), Stream(10), {"Large"});
    const auto reader = Ground->CreateReader(TextTopic(), Stream(10), {"Large"}, Log(Heard));
    ASSERT_TRUE(Net.Until([&] { return writer->MatchedReaders() == 1 && reader->MatchedWriters() == 1; }));
    Net.Pass(20s);
    Net.Network().SetMedium("*", {.BytesPerSecond = 1'000'000, .QueueBytes = 4 * 1484});
    ASSERT_EQ(writer->Write(RawSample{std::vector<std::uint8_t>(8 * 1400 - 4)}, 1), WriteResult::Ok);
    Net.Pass(10ms);
    EXPECT_THAT(Heard, SizeIs(0));
    EXPECT_EQ(Net.Network().Air("*").Carried, 5u);
    Net.Pass(1s);
    EXPECT_THAT(Heard, SizeIs(1));
    const std::uint64_t parts = (Net.Network().Air("*").CarriedBytes) / 1484;
    EXPECT_EQ(parts, 8u);
}

TEST(SimulatedMedium, ANewEndpointIsToldToAllAtOnceAndNotTheOthersOnceMore)
{
    SimulatedHarness net;
    std::vector<std::unique_ptr<TransportSession>> sessions;
    for (const char *node : {"a", "b", "c", "d"})
    {
        sessions.push_back(net.Backend().Open(net.SettingsFor(node, 1), {}));
    }
    std::vector<std::unique_ptr<TransportWriter>> writers;
    net.Pass(10s);
    std::uint64_t cost = 0;
    for (int i = 0; i < 10; ++i)
    {
        const std::uint64_t before = net.Network().Sent("a").DiscoveryBytes;
        writers.push_back(sessions[0]->CreateWriter({Numbered("Topic", i), "Type", {}}, Telemetry(), {}));
        cost = net.Network().Sent("a").DiscoveryBytes - before;
        net.Pass(1s);
    }
    EXPECT_LT(cost, 400u);
}

TEST(SimulatedMedium, ALostEndpointIsAskedForAndToldAgain)
{
    SimulatedHarness net;
    const auto a = net.Backend().Open(net.SettingsFor("a", 1), {});
    const auto b = net.Backend().Open(net.SettingsFor("b", 1), {});
    net.Pass(10s);
    SimulatedFaults cut;
    cut.Cut = true;
    net.Network().SetFaults("a", "b", cut);
    const auto writer = a->CreateWriter(TextTopic(), Telemetry(), {});
    const auto reader = b->CreateReader(TextTopic(), Telemetry(), {}, {});
    net.Pass(90ms);
    net.Network().ClearFaults();
    const std::uint64_t before = net.Network().Sent("a").DiscoveryBytes;
    EXPECT_EQ(reader->MatchedWriters(), 0);
    EXPECT_TRUE(net.Until([&] { return reader->MatchedWriters() == 1; }));
    EXPECT_LT(net.Network().Sent("a").DiscoveryBytes - before, 1000u);
}

TEST(SimulatedMedium, NodesFindEachOtherOverAThinOne)
{
    SimulatedHarness net;
    net.Network().SetMedium("*", {.BytesPerSecond = 7'200});
    std::vector<std::unique_ptr<TransportSession>> sessions;
    std::vector<std::unique_ptr<TransportWriter>> writers;
    std::vector<std::unique_ptr<TransportReader>> readers;
    for (int i = 0; i < 3; ++i)
    {
        sessions.push_back(net.Backend().Open(net.SettingsFor(Numbered("uav", i), 1), {}));
        writers.push_back(sessions.back()->CreateWriter(TextTopic(), Telemetry(), {}));
        readers.push_back(sessions.back()->CreateReader(TextTopic(), Telemetry(), {}, {}));
    }
    const auto isMatched = [](const auto &writer) { return writer->MatchedReaders() == 2; };
    EXPECT_TRUE(net.Until([&] { return std::all_of(writers.begin(), writers.end(), isMatched); }));
}

// Runs a small fleet over a medium that is too thin for it. Returns all deliveries with their times.
std::string TraceOf(std::uint64_t seed, std::chrono::nanoseconds step)
{
    std::ostringstream trace;
    SimulatedHarness net(seed);
    SimulatedFaults bad;
    bad.Loss = 0.1;
    bad.Jitter = 40ms;
    net.Network().SetFaults("*", "*", bad);
    net.Network().SetMedium("*", {.BytesPerSecond = 30'000, .QueueBytes = 4000});
    std::vector<std::unique_ptr<TransportSession>> sessions;
    std::vector<std::unique_ptr<TransportWriter>> writers;
    std::vector<std::unique_ptr<TransportReader>> readers;
    for (const char *node : {"a", "b", "c"})
    {
        sessions.push_back(net.Backend().Open(net.SettingsFor(node, 1), {}));
        writers.push_back(sessions.back()->CreateWriter(TextTopic(), Stream(50), {}));
        readers.push_back(
            sessions.back()->CreateReader(TextTopic(), Stream(50), {},
                                          [&trace, &net, node](SampleBytes bytes, const SampleInfo &info)
                                          {
                                              trace << net.Network().Now().count() << " " << node << " "
                                                    << info.Node << " " << TextOf(bytes) << "\n";
                                          }));
    }
    for (int i = 0; i < 100; ++i)
    {
        writers[static_cast<std::size_t>(i) % 3]->Write(MakeSample(0, std::to_string(i)), i);
        const auto end = net.Network().Now() + 50ms;
        while (net.Network().Now() < end)
        {
            net.Network().AdvanceTo(std::min(end, net.Network().Now() + step));
        }
        if (i == 50)
        {
            net.Network().SetMedium("*", {.BytesPerSecond = 10'000, .QueueBytes = 4000});
        }
    }
    return trace.str();
}

TEST(SimulatedMedium, OneSeedGivesOneTrace)
{
    EXPECT_EQ(TraceOf(7, 50ms), TraceOf(7, 50ms));
    EXPECT_NE(TraceOf(7, 50ms), TraceOf(8, 50ms));
    EXPECT_NE(TraceOf(7, 50ms), "");
}

TEST(SimulatedMedium, TheSizeOfTheStepsDoesNotMatter)
{
    EXPECT_EQ(TraceOf(7, 50ms), TraceOf(7, 1ms));
}

}  // namespace

}  // namespace Rabit::Conformance
