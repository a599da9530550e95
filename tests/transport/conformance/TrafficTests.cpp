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

void Conformance::ExpectCostOfWriting(bool multicast, int destinations)
{
    const auto open = [&](const std::string &node)
    {
        TransportSettings settings = Net().SettingsFor(node, 1);
        settings.Multicast = multicast;
        if (!multicast)
        {
            settings.Peers = {"127.0.0.1"};
        }
        return Net().Backend().Open(settings, {});
    };
    const auto writing = open("uav1");
    const auto first = open("ground");
    const auto second = open("uav2");
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

}  // namespace Rabit::Conformance
