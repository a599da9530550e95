// Properties that only the simulated network has: faults, time, determinism.
#include <gmock/gmock.h>

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
using testing::Ge;
using testing::Gt;
using testing::IsEmpty;
using testing::Le;
using testing::Lt;
using Kind = PeerEvent::Kind;

SimulatedFaults Cut()
{
    SimulatedFaults faults;
    faults.Cut = true;
    return faults;
}

SimulatedFaults Loss(double probability)
{
    SimulatedFaults faults;
    faults.Loss = probability;
    return faults;
}

// Two nodes, a writer at uav1 and a reader at ground.
class SimulatedNetworkTest : public testing::Test
{
protected:
    void Connect(const TopicQos &qos, const TopicDescription &topic = TextTopic())
    {
        Writer = Uav->CreateWriter(topic, qos, {});
        Reader = Ground->CreateReader(topic, qos, {}, Got.Handler());
        ASSERT_TRUE(Net.Until([&] { return IsMatched(); }));
    }
    bool IsMatched() const { return Writer->MatchedReaders() == 1 && Reader->MatchedWriters() == 1; }
    void Write(int first, int last)
    {
        for (int i = first; i <= last; ++i)
        {
            ASSERT_EQ(Writer->Write(MakeSample(0, std::to_string(i)), i), WriteResult::Ok);
            Net.Pass(10ms);
        }
    }
    std::unique_ptr<TransportSession> Open(const std::string &node, PeerRecorder &peers)
    {
        return Net.Backend().Open(Net.SettingsFor(node, 1), peers.Handler());
    }
    static std::vector<std::string> Numbers(int first, int last)
    {
        std::vector<std::string> texts;
        for (int i = first; i <= last; ++i)
        {
            texts.push_back(std::to_string(i));
        }
        return texts;
    }

    SimulatedHarness Net;
    PeerRecorder AtUav;
    PeerRecorder AtGround;
    SampleRecorder Got;
    std::unique_ptr<TransportSession> Uav = Open("uav1", AtUav);
    std::unique_ptr<TransportSession> Ground = Open("ground", AtGround);
    std::unique_ptr<TransportWriter> Writer;
    std::unique_ptr<TransportReader> Reader;
};

TEST_F(SimulatedNetworkTest, NothingHappensWhileTimeStandsStill)
{
    EXPECT_EQ(AtUav.CountAll(), 0u);
    Net.Network().AdvanceTo(Net.Network().Now());
    EXPECT_EQ(AtUav.CountAll(), 0u);
    Net.Pass(10ms);
    EXPECT_EQ(AtUav.Count(Kind::Appeared, "ground", 1), 1);
}

TEST_F(SimulatedNetworkTest, TimeDoesNotGoBack)
{
    Net.Network().AdvanceTo(5s);
    Net.Network().AdvanceTo(3s);
    EXPECT_EQ(Net.Network().Now(), 5s);
}

TEST_F(SimulatedNetworkTest, ASampleTakesTheDelayOfItsDirection)
{
    Connect(Stream(10));
    SimulatedFaults slow;
    slow.Delay = 70ms;
    Net.Network().SetFaults("uav1", "ground", slow);
    ASSERT_EQ(Writer->Write(MakeSample(0, "x"), 1), WriteResult::Ok);
    Net.Pass(70ms - 1ns);
    EXPECT_EQ(Got.Count(), 0u);
    Net.Pass(1ns);
    EXPECT_EQ(Got.Count(), 1u);
}

TEST_F(SimulatedNetworkTest, NextEventTellsWhenTheNextSampleArrives)
{
    Connect(Stream(10));
    SimulatedFaults quick;
    quick.Delay = 3us;
    Net.Network().SetFaults("uav1", "ground", quick);
    ASSERT_EQ(Writer->Write(MakeSample(0, "x"), 1), WriteResult::Ok);
    ASSERT_EQ(Net.Network().NextEvent(), Net.Network().Now() + 3us);
    Net.Network().AdvanceTo(*Net.Network().NextEvent());
    EXPECT_EQ(Got.Count(), 1u);
}

