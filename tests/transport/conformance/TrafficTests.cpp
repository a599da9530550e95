// What writing costs on the air, and that it is counted.
#include "ConformanceTest.h"

namespace Rabit::Conformance
{

namespace
{

constexpr std::uint64_t Samples = 50;
constexpr std::size_t Body = 1000;
// IPv4, UDP, RTPS header, INFO_TS, DATA, encapsulation.
constexpr std::uint64_t Least = 20 + 8 + 20 + 12 + 24 + 4;
// INFO_DST, and what a vendor may say beside a sample.
constexpr std::uint64_t Most = Least + 16 + 40;

}  // namespace

Conformance::SessionPtr Conformance::OpenWith(const std::string &node, bool multicast)
{
    TransportSettings settings = Net().SettingsFor(node, 1);
    settings.Multicast = multicast;
    if (!multicast)
    {
        settings.Peers = {"127.0.0.1"};
    }
    return Net().Backend().Open(settings, {});
}

void Conformance::ExpectCostOfWriting(bool multicast, int destinations)
{
    const auto writing = OpenWith("uav1", multicast);
    const auto first = OpenWith("ground", multicast);
    const auto second = OpenWith("uav2", multicast);
    const auto writer = writing->CreateWriter(TextTopic(), Telemetry(), {});
    EXPECT_EQ(writer->Destinations(), 0);
    SampleRecorder here;
    SampleRecorder there;
    const auto reader = first->CreateReader(TextTopic(), Telemetry(), {}, here.Handler());
    const auto other = second->CreateReader(TextTopic(), Telemetry(), {}, there.Handler());
    ASSERT_TRUE(Until([&] { return writer->MatchedReaders() == 2; }));
    EXPECT_EQ(writer->Destinations(), destinations);
    const TransportCounters before = writing->Counters();
    EXPECT_GT(before.DiscoveryDatagrams, 0u);
    EXPECT_GT(before.DiscoveryBytes, 28 * before.DiscoveryDatagrams);
    const RawSample sample{std::vector<std::uint8_t>(Body)};
    for (std::uint64_t i = 0; i < Samples; ++i)
    {
        ASSERT_EQ(WriteOnceTaken(*writer, sample, 1), WriteResult::Ok);
    }
    const TransportCounters after = writing->Counters();
    const std::uint64_t datagrams = after.SampleDatagrams - before.SampleDatagrams;
    const std::uint64_t bytes = after.SampleBytes - before.SampleBytes;
    EXPECT_EQ(datagrams, Samples * static_cast<std::uint64_t>(destinations));
    EXPECT_GE(bytes, datagrams * (Body + Least));
    EXPECT_LE(bytes, datagrams * (Body + Most));
}

TEST_P(Conformance, WhatGoesToEachReaderByItselfCostsThatOftenAndIsCounted)
{
    ExpectCostOfWriting(false, 2);
}

TEST_P(Conformance, WhatGoesToAllByMulticastCostsOnceAndIsCounted)
{
    ExpectCostOfWriting(true, 1);
}

void Conformance::ExpectThatOneNodeCanBeWrittenTo(bool multicast)
{
    const auto writing = OpenWith("uav1", multicast);
    const auto first = OpenWith("ground", multicast);
    const auto second = OpenWith("uav2", multicast);
    const auto writer = writing->CreateWriter(TextTopic(), Telemetry(), {});
    SampleRecorder here;
    SampleRecorder there;
    const auto reader = first->CreateReader(TextTopic(), Telemetry(), {}, here.Handler());
    const auto other = second->CreateReader(TextTopic(), Telemetry(), {}, there.Handler());
    ASSERT_TRUE(Until(
        [&] {
            return writer->MatchedReaders() == 2 && reader->MatchedWriters() == 1 &&
                   other->MatchedWriters() == 1;
        }));
    const std::uint64_t before = writing->Counters().SampleDatagrams;
    ASSERT_EQ(writer->WriteTo("nobody", MakeSample(0, "nobody"), 1), WriteResult::Ok);
    EXPECT_EQ(writing->Counters().SampleDatagrams, before);
    std::uint64_t written = 0;  // some may be lost
    EXPECT_TRUE(Until(
        [&]
        {
            written += writer->WriteTo("uav2", MakeSample(0, "one"), 1) == WriteResult::Ok ? 1 : 0;
            return there.Count() >= 3;
        }));
    EXPECT_EQ(writing->Counters().SampleDatagrams, before + written);
    EXPECT_TRUE(Until(
        [&]
        {
            EXPECT_EQ(WriteOnceTaken(*writer, MakeSample(0, "all"), 1), WriteResult::Ok);
            return here.Count() >= 3;
        }));
    EXPECT_THAT(here.Texts(), testing::Each("all"));
    EXPECT_THAT(there.Texts(), testing::AllOf(testing::Contains("one"), testing::Contains("all")));
}

TEST_P(Conformance, OneNodeCanBeWrittenToWhereEachReaderGetsItsOwn)
{
    ExpectThatOneNodeCanBeWrittenTo(false);
}

TEST_P(Conformance, OneNodeCanBeWrittenToWhereAllGetThemByMulticast)
{
    ExpectThatOneNodeCanBeWrittenTo(true);
}

TEST_P(Conformance, AReliableOrKeyedWriterDoesNotWriteToOneNode)
{
    const auto session = Open("uav1");
    const auto reliable = session->CreateWriter(TextTopic(), State(), {});
    const auto keyed = session->CreateWriter(KeyedTopic(), Telemetry(), {});
    EXPECT_EQ(reliable->WriteTo("ground", MakeSample(0, "x"), 1), WriteResult::Failed);
    EXPECT_EQ(keyed->WriteTo("ground", MakeSample(0, "x"), 1), WriteResult::Failed);
}

}  // namespace Rabit::Conformance
