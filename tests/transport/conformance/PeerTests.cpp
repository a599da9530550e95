// Sessions that come and go.
#include <algorithm>
#include <filesystem>
#include <iterator>

#include "ConformanceTest.h"
#include "ProcessMemory.h"

namespace Rabit::Conformance
{

using Kind = PeerEvent::Kind;

TEST_P(Conformance, SessionsSeeEachOtherAppearButNotThemselves)
{
    PeerRecorder atUav;
    PeerRecorder atGround;
    const auto uav = Open("uav1", 11, atUav.Handler());
    const auto ground = Open("ground", 22, atGround.Handler());
    EXPECT_TRUE(Until([&] { return atUav.Count(Kind::Appeared, "ground", 22) == 1; }));
    EXPECT_TRUE(Until([&] { return atGround.Count(Kind::Appeared, "uav1", 11) == 1; }));
    // A session that is opened later appears behind everything that the first two hear of themselves.
    const auto last = Open("uav2", 33);
    EXPECT_TRUE(Until([&] { return atUav.Count(Kind::Appeared, "uav2", 33) == 1; }));
    EXPECT_TRUE(Until([&] { return atGround.Count(Kind::Appeared, "uav2", 33) == 1; }));
    EXPECT_EQ(atUav.CountAll(), 2u);
    EXPECT_EQ(atGround.CountAll(), 2u);
}

TEST_P(Conformance, AClosedSessionHasLeft)
{
    PeerRecorder atGround;
    const auto ground = Open("ground", 1, atGround.Handler());
    auto uav = Open("uav1", 11);
    ASSERT_TRUE(Until([&] { return atGround.Count(Kind::Appeared, "uav1", 11) == 1; }));
    uav.reset();
    EXPECT_TRUE(Until([&] { return atGround.Count(Kind::Left, "uav1", 11) == 1; }));
    EXPECT_EQ(atGround.CountAll(), 2u);
}

TEST_P(Conformance, ARestartedNodeAppearsWithItsNewIncarnation)
{
    PeerRecorder atGround;
    const auto ground = Open("ground", 1, atGround.Handler());
    auto uav = Open("uav1", 11);
    ASSERT_TRUE(Until([&] { return atGround.Count(Kind::Appeared, "uav1", 11) == 1; }));
    uav.reset();
    ASSERT_TRUE(Until([&] { return atGround.Count(Kind::Left, "uav1", 11) == 1; }));
    uav = Open("uav1", 12);
    EXPECT_TRUE(Until([&] { return atGround.Count(Kind::Appeared, "uav1", 12) == 1; }));
}

TEST_P(Conformance, TwoSessionsWithOneNameAreTwoPeers)
{
    PeerRecorder atGround;
    const auto ground = Open("ground", 1, atGround.Handler());
    const auto one = Open("uav1", 11);
    const auto other = Open("uav1", 12);
    EXPECT_TRUE(Until([&] { return atGround.Count(Kind::Appeared, "uav1", 11) == 1; }));
    EXPECT_TRUE(Until([&] { return atGround.Count(Kind::Appeared, "uav1", 12) == 1; }));
}

TEST_P(Conformance, AKilledNodeIsLostAndItsInstancesEnd)
{
    PeerRecorder atGround;
    SampleRecorder recorder;
    const auto ground = OpenForgetful("ground", atGround.Handler());
    const auto reader = ground->CreateReader(KeyedTopic(), State(), {}, recorder.Handler());
    const auto remote = Net().StartRemote("uav9", 99);
    const auto isLost = [&]
    { return atGround.Count(Kind::Lost, "uav9", 99) == atGround.Count(Kind::Appeared, "uav9", 99); };
    ASSERT_TRUE(Until([&] { return atGround.Count(Kind::Appeared, "uav9", 99) >= 1; }));
    ASSERT_TRUE(Until([&] { return recorder.Count() >= 1; }));
    EXPECT_EQ(recorder.All()[0].Text, "remote");
    EXPECT_EQ(recorder.All()[0].Node, "uav9");
    EXPECT_EQ(recorder.All()[0].Incarnation, 99u);
    remote->Kill();
    // If it was not heard for three seconds before, it is lost once more.
    ASSERT_TRUE(Until(isLost));
    EXPECT_EQ(atGround.Count(Kind::Left, "uav9", 99), 0);
    ASSERT_TRUE(Until([&] { return !recorder.All().back().Alive; }));
    EXPECT_EQ(recorder.All().back().Key, HashOf(7));
    EXPECT_TRUE(Until([&] { return reader->MatchedWriters() == 0; }));
}

// The first incarnation is lost although peers are remembered for long, because the second one has appeared.
TEST_P(Conformance, AKilledNodeThatReturnsIsHeardAgain)
{
    PeerRecorder atGround;
    SampleRecorder recorder;
    const auto ground = Open("ground", 1, atGround.Handler());
    const auto reader = ground->CreateReader(KeyedTopic(), State(), {}, recorder.Handler());
    const auto first = Net().StartRemote("uav9", 98);
    ASSERT_TRUE(Until([&] { return recorder.Count() == 1; }));
    first->Kill();
    // The node may be back before its first incarnation is missed.
    const auto second = Net().StartRemote("uav9", 99);
    ASSERT_TRUE(Until([&] { return atGround.Count(Kind::Appeared, "uav9", 99) == 1; }));
    ASSERT_TRUE(Until([&] { return atGround.Count(Kind::Lost, "uav9", 98) == 1; }));
    ASSERT_TRUE(Until(
        [&]
        {
            const auto all = recorder.All();
            return std::any_of(all.begin(), all.end(),
                               [](const Received &one)
                               { return one.Alive && one.Incarnation == 99 && one.Text == "remote"; });
        }));
    EXPECT_EQ(atGround.Count(Kind::Lost, "uav9", 99), 0);
}

TEST_P(Conformance, APeerHandlerThatThrowsIsCountedAndCalledAgain)
{
    PeerRecorder atGround;
    const auto ground = Open("ground", 1,
                             [record = atGround.Handler()](const PeerEvent &event)
                             {
                                 record(event);
                                 throw std::runtime_error("peer handler");
                             });
    auto uav = Open("uav1", 11);
    ASSERT_TRUE(Until([&] { return atGround.Count(Kind::Appeared, "uav1", 11) == 1; }));
    uav.reset();
    EXPECT_TRUE(Until([&] { return atGround.Count(Kind::Left, "uav1", 11) == 1; }));
    EXPECT_TRUE(Until([&] { return ground->Counters().HandlerExceptions == 2; }));
}

TEST_P(Conformance, OpeningAndClosingAgainAndAgainLeavesNothingBehind)
{
    const auto ground = Open("ground");
    for (std::uint64_t life = 1; life <= 8; ++life)
    {
        SampleRecorder recorder;
        const auto uav = Open("uav1", life);
        const auto writer = uav->CreateWriter(TextTopic(), State(), {});
        const auto reader = ground->CreateReader(TextTopic(), State(), {}, recorder.Handler());
        ASSERT_EQ(WriteOnceTaken(*writer, MakeSample(0, std::to_string(life)), 1), WriteResult::Ok);
        ASSERT_TRUE(Until([&] { return recorder.Count() >= 1; })) << "life " << life;
        EXPECT_EQ(recorder.All()[0].Incarnation, life);
        EXPECT_EQ(recorder.All()[0].Text, std::to_string(life));
    }
}

namespace
{

std::ptrdiff_t EntriesOf(const char *folder)
{
    return std::distance(std::filesystem::directory_iterator(folder), std::filesystem::directory_iterator());
}

}  // namespace

// Files and threads are counted. Of memory, this test shows only that it does not pile up; the build with
// AddressSanitizer finds what is leaked.
TEST_P(Conformance, AHundredOpenAndCloseCyclesLeakNothing)
{
    const auto ground = Open("ground");
    const auto cycle = [&](std::uint64_t life)
    {
        const auto uav = Open("uav1", life);
        const auto writer = uav->CreateWriter(TextTopic(), State(), {});
        const auto reader =
            uav->CreateReader(KeyedTopic(), State(), {}, [](SampleBytes, const SampleInfo &) {});
        EXPECT_EQ(WriteOnceTaken(*writer, MakeSample(0, "x"), 1), WriteResult::Ok);
    };
    // The first cycles make the things that are made once and kept.
    for (std::uint64_t life = 1; life <= 5; ++life)
    {
        cycle(life);
    }
    const auto files = EntriesOf("/proc/self/fd");
    const auto threads = EntriesOf("/proc/self/task");
    const std::size_t heap = HeapInUse();
    constexpr std::uint64_t Cycles = 100;
    for (std::uint64_t life = 6; life < 6 + Cycles; ++life)
    {
        cycle(life);
    }
    // ThreadSanitizer opens two pipes to its symbolizer for the first report, even for a suppressed one.
    constexpr std::ptrdiff_t OpenedOnce = 2;
    EXPECT_TRUE(Until([&] { return EntriesOf("/proc/self/fd") <= files + OpenedOnce; }));
    EXPECT_TRUE(Until([&] { return EntriesOf("/proc/self/task") <= threads; }));
    constexpr std::size_t PerCycle = 20 * 1024;
    std::size_t now = 0;
    EXPECT_TRUE(Until([&] { return (now = HeapInUse()) < heap + Cycles * PerCycle; }))
        << "grew by " << now - heap;
    ::testing::Test::RecordProperty("heap_growth",
                                    std::to_string(static_cast<long>(now) - static_cast<long>(heap)));
}

}  // namespace Rabit::Conformance