TEST_F(SimulatedNetworkTest, BestEffortLosesWhatTheNetworkLoses)
{
    Connect(Telemetry());
    Net.Network().SetFaults("uav1", "ground", Loss(0.3));
    Write(1, 1000);
    Net.Pass(1s);
    EXPECT_THAT(Got.Count(), testing::AllOf(Gt(600u), Lt(800u)));
    EXPECT_EQ(Ground->Counters().SamplesLost, Got.All().back().Sequence - Got.Count());
}

TEST_F(SimulatedNetworkTest, LossesComeInBurstsOfTheGivenLength)
{
    Connect(Telemetry());
    SimulatedFaults bursts = Loss(0.2);
    bursts.Burst = 5;
    Net.Network().SetFaults("uav1", "ground", bursts);
    Write(1, 5000);
    Net.Pass(1s);
    EXPECT_THAT(Got.Count(), testing::AllOf(Gt(3700u), Lt(4300u)));
    std::size_t gaps = 0;
    for (std::size_t i = 1; i < Got.All().size(); ++i)
    {
        gaps += Got.All()[i].Sequence != Got.All()[i - 1].Sequence + 1 ? 1 : 0;
    }
    EXPECT_THAT((5000 - Got.Count()) / gaps, testing::AllOf(Ge(4u), Le(6u)));
}

TEST_F(SimulatedNetworkTest, ReliableRepairsWhatTheNetworkLoses)
{
    Connect(Stream(1000));
    Net.Network().SetFaults("*", "*", Loss(0.4));
    Write(1, 500);
    ASSERT_TRUE(Net.Until([&] { return Got.Count() == 500; }));
    EXPECT_EQ(Got.Texts(), Numbers(1, 500));
    EXPECT_EQ(Ground->Counters().SamplesLost, 0u);
}

TEST_F(SimulatedNetworkTest, ReliableLosesWhatItsHistoryNoLongerHas)
{
    Connect(Stream(5));
    Net.Network().SetFaults("uav1", "ground", Cut());
    Write(1, 20);
    Net.Network().ClearFaults();
    ASSERT_TRUE(Net.Until([&] { return Got.Count() >= 5; }));
    Net.Pass(2s);
    EXPECT_EQ(Got.Texts(), Numbers(16, 20));
}

TEST_F(SimulatedNetworkTest, AGapInTheHistoryOfAReliableWriterIsCounted)
{
    Connect(Stream(5));
    Write(1, 1);
    Net.Network().SetFaults("uav1", "ground", Cut());
    Write(2, 20);
    Net.Network().ClearFaults();
    ASSERT_TRUE(Net.Until([&] { return Got.Count() >= 6; }));
    EXPECT_EQ(Ground->Counters().SamplesLost, 14u);  // 2 to 15
}

TEST_F(SimulatedNetworkTest, OverwrittenInstancesDoNotBlockTheOthers)
{
    Connect(State(1), KeyedTopic());
    Net.Network().SetFaults("uav1", "ground", Cut());
    for (const std::uint32_t key : {1u, 2u, 1u, 1u, 3u})
    {
        ASSERT_EQ(Writer->Write(MakeSample(key, std::to_string(key)), 1), WriteResult::Ok);
    }
    Net.Network().ClearFaults();
    ASSERT_TRUE(Net.Until([&] { return Got.Count() >= 3; }));
    Net.Pass(2s);
    EXPECT_THAT(Got.Texts(), ElementsAre("2", "1", "3"));
}

TEST_F(SimulatedNetworkTest, DuplicatesAreHandedOverOnce)
{
    SimulatedFaults twice;
    twice.Duplicate = 1.0;
    twice.Jitter = 50ms;
    Net.Network().SetFaults("*", "*", twice);
    Connect(Stream(100));
    Write(1, 100);
    Net.Pass(2s);
    EXPECT_EQ(Got.Texts(), Numbers(1, 100));
    EXPECT_GT(Net.Network().Traffic().Duplicated, 100u);
}

TEST_F(SimulatedNetworkTest, ReorderedReliableSamplesAreHandedOverInOrder)
{
    Connect(Stream(100));
    SimulatedFaults jitter;
    jitter.Jitter = 200ms;
    jitter.Straggle = 0.1;
    jitter.StraggleDelay = 2s;
    Net.Network().SetFaults("*", "*", jitter);
    Write(1, 100);
    ASSERT_TRUE(Net.Until([&] { return Got.Count() == 100; }));
    EXPECT_EQ(Got.Texts(), Numbers(1, 100));
}

