// Which samples arrive, in which order, and with which information.
#include <algorithm>
#include <atomic>
#include <cmath>
#include <thread>

#include "ConformanceTest.h"
#include "ProcessMemory.h"

namespace Rabit::Conformance
{

using testing::ElementsAre;
using testing::ElementsAreArray;

TEST_P(Conformance, ALateReaderGetsTheLastState)
{
    const auto writing = Open("uav1");
    const auto reading = Open("ground");
    const auto writer = writing->CreateWriter(TextTopic(), State(), {});
    for (const char *text : {"idle", "armed", "flying"})
    {
        ASSERT_EQ(WriteOnceTaken(*writer, MakeSample(0, text), 1'700'000'000'000'000'000), WriteResult::Ok);
    }
    SampleRecorder recorder;
    const auto reader = reading->CreateReader(TextTopic(), State(), {}, recorder.Handler());
    ASSERT_TRUE(Until([&] { return recorder.Count() >= 1; }));
    ASSERT_EQ(WriteOnceTaken(*writer, MakeSample(0, "landed"), 2000), WriteResult::Ok);
    ASSERT_TRUE(Until([&] { return recorder.Count() >= 2; }));
    EXPECT_THAT(recorder.Texts(), ElementsAre("flying", "landed"));
    EXPECT_LT(std::abs(recorder.All()[0].SourceTime - 1'700'000'000'000'000'000), 1000);
    EXPECT_EQ(recorder.All()[0].Sequence + 1, recorder.All()[1].Sequence);
}

TEST_P(Conformance, ALateReaderGetsTheHistoryInOrder)
{
    const auto writing = Open("uav1");
    const auto reading = Open("ground");
    const auto writer = writing->CreateWriter(TextTopic(), State(3), {});
    for (const char *text : {"1", "2", "3", "4", "5"})
    {
        ASSERT_EQ(WriteOnceTaken(*writer, MakeSample(0, text), 1), WriteResult::Ok);
    }
    SampleRecorder recorder;
    const auto reader = reading->CreateReader(TextTopic(), State(3), {}, recorder.Handler());
    ASSERT_TRUE(Until([&] { return recorder.Count() >= 3; }));
    EXPECT_THAT(recorder.Texts(), ElementsAre("3", "4", "5"));
}

TEST_P(Conformance, ALateVolatileReaderGetsOnlyWhatIsNew)
{
    const auto writing = Open("uav1");
    const auto reading = Open("ground");
    const auto writer = writing->CreateWriter(TextTopic(), State(10), {});
    ASSERT_EQ(WriteOnceTaken(*writer, MakeSample(0, "old"), 1), WriteResult::Ok);
    SampleRecorder recorder;
    const auto reader = reading->CreateReader(TextTopic(), Stream(10), {}, recorder.Handler());
    ASSERT_TRUE(Matched(writer, reader));
    ASSERT_EQ(WriteOnceTaken(*writer, MakeSample(0, "new"), 1), WriteResult::Ok);
    ASSERT_TRUE(Until([&] { return recorder.Count() >= 1; }));
    EXPECT_THAT(recorder.Texts(), ElementsAre("new"));
}

TEST_P(Conformance, ALateReaderGetsTheLastOfEachKey)
{
    const auto writing = Open("uav1");
    const auto reading = Open("ground");
    const auto writer = writing->CreateWriter(KeyedTopic(), State(), {});
    for (const std::uint32_t key : {1u, 2u, 3u})
    {
        ASSERT_EQ(WriteOnceTaken(*writer, MakeSample(key, "old"), 1), WriteResult::Ok);
    }
    for (const std::uint32_t key : {3u, 1u})
    {
        ASSERT_EQ(WriteOnceTaken(*writer, MakeSample(key, "new"), 1), WriteResult::Ok);
    }
    SampleRecorder recorder;
    const auto reader = reading->CreateReader(KeyedTopic(), State(), {}, recorder.Handler());
    ASSERT_TRUE(Until([&] { return recorder.Count() >= 3; }));
    EXPECT_THAT(recorder.Texts(), ElementsAre("old", "new", "new"));
    EXPECT_EQ(recorder.All()[0].Key, HashOf(2));
    EXPECT_EQ(recorder.All()[1].Key, HashOf(3));
    EXPECT_EQ(recorder.All()[2].Key, HashOf(1));
}

TEST_P(Conformance, ReliableSamplesArriveAllInOrderWithTheirNumbers)
{
    const auto writing = Open("uav1");
    const auto reading = Open("ground");
    SampleRecorder recorder;
    const auto reader = reading->CreateReader(TextTopic(), Stream(1000), {}, recorder.Handler());
    const auto writer = writing->CreateWriter(TextTopic(), Stream(1000), {});
    ASSERT_TRUE(Matched(writer, reader));
    std::vector<std::string> texts;
    for (int i = 0; i < 500; ++i)
    {
        texts.push_back(std::to_string(i));
        ASSERT_EQ(WriteOnceTaken(*writer, MakeSample(0, texts.back()), i), WriteResult::Ok);
    }
    ASSERT_TRUE(Until([&] { return recorder.Count() >= texts.size(); }));
    EXPECT_THAT(recorder.Texts(), ElementsAreArray(texts));
    const auto all = recorder.All();
    for (std::size_t i = 1; i < all.size(); ++i)
    {
        ASSERT_EQ(all[i].Sequence, all[i - 1].Sequence + 1);
    }
    EXPECT_EQ(reading->Counters().SamplesLost, 0u);
}

TEST_P(Conformance, TelemetryArrivesWithRisingNumbers)
{
    const auto writing = Open("uav1");
    const auto reading = Open("ground");
    SampleRecorder recorder;
    const auto reader = reading->CreateReader(TextTopic(), Telemetry(), {}, recorder.Handler());
    const auto writer = writing->CreateWriter(TextTopic(), Telemetry(), {});
    ASSERT_TRUE(Matched(writer, reader));
    ASSERT_TRUE(Until(
        [&]
        {
            EXPECT_EQ(WriteOnceTaken(*writer, MakeSample(0, "fix"), 1), WriteResult::Ok);
            return recorder.Count() >= 20;
        }));
    const auto all = recorder.All();
    for (std::size_t i = 1; i < all.size(); ++i)
    {
        ASSERT_GT(all[i].Sequence, all[i - 1].Sequence);
    }
}

TEST_P(Conformance, BytesArriveAsTheyWereEncodedWhateverTheirNumber)
{
    const auto writing = Open("uav1");
    const auto reading = Open("ground");
    SampleRecorder recorder;
    const auto reader = reading->CreateReader(TextTopic(), Stream(100), {}, recorder.Handler());
    const auto writer = writing->CreateWriter(TextTopic(), Stream(100), {});
    ASSERT_TRUE(Matched(writer, reader));
    std::vector<std::size_t> sizes = {0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 63, 64, 65, 66, 67, 1300, 1301};
    for (std::size_t near = 1360; near < 1400; ++near)  // around the size of a datagram
    {
        sizes.push_back(near);
    }
    const auto bodyOf = [](std::size_t size)
    {
        std::vector<std::uint8_t> body(size);
        for (std::size_t i = 0; i < size; ++i)
        {
            body[i] = static_cast<std::uint8_t>(i * 7 + size);
        }
        return body;
    };
    for (const std::size_t size : sizes)
    {
        ASSERT_EQ(WriteOnceTaken(*writer, RawSample(bodyOf(size)), 1), WriteResult::Ok);
    }
    ASSERT_TRUE(Until([&] { return recorder.Count() >= sizes.size(); }));
    const auto all = recorder.All();
    for (std::size_t i = 0; i < sizes.size(); ++i)
    {
        const auto &bytes = all[i].Bytes;
        ASSERT_EQ(bytes.size(), 4 + sizes[i]);
        EXPECT_EQ(bytes[0], 0);
        EXPECT_EQ(bytes[1], 1);
        EXPECT_EQ(bytes[2], 0);
        EXPECT_EQ(bytes[3] & ~3, 0);  // the number of padding bytes may be noted here
        ASSERT_TRUE(std::equal(bytes.begin() + 4, bytes.end(), bodyOf(sizes[i]).begin())) << sizes[i];
    }
}

TEST_P(Conformance, BorrowedBytesStayAsTheyAreWhileTheHandlerRuns)
{
    const auto writing = Open("uav1");
    const auto reading = Open("ground");
    std::atomic<int> count{0};
    std::atomic<int> changed{0};
    const auto reader = reading->CreateReader(
        TextTopic(), Stream(200), {},
        [&](SampleBytes bytes, const SampleInfo &)
        {
            const std::vector<std::uint8_t> copy(bytes.begin(), bytes.end());
            // The next samples arrive meanwhile.
            for (int i = 0; i < 20; ++i)
            {
                std::this_thread::yield();
            }
            changed += std::equal(bytes.begin(), bytes.end(), copy.begin(), copy.end()) ? 0 : 1;
            ++count;
        });
    const auto writer = writing->CreateWriter(TextTopic(), Stream(200), {});
    ASSERT_TRUE(Matched(writer, reader));
    for (int i = 0; i < 100; ++i)
    {
        ASSERT_EQ(
            WriteOnceTaken(*writer, MakeSample(0, std::string(500, static_cast<char>('a' + i % 26))), 1),
            WriteResult::Ok);
    }
    ASSERT_TRUE(Until([&] { return count == 100; }));
    EXPECT_EQ(changed, 0);
}

TEST_P(Conformance, TheSourceTimeArrives)
{
    const auto writing = Open("uav1");
    const auto reading = Open("ground");
    SampleRecorder recorder;
    const auto reader = reading->CreateReader(TextTopic(), Stream(10), {}, recorder.Handler());
    const auto writer = writing->CreateWriter(TextTopic(), Stream(10), {});
    ASSERT_TRUE(Matched(writer, reader));
    const std::vector<std::int64_t> times = {0, 999, 1'000'000'000, 1'700'000'000'123'456'789,
                                             1'893'456'000'999'999'999};
    for (const std::int64_t time : times)
    {
        ASSERT_EQ(WriteOnceTaken(*writer, MakeSample(0, "x"), time), WriteResult::Ok);
    }
    ASSERT_TRUE(Until([&] { return recorder.Count() >= times.size(); }));
    const auto all = recorder.All();
    for (std::size_t i = 0; i < times.size(); ++i)
    {
        EXPECT_LT(std::abs(all[i].SourceTime - times[i]), 1000) << times[i];
    }
}

TEST_P(Conformance, ASampleTellsItsNodeItsIncarnationAndItsWriter)
{
    const auto first = Open("uav1", 11);
    const auto second = Open("uav2", 18'446'744'073'709'551'615ull);
    const auto reading = Open("ground");
    SampleRecorder recorder;
    const auto reader = reading->CreateReader(TextTopic(), State(), {}, recorder.Handler());
    const auto firstWriter = first->CreateWriter(TextTopic(), State(), {});
    const auto secondWriter = second->CreateWriter(TextTopic(), State(), {});
    ASSERT_TRUE(Until([&] { return reader->MatchedWriters() == 2; }));
    ASSERT_EQ(WriteOnceTaken(*firstWriter, MakeSample(0, "1"), 1), WriteResult::Ok);
    ASSERT_TRUE(Until([&] { return recorder.Count() == 1; }));
    ASSERT_EQ(WriteOnceTaken(*firstWriter, MakeSample(0, "1"), 1), WriteResult::Ok);
    ASSERT_TRUE(Until([&] { return recorder.Count() == 2; }));
    ASSERT_EQ(WriteOnceTaken(*secondWriter, MakeSample(0, "2"), 1), WriteResult::Ok);
    ASSERT_TRUE(Until([&] { return recorder.Count() == 3; }));
    const auto all = recorder.All();
    EXPECT_EQ(all[0].Node, "uav1");
    EXPECT_EQ(all[0].Incarnation, 11u);
    EXPECT_EQ(all[2].Node, "uav2");
    EXPECT_EQ(all[2].Incarnation, 18'446'744'073'709'551'615ull);
    EXPECT_EQ(all[0].Writer, all[1].Writer);
    EXPECT_NE(all[0].Writer, all[2].Writer);
}

TEST_P(Conformance, WritersOfOneTopicDoNotPushOutEachOthersSamples)
{
    const auto first = Open("uav1");
    const auto second = Open("uav2");
    const auto reading = Open("ground");
    SampleRecorder recorder;
    // The reader's depth is 1: it counts for the writer's history alone.
    const auto reader = reading->CreateReader(TextTopic(), State(1), {}, recorder.Handler());
    const auto firstWriter = first->CreateWriter(TextTopic(), State(100), {});
    const auto secondWriter = second->CreateWriter(TextTopic(), State(100), {});
    ASSERT_TRUE(Until([&] { return reader->MatchedWriters() == 2; }));
    for (int i = 0; i < 100; ++i)
    {
        ASSERT_EQ(WriteOnceTaken(*firstWriter, MakeSample(1, std::to_string(i)), 1), WriteResult::Ok);
        ASSERT_EQ(WriteOnceTaken(*secondWriter, MakeSample(2, std::to_string(i)), 1), WriteResult::Ok);
    }
    ASSERT_TRUE(Until([&] { return recorder.Count() >= 200; }));
    std::vector<std::string> a;
    std::vector<std::string> b;
    for (const auto &received : recorder.All())
    {
        (received.Writer == recorder.All()[0].Writer ? a : b).push_back(received.Text);
    }
    std::vector<std::string> expected;
    for (int i = 0; i < 100; ++i)
    {
        expected.push_back(std::to_string(i));
    }
    EXPECT_THAT(a, ElementsAreArray(expected));
    EXPECT_THAT(b, ElementsAreArray(expected));
}

// 1 MB is 800 datagrams of the default size.
void Conformance::ExpectArrivalOf(std::size_t size)
{
    const auto writing = Open("uav1");
    const auto reading = Open("ground");
    SampleRecorder recorder;
    const auto reader = reading->CreateReader(TextTopic(), Stream(4), {}, recorder.Handler());
    const auto writer = writing->CreateWriter(TextTopic(), Stream(4), {});
    ASSERT_TRUE(Matched(writer, reader));
    std::vector<std::uint8_t> body(size);
    for (std::size_t i = 0; i < size; ++i)
    {
        body[i] = static_cast<std::uint8_t>((i * 2654435761u) >> 13);
    }
    ASSERT_EQ(WriteOnceTaken(*writer, RawSample(body), 1), WriteResult::Ok);
    ASSERT_EQ(WriteOnceTaken(*writer, MakeSample(0, "small"), 1), WriteResult::Ok);
    ASSERT_TRUE(Until([&] { return recorder.Count() >= 2; }));
    const auto all = recorder.All();
    ASSERT_EQ(all[0].Bytes.size(), size + 4);
    EXPECT_TRUE(std::equal(body.begin(), body.end(), all[0].Bytes.begin() + 4));
    EXPECT_EQ(all[1].Text, "small");
}

TEST_P(Conformance, AVolatileWriterLetsGoOfWhatAllItsReadersHave)
{
    if (MemoryIsNotGivenBack)
    {
        GTEST_SKIP() << "with AddressSanitizer, what is freed is kept for a while";
    }
    constexpr int Count = 100;
    constexpr std::size_t MostKept = 40 << 20;
    const auto writing = Open("uav1");
    const auto reading = Open("ground");
    std::atomic<int> received{0};
    const auto reader = reading->CreateReader(TextTopic(), Stream(2 * Count), {},
                                              [&](SampleBytes, const SampleInfo &) { ++received; });
    const auto writer = writing->CreateWriter(TextTopic(), Stream(2 * Count), {});
    ASSERT_TRUE(Matched(writer, reader));
    const std::string megabyte(1 << 20, 'x');
    const auto write = [&]
    {
        const int before = received;
        ASSERT_EQ(WriteOnceTaken(*writer, MakeSample(0, megabyte), 1), WriteResult::Ok);
        ASSERT_TRUE(Until([&] { return received > before; }));
    };
    // Lets the backend allocate the memory that it needs to send such samples at all.
    for (int i = 0; i < 5; ++i)
    {
        write();
    }
    const std::size_t before = HeapInUse();
    for (int i = 0; i < Count; ++i)
    {
        write();
    }
    // Acknowledgements of some samples are still on their way.
    EXPECT_TRUE(Until([&] { return HeapInUse() < before + MostKept; }));
}

TEST_P(Conformance, AVolatileWriterKeepsNothingForNobody)
{
    if (MemoryIsNotGivenBack)
    {
        GTEST_SKIP() << "with AddressSanitizer, what is freed is kept for a while";
    }
    constexpr int Count = 100;
    constexpr std::size_t MostKept = 40 << 20;
    const auto session = Open("uav1");
    const auto writer = session->CreateWriter(TextTopic(), Stream(2 * Count), {});
    const std::string megabyte(1 << 20, 'x');
    const auto write = [&]
    { ASSERT_EQ(WriteOnceTaken(*writer, MakeSample(0, megabyte), 1), WriteResult::Ok); };
    write();
    const std::size_t before = HeapInUse();
    for (int i = 0; i < Count; ++i)
    {
        write();
    }
    EXPECT_LT(HeapInUse(), before + MostKept);
}

TEST_P(Conformance, ASampleOfOneMegabyteArrives)
{
    ExpectArrivalOf(1'000'000);
}

TEST_P(Conformance, ASampleOfFourMegabytesArrives)
{
    ExpectArrivalOf(4'000'003);
}

TEST_P(Conformance, ASampleOfSixteenMegabytesArrives)
{
    ExpectArrivalOf(16'777'216);
}

}  // namespace Rabit::Conformance
