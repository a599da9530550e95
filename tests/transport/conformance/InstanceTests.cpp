// The life of an instance of a keyed topic: it is disposed, its memory is freed, and it comes back.
#include <algorithm>
#include <atomic>
#include <cmath>
#include <set>

#include "ConformanceTest.h"
#include "ProcessMemory.h"

namespace Rabit::Conformance
{

using testing::ElementsAre;
using testing::IsEmpty;

namespace
{

// Keys that no test writes itself.
constexpr std::uint32_t Marker = 1'000'000;
constexpr std::uint32_t Fence = 1'000'001;

// Returns the texts of the samples with this key.
std::vector<std::string> TextsOf(std::uint32_t key, const std::vector<Received> &all)
{
    std::vector<std::string> texts;
    for (const auto &received : all)
    {
        if (received.Key == HashOf(key))
        {
            texts.push_back(received.Text);
        }
    }
    return texts;
}

// Returns the keys of the samples, without the marker.
std::set<KeyHash> KeysOf(const std::vector<Received> &all)
{
    std::set<KeyHash> keys;
    for (const auto &received : all)
    {
        keys.insert(received.Key);
    }
    keys.erase(HashOf(Marker));
    return keys;
}

}  // namespace

std::vector<Received> Conformance::HeardByALateReader(TransportSession &late, TransportWriter &writer)
{
    static int last = 0;
    SampleRecorder recorder;
    const auto reader = late.CreateReader(KeyedTopic(), State(), {}, recorder.Handler());
    const std::string marker = std::to_string(++last);
    EXPECT_EQ(WriteOnceTaken(writer, MakeSample(Marker, marker), 1), WriteResult::Ok);
    EXPECT_TRUE(Until([&] { return recorder.Count() > 0 && recorder.All().back().Text == marker; }));
    return recorder.All();
}

// Late readers tell of acknowledgements: they hear nothing of a disposed instance once all readers have
// acknowledged the disposal. Acknowledging the disposal of the fence acknowledges all that was written
// before.
bool Conformance::AllAcknowledged(TransportSession &late, TransportWriter &writer)
{
    EXPECT_EQ(WriteOnceTaken(writer, MakeSample(Fence, "fence"), 1), WriteResult::Ok);
    EXPECT_EQ(DisposeOnceTaken(writer, MakeSample(Fence, "fence"), 1), WriteResult::Ok);
    return Until([&] { return !KeysOf(HeardByALateReader(late, writer)).contains(HashOf(Fence)); });
}

TEST_P(Conformance, ADisposedInstanceIsTold)
{
    const auto writing = Open("uav1", 5);
    const auto reading = Open("ground");
    SampleRecorder recorder;
    const auto reader = reading->CreateReader(KeyedTopic(), State(), {}, recorder.Handler());
    const auto writer = writing->CreateWriter(KeyedTopic(), State(), {});
    ASSERT_TRUE(Matched(writer, reader));
    ASSERT_EQ(WriteOnceTaken(*writer, MakeSample(7, "target"), 1000), WriteResult::Ok);
    ASSERT_TRUE(Until([&] { return recorder.Count() == 1; }));
    ASSERT_EQ(DisposeOnceTaken(*writer, MakeSample(7, "whatever"), 2000), WriteResult::Ok);
    ASSERT_TRUE(Until([&] { return recorder.Count() == 2; }));
    const auto disposed = recorder.All()[1];
    EXPECT_FALSE(disposed.Alive);
    EXPECT_THAT(disposed.Bytes, IsEmpty());
    EXPECT_EQ(disposed.Key, HashOf(7));
    EXPECT_EQ(disposed.Node, "uav1");
    EXPECT_EQ(disposed.Incarnation, 5u);
    EXPECT_LT(std::abs(disposed.SourceTime - 2000), 1000);
    EXPECT_TRUE(recorder.All()[0].Alive);
    EXPECT_EQ(recorder.All()[0].Key, HashOf(7));
}

TEST_P(Conformance, InstancesEndWithTheirLastWriter)
{
    const auto first = Open("uav1");
    const auto second = Open("uav2", 3);
    const auto reading = Open("ground");
    SampleRecorder recorder;
    const auto reader = reading->CreateReader(KeyedTopic(), State(), {}, recorder.Handler());
    auto firstWriter = first->CreateWriter(KeyedTopic(), State(), {});
    auto secondWriter = second->CreateWriter(KeyedTopic(), State(), {});
    ASSERT_TRUE(Until([&] { return reader->MatchedWriters() == 2; }));
    ASSERT_EQ(WriteOnceTaken(*firstWriter, MakeSample(7, "from uav1"), 1), WriteResult::Ok);
    ASSERT_EQ(WriteOnceTaken(*secondWriter, MakeSample(7, "from uav2"), 1), WriteResult::Ok);
    ASSERT_TRUE(Until([&] { return recorder.Count() == 2; }));
    firstWriter.reset();
    ASSERT_TRUE(Until([&] { return reader->MatchedWriters() == 1; }));
    EXPECT_EQ(recorder.Count(), 2u);
    secondWriter.reset();
    ASSERT_TRUE(Until([&] { return recorder.Count() == 3; }));
    const auto end = recorder.All()[2];
    EXPECT_FALSE(end.Alive);
    EXPECT_EQ(end.Key, HashOf(7));
    EXPECT_EQ(end.Node, "uav2");
    EXPECT_EQ(end.Incarnation, 3u);
    EXPECT_THAT(end.Bytes, IsEmpty());
}

// Each end is a datagram with a stamp of its own. Of 640, one has each value of a certain byte in 92 of 100
// runs.
TEST_P(Conformance, TheEndOfEachOfManyWritersIsHeard)
{
    constexpr int Rounds = 40;
    constexpr std::size_t Together = 16;
    const auto writing = Open("uav1");
    const auto reading = Open("ground");
    const auto reader = reading->CreateReader(TextTopic(), Telemetry(), {}, [](auto &&...) {});
    for (int round = 0; round < Rounds; ++round)
    {
        std::vector<WriterPtr> writers;
        while (writers.size() < Together)
        {
            writers.push_back(writing->CreateWriter(TextTopic(), Telemetry(), {}));
        }
        ASSERT_TRUE(Until([&] { return reader->MatchedWriters() == static_cast<int>(Together); })) << round;
        writers.clear();
        ASSERT_TRUE(Until([&] { return reader->MatchedWriters() == 0; })) << round;
    }
}

TEST_P(Conformance, WhatWasDisposedBeforeItCameALateReaderHearsNothingOf)
{
    const auto writing = Open("uav1");
    const auto reading = Open("ground");
    const auto writer = writing->CreateWriter(KeyedTopic(), State(3), {});
    ASSERT_EQ(WriteOnceTaken(*writer, MakeSample(7, "gone"), 1), WriteResult::Ok);
    ASSERT_EQ(WriteOnceTaken(*writer, MakeSample(7, "gone too"), 1), WriteResult::Ok);
    ASSERT_EQ(DisposeOnceTaken(*writer, MakeSample(7, ""), 1), WriteResult::Ok);
    ASSERT_EQ(WriteOnceTaken(*writer, MakeSample(8, "here"), 1), WriteResult::Ok);
    SampleRecorder recorder;
    const auto reader = reading->CreateReader(KeyedTopic(), State(), {}, recorder.Handler());
    ASSERT_TRUE(Until([&] { return recorder.Count() >= 1 && recorder.All().back().Key == HashOf(8); }));
    EXPECT_THAT(recorder.Texts(), ElementsAre("here"));
}

TEST_P(Conformance, ADisposedInstanceLeavesNothingForALateReader)
{
    const auto writing = Open("uav1");
    const auto reading = Open("ground");
    const auto late = Open("late");
    SampleRecorder early;
    const auto earlyReader = reading->CreateReader(KeyedTopic(), State(3), {}, early.Handler());
    const auto writer = writing->CreateWriter(KeyedTopic(), State(3), {});
    ASSERT_TRUE(Matched(writer, earlyReader));
    ASSERT_EQ(WriteOnceTaken(*writer, MakeSample(7, "gone"), 1), WriteResult::Ok);
    ASSERT_EQ(WriteOnceTaken(*writer, MakeSample(8, "here"), 1), WriteResult::Ok);
    ASSERT_EQ(WriteOnceTaken(*writer, MakeSample(7, "gone too"), 1), WriteResult::Ok);
    ASSERT_EQ(DisposeOnceTaken(*writer, MakeSample(7, ""), 1), WriteResult::Ok);
    ASSERT_TRUE(AllAcknowledged(*late, *writer));
    EXPECT_THAT(KeysOf(HeardByALateReader(*late, *writer)), ElementsAre(HashOf(8)));
}

TEST_P(Conformance, AReaderThatWasThereGetsWhatWasWrittenBeforeADisposalAndAfterIt)
{
    constexpr int Rounds = 50;
    const auto writing = Open("uav1");
    const auto reading = Open("ground");
    SampleRecorder recorder;
    const auto reader = reading->CreateReader(KeyedTopic(), State(4 * Rounds), {}, recorder.Handler());
    const auto writer = writing->CreateWriter(KeyedTopic(), State(4 * Rounds), {});
    ASSERT_TRUE(Matched(writer, reader));
    for (int i = 0; i < Rounds; ++i)
    {
        ASSERT_EQ(WriteOnceTaken(*writer, MakeSample(7, std::to_string(i)), 1), WriteResult::Ok);
        ASSERT_EQ(DisposeOnceTaken(*writer, MakeSample(7, ""), 1), WriteResult::Ok);
    }
    ASSERT_TRUE(Until([&] { return recorder.Count() >= 2 * Rounds; }));
    const auto all = recorder.All();
    for (std::size_t i = 0; i < all.size(); ++i)
    {
        EXPECT_EQ(all[i].Alive, i % 2 == 0) << i;
        EXPECT_EQ(all[i].Text, i % 2 == 0 ? std::to_string(i / 2) : "") << i;
    }
}

TEST_P(Conformance, AnInstanceWrittenAfterItsDisposalReachesALateReader)
{
    const auto writing = Open("uav1");
    const auto reading = Open("ground");
    const auto late = Open("late");
    SampleRecorder early;
    const auto earlyReader = reading->CreateReader(KeyedTopic(), State(2), {}, early.Handler());
    const auto writer = writing->CreateWriter(KeyedTopic(), State(2), {});
    ASSERT_TRUE(Matched(writer, earlyReader));
    ASSERT_EQ(WriteOnceTaken(*writer, MakeSample(7, "before"), 1), WriteResult::Ok);
    ASSERT_EQ(DisposeOnceTaken(*writer, MakeSample(7, ""), 1), WriteResult::Ok);
    ASSERT_EQ(WriteOnceTaken(*writer, MakeSample(7, "again"), 1), WriteResult::Ok);
    ASSERT_TRUE(AllAcknowledged(*late, *writer));
    ASSERT_EQ(WriteOnceTaken(*writer, MakeSample(7, "and again"), 1), WriteResult::Ok);
    EXPECT_THAT(TextsOf(7, HeardByALateReader(*late, *writer)), ElementsAre("again", "and again"));
}

TEST_P(Conformance, ManyKeysTakeNoMoreMemoryThanTheirSamples)
{
    constexpr std::uint32_t Count = 2'000;
    constexpr std::size_t MostKept = 30 << 20;
    if (MemoryIsNotGivenBack)
    {
        GTEST_SKIP() << "with a sanitizer, memory is not what it would be";
    }
    const auto writing = Open("uav1");
    const auto reading = Open("ground");
    std::atomic<std::uint32_t> received{0};
    const auto reader = reading->CreateReader(KeyedTopic(), State(), {},
                                              [&](SampleBytes, const SampleInfo &) { ++received; });
    const auto writer = writing->CreateWriter(KeyedTopic(), State(), {});
    ASSERT_TRUE(Matched(writer, reader));
    const std::size_t before = HeapInUse();
    for (std::uint32_t key = 0; key < Count; ++key)
    {
        ASSERT_EQ(WriteOnceTaken(*writer, MakeSample(key, "x"), 1), WriteResult::Ok);
    }
    ASSERT_TRUE(Until([&] { return received == Count; }));
    EXPECT_LT(HeapInUse(), before + MostKept);
}

// As a publisher does whose value has another key each time.
TEST_P(Conformance, ManyKeysWrittenAndDisposedLeaveOne)
{
    constexpr std::uint32_t KeysInARound = 5'000;
    constexpr std::uint32_t Together = 100;
    constexpr std::uint32_t Rounds = 10;
    // Cyclone DDS's table keeps 200 bytes of each instance; with the samples it would be 30 MB.
    constexpr std::size_t MostKept = 15 << 20;
    const auto writing = Open("uav1");
    const auto reading = Open("ground");
    const auto late = Open("late");
    const std::string text(100, 'x');
    std::atomic<std::uint32_t> received{0};
    const auto earlyReader =
        reading->CreateReader(KeyedTopic(), State(), {},
                              [&](SampleBytes, const SampleInfo &info)
                              {
                                  const bool isOwn = info.Key != HashOf(Marker) && info.Key != HashOf(Fence);
                                  received += info.Alive && isOwn ? 1 : 0;
                              });
    const auto writer = writing->CreateWriter(KeyedTopic(), State(), {});
    ASSERT_TRUE(Matched(writer, earlyReader));
    std::uint32_t key = 0;
    const auto round = [&]
    {
        for (std::uint32_t i = 0; i < KeysInARound; i += Together)
        {
            for (std::uint32_t j = 1; j <= Together; ++j)
            {
                ASSERT_EQ(WriteOnceTaken(*writer, MakeSample(key + j, text), 1), WriteResult::Ok);
            }
            // The disposal of an instance would push out its sample, which may have to be repeated.
            ASSERT_TRUE(Until([&] { return received == key + Together; }));
            for (std::uint32_t j = 0; j < Together; ++j)
            {
                ASSERT_EQ(DisposeOnceTaken(*writer, MakeSample(key + j, text), 1), WriteResult::Ok);
            }
            key += Together;
        }
        ASSERT_TRUE(AllAcknowledged(*late, *writer));
    };
    round();
    const std::size_t before = HeapInUse();
    for (std::uint32_t i = 0; i < Rounds; ++i)
    {
        round();
    }
    if (!MemoryIsNotGivenBack)
    {
        EXPECT_LT(HeapInUse(), before + MostKept);
    }
    EXPECT_THAT(KeysOf(HeardByALateReader(*late, *writer)), ElementsAre(HashOf(key)));
}

}  // namespace Rabit::Conformance