TEST_F(SimulatedNetworkTest, ReorderedBestEffortSamplesAreDroppedIfLate)
{
    Connect(Telemetry());
    SimulatedFaults jitter;
    jitter.Jitter = 200ms;
    Net.Network().SetFaults("uav1", "ground", jitter);
    Write(1, 200);
    Net.Pass(2s);
    const auto all = Got.All();
    EXPECT_THAT(all.size(), testing::AllOf(Gt(10u), Lt(200u)));
    for (std::size_t i = 1; i < all.size(); ++i)
    {
        EXPECT_GT(all[i].Sequence, all[i - 1].Sequence);
    }
}

TEST_F(SimulatedNetworkTest, ACutShorterThanTheLeaseLosesNothingReliable)
{
    Connect(Stream(1000));
    Net.Network().SetFaults("uav1", "ground", Cut());
    Net.Network().SetFaults("ground", "uav1", Cut());
    Write(1, 150);  // 1.5 s
    EXPECT_EQ(Got.Count(), 0u);
    Net.Network().ClearFaults();
    ASSERT_TRUE(Net.Until([&] { return Got.Count() == 150; }));
    EXPECT_EQ(Got.Texts(), Numbers(1, 150));
    EXPECT_EQ(AtGround.Count(Kind::Lost, "uav1", 1), 0);
}

TEST_F(SimulatedNetworkTest, ACutLongerThanTheLeaseLosesAVolatileStream)
{
    Connect(Stream(10000));
    Write(1, 1);
    Net.Network().SetFaults("*", "*", Cut());
    Write(2, 600);  // 6 s, and the lease is 3 s
    EXPECT_EQ(AtGround.Count(Kind::Lost, "uav1", 1), 1);
    EXPECT_EQ(AtUav.Count(Kind::Lost, "ground", 1), 1);
    EXPECT_EQ(Writer->MatchedReaders(), 0);
    EXPECT_EQ(Reader->MatchedWriters(), 0);
    Net.Network().ClearFaults();
    ASSERT_TRUE(Net.Until([&] { return IsMatched(); }));
    EXPECT_EQ(AtGround.Count(Kind::Appeared, "uav1", 1), 2);
    Write(601, 610);
    Net.Pass(2s);
    auto expected = Numbers(601, 610);
    expected.insert(expected.begin(), "1");
    EXPECT_EQ(Got.Texts(), expected);
}

TEST_F(SimulatedNetworkTest, StateIsThereAgainAfterALongCut)
{
    Connect(State(1));
    Net.Network().SetFaults("*", "*", Cut());
    Write(1, 600);
    Net.Network().ClearFaults();
    ASSERT_TRUE(Net.Until([&] { return Got.Count() >= 1; }));
    EXPECT_THAT(Got.Texts(), ElementsAre("600"));
}

TEST_F(SimulatedNetworkTest, AOneWayCutIsNoticedByTheDeafSideAlone)
{
    Connect(Stream(10));
    Net.Network().SetFaults("uav1", "ground", Cut());
    Net.Pass(10s);
    EXPECT_EQ(AtGround.Count(Kind::Lost, "uav1", 1), 1);
    EXPECT_EQ(AtUav.Count(Kind::Lost, "ground", 1), 0);
    EXPECT_EQ(Writer->MatchedReaders(), 1);
    EXPECT_EQ(Reader->MatchedWriters(), 0);
    Net.Network().ClearFaults();
    ASSERT_TRUE(Net.Until([&] { return IsMatched(); }));
    Write(1, 5);
    EXPECT_TRUE(Net.Until([&] { return Got.Count() == 5; }));
}

TEST_F(SimulatedNetworkTest, SamplesArriveThoughNothingComesBack)
{
    Connect(Stream(10));
    Net.Network().SetFaults("ground", "uav1", Cut());
    Write(1, 5);
    EXPECT_EQ(Got.Texts(), Numbers(1, 5));
}

