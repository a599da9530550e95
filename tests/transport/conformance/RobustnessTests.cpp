// Failures, threads and lifetimes.
#include <atomic>
#include <stdexcept>
#include <thread>

#include "ConformanceTest.h"

namespace Rabit::Conformance
{

namespace
{

// Says that it has a size, and does what the test asks when it is to encode.
class FakeSample final : public SampleEncoder
{
public:
    FakeSample(std::size_t size, std::function<bool()> encode) : _size(size), _encode(std::move(encode)) {}
    std::size_t EncodedSize() const override { return _size; }
    bool Encode(std::span<std::uint8_t>) const override { return _encode(); }

private:
    std::size_t _size;
    std::function<bool()> _encode;
};

}  // namespace

TEST_P(Conformance, AWriteWithoutReadersSucceeds)
{
    const auto session = Open("uav1");
    const auto state = session->CreateWriter(TextTopic(), State(), {});
    const auto telemetry = session->CreateWriter(TextTopic("Fix"), Telemetry(), {});
    for (int i = 0; i < 1000; ++i)
    {
        ASSERT_EQ(WriteOnceTaken(*state, MakeSample(0, "x"), 1), WriteResult::Ok);
        ASSERT_EQ(WriteOnceTaken(*telemetry, MakeSample(0, "x"), 1), WriteResult::Ok);
    }
    EXPECT_EQ(session->Counters().WriteFailures, 0u);
}

TEST_P(Conformance, ASampleThatCannotBeSentIsRefusedAndCounted)
{
    const auto writing = Open("uav1");
    const auto reading = Open("ground");
    SampleRecorder recorder;
    const auto reader = reading->CreateReader(TextTopic(), Stream(10), {}, recorder.Handler());
    const auto writer = writing->CreateWriter(TextTopic(), Stream(10), {});
    ASSERT_TRUE(Matched(writer, reader));
    const auto refuse = [] { return false; };
    const auto neverAsked = []
    {
        ADD_FAILURE() << "there was no need to encode it";
        return true;
    };
    EXPECT_EQ(writer->Write(FakeSample(100, refuse), 1), WriteResult::Failed);
    EXPECT_EQ(writer->Write(FakeSample(3, neverAsked), 1), WriteResult::Failed);
    EXPECT_EQ(writer->Write(FakeSample(LargestSample + 1, neverAsked), 1), WriteResult::TooLarge);
    EXPECT_EQ(writer->Dispose(MakeSample(0, "no key"), 1), WriteResult::Failed);
    EXPECT_TRUE(Until([&] { return writing->Counters().WriteFailures == 4u; }));
    ASSERT_EQ(WriteOnceTaken(*writer, MakeSample(0, "good"), 1), WriteResult::Ok);
    ASSERT_TRUE(Until([&] { return recorder.Count() >= 1; }));
    EXPECT_THAT(recorder.Texts(), testing::ElementsAre("good"));
}

TEST_P(Conformance, ASampleWithoutAReadableKeyIsRefused)
{
    const auto session = Open("uav1");
    const auto writer = session->CreateWriter(KeyedTopic(), State(), {});
    EXPECT_EQ(writer->Write(RawSample({1, 2}), 1), WriteResult::Failed);
    EXPECT_TRUE(Until([&] { return session->Counters().WriteFailures == 1u; }));
}

TEST_P(Conformance, AHandlerThatThrowsIsCountedAndCalledAgain)
{
    const auto writing = Open("uav1");
    const auto reading = Open("ground");
    SampleRecorder recorder;
    const auto reader =
        reading->CreateReader(TextTopic(), Stream(10), {},
                              [record = recorder.Handler()](SampleBytes bytes, const SampleInfo &info)
                              {
                                  record(bytes, info);
                                  if (TextOf(bytes) == "int")
                                  {
                                      throw 42;
                                  }
                                  throw std::runtime_error("handler");
                              });
    const auto writer = writing->CreateWriter(TextTopic(), Stream(10), {});
    ASSERT_TRUE(Matched(writer, reader));
    for (const char *text : {"int", "exception", "exception"})
    {
        ASSERT_EQ(WriteOnceTaken(*writer, MakeSample(0, text), 1), WriteResult::Ok);
    }
    ASSERT_TRUE(Until([&] { return recorder.Count() >= 3; }));
    EXPECT_TRUE(Until([&] { return reading->Counters().HandlerExceptions == 3; }));
    EXPECT_EQ(writing->Counters().HandlerExceptions, 0u);
}

TEST_P(Conformance, AHandlerNeverRunsInsideWrite)
{
    static thread_local bool isWriting = false;
    const auto writing = Open("uav1");
    const auto reading = Open("ground");
    std::atomic<int> insideWrite{0};
    std::atomic<int> count{0};
    const auto reader = reading->CreateReader(TextTopic(), Stream(1000), {},
                                              [&](SampleBytes, const SampleInfo &)
                                              {
                                                  insideWrite += isWriting ? 1 : 0;
                                                  ++count;
                                              });
    const auto writer = writing->CreateWriter(TextTopic(), Stream(1000), {});
    ASSERT_TRUE(Matched(writer, reader));
    for (int i = 0; i < 200; ++i)
    {
        isWriting = true;
        ASSERT_EQ(WriteOnceTaken(*writer, MakeSample(0, "x"), 1), WriteResult::Ok);
        isWriting = false;
    }
    ASSERT_TRUE(Until([&] { return count == 200; }));
    EXPECT_EQ(insideWrite, 0);
}

TEST_P(Conformance, HandlersOfOneReaderNeverRunAtOnce)
{
    const auto first = Open("uav1");
    const auto second = Open("uav2");
    const auto reading = Open("ground");
    std::atomic<int> running{0};
    std::atomic<int> overlaps{0};
    std::atomic<int> count{0};
    const auto reader = reading->CreateReader(TextTopic(), Stream(1000), {},
                                              [&](SampleBytes, const SampleInfo &)
                                              {
                                                  overlaps += running++ == 0 ? 0 : 1;
                                                  std::this_thread::yield();
                                                  --running;
                                                  ++count;
                                              });
    const auto firstWriter = first->CreateWriter(TextTopic(), Stream(1000), {});
    const auto secondWriter = second->CreateWriter(TextTopic(), Stream(1000), {});
    ASSERT_TRUE(Until(
        [&]
        {
            return reader->MatchedWriters() == 2 && firstWriter->MatchedReaders() == 1 &&
                   secondWriter->MatchedReaders() == 1;
        }));
    const auto blast = [](TransportWriter &writer)
    {
        for (int i = 0; i < 500; ++i)
        {
            EXPECT_EQ(WriteOnceTaken(writer, MakeSample(0, "x"), 1), WriteResult::Ok);
        }
    };
    std::jthread one(blast, std::ref(*firstWriter));
    std::jthread other(blast, std::ref(*secondWriter));
    // Simulated time does not wait for threads that have not had a processor yet.
    one.join();
    other.join();
    EXPECT_TRUE(Until([&] { return count == 1000; }));
    EXPECT_EQ(overlaps, 0);
}

TEST_P(Conformance, ThreadsThatShareAWriterLoseNothingAndKeepTheirOrder)
{
    constexpr std::uint32_t Threads = 4;
    constexpr std::uint32_t Each = 200;
    const auto writing = Open("uav1");
    const auto reading = Open("ground");
    SampleRecorder recorder;
    const auto reader = reading->CreateReader(KeyedTopic(), Stream(1000), {}, recorder.Handler());
    const auto writer = writing->CreateWriter(KeyedTopic(), Stream(1000), {});
    ASSERT_TRUE(Matched(writer, reader));
    {
        std::vector<std::jthread> threads;
        for (std::uint32_t thread = 0; thread < Threads; ++thread)
        {
            threads.emplace_back(
                [&, thread]
                {
                    for (std::uint32_t i = 0; i < Each; ++i)
                    {
                        EXPECT_EQ(WriteOnceTaken(*writer, MakeSample(thread, std::to_string(i)), 1),
                                  WriteResult::Ok);
                    }
                });
        }
    }
    ASSERT_TRUE(Until([&] { return recorder.Count() >= Threads * Each; }));
    for (std::uint32_t thread = 0; thread < Threads; ++thread)
    {
        std::uint32_t next = 0;
        for (const auto &received : recorder.All())
        {
            if (received.Key == HashOf(thread))
            {
                ASSERT_EQ(received.Text, std::to_string(next));
                ++next;
            }
        }
        EXPECT_EQ(next, Each);
    }
}

TEST_P(Conformance, NoHandlerRunsOnceItsReaderIsGone)
{
    const auto writing = Open("uav1");
    const auto reading = Open("ground");
    const auto writer = writing->CreateWriter(TextTopic(), Stream(10), {});
    const auto fence = writing->CreateWriter(TextTopic("Fence"), Stream(10), {});
    SampleRecorder fences;
    const auto fenceReader = reading->CreateReader(TextTopic("Fence"), Stream(10), {}, fences.Handler());
    ASSERT_TRUE(Matched(fence, fenceReader));
    std::jthread blast(
        [&](const std::stop_token &stop)
        {
            while (!stop.stop_requested())
            {
                EXPECT_EQ(WriteOnceTaken(*writer, MakeSample(0, "x"), 1), WriteResult::Ok);
                std::this_thread::yield();
            }
        });
    for (int life = 0; life < 10; ++life)
    {
        std::atomic<bool> alive{true};
        std::atomic<int> after{0};
        std::atomic<int> count{0};
        auto reader = reading->CreateReader(TextTopic(), Stream(10), {},
                                            [&](SampleBytes, const SampleInfo &)
                                            {
                                                ++count;
                                                std::this_thread::yield();
                                                after += alive ? 0 : 1;
                                            });
        ASSERT_TRUE(Until([&] { return count > 0; }));
        reader.reset();
        alive = false;
        // The fence comes behind samples that were written for the reader.
        const std::size_t before = fences.Count();
        ASSERT_EQ(WriteOnceTaken(*fence, MakeSample(0, "fence"), 1), WriteResult::Ok);
        ASSERT_TRUE(Until([&] { return fences.Count() > before; }));
        EXPECT_EQ(after, 0);
    }
}

TEST_P(Conformance, ClosingAReaderWaitsForItsHandler)
{
    const auto writing = Open("uav1");
    const auto reading = Open("ground");
    const auto writer = writing->CreateWriter(TextTopic(), Stream(10), {});
    std::atomic<bool> entered{false};
    std::atomic<bool> closing{false};
    std::atomic<bool> left{false};
    auto reader = reading->CreateReader(TextTopic(), Stream(10), {},
                                        [&](SampleBytes, const SampleInfo &)
                                        {
                                            entered = true;
                                            while (!closing)
                                            {
                                                std::this_thread::yield();
                                            }
                                            left = true;
                                        });
    ASSERT_TRUE(Matched(writer, reader));
    ASSERT_EQ(WriteOnceTaken(*writer, MakeSample(0, "x"), 1), WriteResult::Ok);
    std::jthread closer(
        [&]
        {
            while (!entered)
            {
                std::this_thread::yield();
            }
            closing = true;
            reader.reset();
            EXPECT_TRUE(left);
        });
    EXPECT_TRUE(Until([&] { return left.load(); }));
}

}  // namespace Rabit::Conformance