TEST_F(SimulatedNetworkTest, DiscoveryGetsThroughABadNetwork)
{
    SimulatedFaults bad = Loss(0.6);
    bad.Jitter = 100ms;
    Net.Network().SetFaults("*", "*", bad);
    Writer = Uav->CreateWriter(TextTopic(), State(), {});
    Reader = Ground->CreateReader(TextTopic(), State(), {}, Got.Handler());
    ASSERT_EQ(Writer->Write(MakeSample(0, "x"), 1), WriteResult::Ok);
    EXPECT_TRUE(Net.Until([&] { return Got.Count() >= 1; }));
}

TEST_F(SimulatedNetworkTest, TheLastFaultsThatFitHold)
{
    Connect(Telemetry());
    Net.Network().SetFaults("*", "*", Cut());
    Net.Network().SetFaults("uav?", "ground", {});
    Write(1, 1);
    EXPECT_EQ(Got.Count(), 1u);
    Net.Network().SetFaults("*", "*", Cut());
    Write(2, 2);
    EXPECT_EQ(Got.Count(), 1u);
    Net.Network().SetFaults("uav2", "ground", {});
    Write(3, 3);
    EXPECT_EQ(Got.Count(), 1u);
    Net.Network().ClearFaults();
    Write(4, 4);
    EXPECT_EQ(Got.Count(), 2u);
}

TEST_F(SimulatedNetworkTest, ACrashedNodeIsLostAndItsWritesFail)
{
    Connect(Stream(10));
    Net.Network().CrashNode("uav1");
    EXPECT_EQ(Writer->Write(MakeSample(0, "x"), 1), WriteResult::Failed);
    Net.Pass(2900ms);
    EXPECT_EQ(AtGround.Count(Kind::Lost, "uav1", 1), 0);
    ASSERT_TRUE(Net.Until([&] { return AtGround.Count(Kind::Lost, "uav1", 1) == 1; }));
    Writer.reset();
    Uav.reset();
    Net.Pass(2s);
    EXPECT_EQ(AtGround.Count(Kind::Left, "uav1", 1), 0);
    EXPECT_EQ(AtUav.CountAll(), 1u);  // that ground appeared, long ago
}

TEST_F(SimulatedNetworkTest, NobodyHearsThatTheObjectsOfACrashedNodeAreDestroyed)
{
    Connect(Stream(10));
    Net.Network().CrashNode("uav1");
    Writer.reset();
    Net.Pass(2900ms);
    EXPECT_EQ(Reader->MatchedWriters(), 1) << "until the lease has run out";
    EXPECT_TRUE(Net.Until([&] { return Reader->MatchedWriters() == 0; }));
}

TEST_F(SimulatedNetworkTest, ANodeThatIsAloneAnnouncesItselfToTheGroupAllTheSame)
{
    Ground.reset();
    Net.Pass(10s);
    const std::uint64_t before = Uav->Counters().DiscoveryBytes;
    Net.Pass(10s);
    EXPECT_GT(Uav->Counters().DiscoveryBytes, before);
}

TEST_F(SimulatedNetworkTest, AnAnnouncementOvertakenByTheGoodbyeRevivesNobody)
{
    Net.Pass(2s);
    SimulatedFaults slow;
    slow.Delay = 2s;
    Net.Network().SetFaults("uav1", "ground", slow);
    Net.Pass(1500ms);  // announcements are under way
    Net.Network().ClearFaults();
    Uav.reset();
    Net.Pass(10s);
    EXPECT_EQ(AtGround.Count(Kind::Appeared, "uav1", 1), 1);
    EXPECT_EQ(AtGround.Count(Kind::Left, "uav1", 1), 1);
    EXPECT_EQ(AtGround.CountAll(), 2u);
}

TEST_F(SimulatedNetworkTest, ALargeSampleGetsThroughALossyNetworkIfReliable)
{
    Connect(Stream(2));
    Net.Network().SetFaults("*", "*", Loss(0.2));
    ASSERT_EQ(Writer->Write(RawSample(std::vector<std::uint8_t>(1'000'000)), 1), WriteResult::Ok);
    EXPECT_TRUE(Net.Until([&] { return Got.Count() == 1; }));
}

TEST_F(SimulatedNetworkTest, ALargeSampleDoesNotGetThroughALossyNetworkIfBestEffort)
{
    Connect(Telemetry());
    Net.Network().SetFaults("*", "*", Loss(0.2));
    for (int i = 0; i < 20; ++i)
    {
        ASSERT_EQ(Writer->Write(RawSample(std::vector<std::uint8_t>(1'000'000)), 1), WriteResult::Ok);
    }
    Net.Pass(2s);
    EXPECT_EQ(Got.Count(), 0u);
}

TEST_F(SimulatedNetworkTest, OtherDomainsAreNotHeard)
{
    PeerRecorder elsewhere;
    auto settings = Net.SettingsFor("uav9", 1);
    settings.Domain = 9;
    const auto other = Net.Backend().Open(settings, elsewhere.Handler());
    Net.Pass(2s);
    EXPECT_EQ(elsewhere.CountAll(), 0u);
    EXPECT_EQ(AtGround.CountAll(), 1u);
}

// The simulation is for thousands of runs of whole fleets: a sample must stay cheap.
TEST_F(SimulatedNetworkTest, AReliableSampleCostsFewEvents)
{
    Connect(Stream(1000));
    const auto before = Net.Network().Traffic().Events;
    for (int i = 0; i < 1000; ++i)
    {
        ASSERT_EQ(Writer->Write(MakeSample(0, "x"), 1), WriteResult::Ok);
        Net.Pass(1ms);
    }
    ASSERT_TRUE(Net.Until([&] { return Got.Count() == 1000; }));
    EXPECT_LT(Net.Network().Traffic().Events - before, 1300u);
}

// Runs a small fleet over a bad network. Returns all deliveries with their times.
std::string TraceOf(std::uint64_t seed, std::chrono::nanoseconds step)
{
    std::ostringstream trace;
    SimulatedHarness net(seed);
    const auto listen = [&](const char *who)
    {
        return [&trace, &net, who](SampleBytes bytes, const SampleInfo &info)
        {
            trace << net.Network().Now().count() << " " << who << " " << info.Node << " " << info.Sequence
                  << " " << TextOf(bytes) << "\n";
        };
    };
    const auto watch = [&](const char *who)
    {
        return [&trace, &net, who](const PeerEvent &event)
        {
            trace << net.Network().Now().count() << " " << who << " " << static_cast<int>(event.What) << " "
                  << event.Node << "\n";
        };
    };
    SimulatedFaults bad = Loss(0.3);
    bad.Duplicate = 0.1;
    bad.Jitter = 40ms;
    net.Network().SetFaults("*", "*", bad);
    const auto a = net.Backend().Open(net.SettingsFor("a", 1), watch("a"));
    const auto b = net.Backend().Open(net.SettingsFor("b", 1), watch("b"));
    const auto c = net.Backend().Open(net.SettingsFor("c", 1), watch("c"));
    const auto ra = a->CreateReader(TextTopic(), Stream(50), {}, listen("a"));
    const auto rb = b->CreateReader(TextTopic(), Telemetry(), {}, listen("b"));
    const auto wb = b->CreateWriter(TextTopic(), Stream(50), {});
    const auto wc = c->CreateWriter(TextTopic(), State(50), {});
    for (int i = 0; i < 50; ++i)
    {
        wb->Write(MakeSample(0, std::to_string(i)), i);
        wc->Write(MakeSample(0, std::to_string(i)), i);
        const auto end = net.Network().Now() + 100ms;
        while (net.Network().Now() < end)
        {
            net.Network().AdvanceTo(std::min(end, net.Network().Now() + step));
        }
        if (i == 20)
        {
            net.Network().SetFaults("c", "a", Cut());
        }
    }
    return trace.str();
}

TEST(SimulatedDeterminism, OneSeedGivesOneTrace)
{
    EXPECT_EQ(TraceOf(7, 100ms), TraceOf(7, 100ms));
    EXPECT_NE(TraceOf(7, 100ms), TraceOf(8, 100ms));
}

TEST(SimulatedDeterminism, TheSizeOfTheStepsDoesNotMatter)
{
    EXPECT_EQ(TraceOf(7, 100ms), TraceOf(7, 1ms));
}

}  // namespace

}  // namespace Rabit::Conformance
