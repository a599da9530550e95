// The datagrams and bytes that writing costs, and that they are counted.
#include <algorithm>
#include <array>
#include <atomic>
#include <iterator>
#include <memory>
#include <string>
#include <vector>

#include "ConformanceTest.h"

namespace Rabit::Conformance
{

namespace
{

constexpr std::uint64_t Samples = 50;
constexpr std::size_t Body = 1000;
// IPv4, UDP, RTPS header, INFO_TS, DATA, encapsulation.
constexpr std::uint64_t Least = 20 + 8 + 20 + 12 + 24 + 4;
// INFO_DST, and the submessages that a vendor may add to a sample.
constexpr std::uint64_t Most = Least + 16 + 40;

}  // namespace

Conformance::SessionPtr Conformance::OpenWith(const std::string &node, bool multicast,
                                              std::uint64_t incarnation)
{
    TransportSettings settings = Net().SettingsFor(node, incarnation);
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
    EXPECT_LE(bytes, datagrams * (Body + Most + Net().MostAdded()));
}

TEST_P(Conformance, WhatGoesToEachReaderByItselfCostsThatOftenAndIsCounted)
{
    ExpectCostOfWriting(false, 2);
}

TEST_P(Conformance, WhatGoesToAllByMulticastCostsOnceAndIsCounted)
{
    ExpectCostOfWriting(true, 1);
}

void Conformance::ExpectOneDatagramForATurn(bool multicast, std::uint64_t destinations)
{
    const auto writing = OpenWith("uav1", multicast);
    const auto first = OpenWith("ground", multicast);
    const auto second = OpenWith("uav2", multicast);
    const auto poses = writing->CreateWriter(TextTopic("Pose"), Telemetry(), {});
    const auto states = writing->CreateWriter(TextTopic("State"), State(), {});
    SampleRecorder poseHere;
    SampleRecorder poseThere;
    SampleRecorder stateHere;
    SampleRecorder stateThere;
    const ReaderPtr readers[] = {
        first->CreateReader(TextTopic("Pose"), Telemetry(), {}, poseHere.Handler()),
        second->CreateReader(TextTopic("Pose"), Telemetry(), {}, poseThere.Handler()),
        first->CreateReader(TextTopic("State"), State(), {}, stateHere.Handler()),
        second->CreateReader(TextTopic("State"), State(), {}, stateThere.Handler())};
    const auto isMatched = [](const ReaderPtr &reader) { return reader->MatchedWriters() == 1; };
    ASSERT_TRUE(Until(
        [&]
        {
            return poses->MatchedReaders() == 2 && states->MatchedReaders() == 2 &&
                   std::all_of(std::begin(readers), std::end(readers), isMatched);
        }));
    const RawSample sample{std::vector<std::uint8_t>(100)};
    constexpr int Turns = 20;
    // Heartbeats may be counted in between, so not all turns tell.
    int ofOneDatagram = 0;
    for (int turn = 1; turn <= Turns; ++turn)
    {
        ASSERT_TRUE(writing->BeginTurn(1400));
        const TransportCounters before = writing->Counters();
        ASSERT_EQ(WriteOnceTaken(*poses, sample, 1000 * turn), WriteResult::Ok);
        const TurnDestinations ofPoses = writing->TakeTurnDestinations();
        ASSERT_EQ(WriteOnceTaken(*states, sample, 1000 * turn), WriteResult::Ok);
        const TurnDestinations ofStates = writing->TakeTurnDestinations();
        const TransportCounters after = writing->Counters();
        writing->EndTurn();
        EXPECT_EQ(ofPoses.Count, destinations);
        EXPECT_NE(ofPoses.Number, 0u);
        EXPECT_EQ(ofPoses.Number, ofStates.Number);
        const bool isOne = after.SampleDatagrams - before.SampleDatagrams == destinations;
        const std::uint64_t bytes = after.SampleBytes - before.SampleBytes;
        ofOneDatagram += isOne && bytes <= destinations * (Most + 100 + Most - 48 + 100) ? 1 : 0;
        const auto arrived = [turn](SampleRecorder &recorder)
        { return recorder.Count() == static_cast<std::size_t>(turn); };
        const bool haveAll = Until(
            [&]
            { return arrived(poseHere) && arrived(poseThere) && arrived(stateHere) && arrived(stateThere); });
        ASSERT_TRUE(haveAll) << "turn " << turn;
    }
    EXPECT_GE(ofOneDatagram, Turns / 2);
}

TEST_P(Conformance, SamplesOfATurnGoInOneDatagramByMulticast)
{
    ExpectOneDatagramForATurn(true, 1);
}

TEST_P(Conformance, SamplesOfATurnGoInOneDatagramToEachReader)
{
    ExpectOneDatagramForATurn(false, 2);
}

// Thirty samples of one writer, of which three fit a datagram.
TEST_P(Conformance, SamplesOfATurnArriveInTheirOrderWhateverTheirSizes)
{
    const auto writing = Open("uav1");
    const auto reading = Open("ground");
    const auto writer = writing->CreateWriter(TextTopic(), State(30), {});
    SampleRecorder recorder;
    const auto reader = reading->CreateReader(TextTopic(), State(30), {}, recorder.Handler());
    ASSERT_TRUE(Matched(writer, reader));
    ASSERT_TRUE(writing->BeginTurn(600));
    for (std::size_t i = 0; i < 30; ++i)
    {
        const RawSample sample{
            std::vector<std::uint8_t>(i % 7 == 3 ? 900 : 100, static_cast<std::uint8_t>(i))};
        ASSERT_EQ(WriteOnceTaken(*writer, sample, static_cast<std::int64_t>(i)), WriteResult::Ok);
    }
    writing->EndTurn();
    ASSERT_TRUE(Until([&] { return recorder.Count() == 30; }));
    for (std::size_t i = 0; i < 30; ++i)
    {
        EXPECT_EQ(recorder.All()[i].Bytes.back(), i);
    }
}

TEST_P(Conformance, SessionsWhoseDiscoveryTakesTurnsFindAllOfEachOtherByThem)
{
    constexpr std::size_t Endpoints = 10;
    std::atomic<int> due{0};  // outlives the sessions, whose threads count here
    const auto writing = Open("uav1");
    const auto reading = Open("ground");
    for (const auto *session : {&writing, &reading})
    {
        ASSERT_NE((*session)->Discovery(), nullptr);
        (*session)->Discovery()->Schedule([&due] { ++due; });
    }
    std::vector<std::unique_ptr<TransportWriter>> writers;
    std::vector<std::unique_ptr<TransportReader>> readers;
    SampleRecorder recorder;
    for (std::size_t i = 0; i < Endpoints; ++i)
    {
        const auto topic = TextTopic("Text" + std::to_string(i));
        writers.push_back(writing->CreateWriter(topic, Telemetry(), {}));
        readers.push_back(reading->CreateReader(topic, Telemetry(), {}, recorder.Handler()));
    }
    EXPECT_TRUE(Until([&] { return writing->Discovery()->IsDue() && reading->Discovery()->IsDue(); }));
    EXPECT_GE(due, 2);
    EXPECT_EQ(writers.front()->MatchedReaders(), 0u) << "found without a turn";
    EXPECT_TRUE(Until(
        [&]
        {
            for (const auto *session : {&writing, &reading})
            {
                DiscoveryTurns &turns = *(*session)->Discovery();
                if (turns.IsDue() && turns.NextBytes() > 0)
                {
                    turns.SendNext();
                }
            }
            return std::all_of(writers.begin(), writers.end(),
                               [](const auto &writer) { return writer->MatchedReaders() == 1; }) &&
                   std::all_of(readers.begin(), readers.end(),
                               [](const auto &reader) { return reader->MatchedWriters() == 1; });
        }));
}

TEST_P(Conformance, ATurnOfDiscoveryTakesAboutTheBytesThatItSaid)
{
    const auto reading = Open("ground");
    const auto writing = Open("uav1");
    // A session with keys sends no card before its participant has been announced.
    ASSERT_TRUE(Until([&] { return writing->Counters().DiscoveryBytes > 0; }));
    DiscoveryTurns &turns = *writing->Discovery();
    turns.Schedule([] {});
    std::vector<WriterPtr> writers;
    // An announcement of the participant, which takes no turn, may go meanwhile: then the next turn is tried.
    EXPECT_TRUE(Until(
        [&]
        {
            writers.push_back(
                writing->CreateWriter(TextTopic("Text" + std::to_string(writers.size())), Telemetry(), {}));
            EXPECT_TRUE(Until([&] { return turns.IsDue() && turns.NextBytes() > 0; }));
            const std::size_t said = turns.NextBytes();
            const std::uint64_t before = writing->Counters().DiscoveryBytes;
            turns.SendNext();
            const std::uint64_t sent = writing->Counters().DiscoveryBytes - before;
            EXPECT_GE(sent, said / 2);
            return sent <= said * 2;
        }));
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
            const auto texts = there.Texts();
            return here.Count() >= 3 && std::find(texts.begin(), texts.end(), "all") != texts.end();
        }));
    EXPECT_THAT(here.Texts(), testing::Each("all"));
    EXPECT_THAT(there.Texts(), testing::Contains("one"));
}

TEST_P(Conformance, OneNodeCanBeWrittenToWhereEachReaderGetsItsOwn)
{
    ExpectThatOneNodeCanBeWrittenTo(false);
}

TEST_P(Conformance, OneNodeCanBeWrittenToWhereAllGetThemByMulticast)
{
    ExpectThatOneNodeCanBeWrittenTo(true);
}

void Conformance::ExpectThatALargeSampleCanBeHeld(bool multicast)
{
    const auto writing = OpenWith("uav1", multicast);
    const auto first = OpenWith("ground", multicast);
    const auto second = OpenWith("uav2", multicast);
    const auto writer = writing->CreateWriter(TextTopic(), State(), {});
    const auto beats = writing->CreateWriter(TextTopic("Beats"), Telemetry(), {});
    SampleRecorder here;
    SampleRecorder there;
    SampleRecorder beat;
    const auto reader = first->CreateReader(TextTopic(), Telemetry(), {}, here.Handler());
    const auto other = second->CreateReader(TextTopic(), Telemetry(), {}, there.Handler());
    const auto beatReader = second->CreateReader(TextTopic("Beats"), Telemetry(), {}, beat.Handler());
    ASSERT_TRUE(Until(
        [&]
        {
            return writer->MatchedReaders() == 2 && beats->MatchedReaders() == 1 &&
                   reader->MatchedWriters() == 1 && other->MatchedWriters() == 1 &&
                   beatReader->MatchedWriters() == 1;
        }));
    const std::string large(20'000, 'x');
    const auto writeHeld = [&](const SampleEncoder &sample)
    {
        WriteResult result = WriteResult::TimedOut;
        Until([&] { return (result = writer->WriteHeld(sample, 1)) != WriteResult::TimedOut; });
        return result;
    };
    const auto sentBytes = [&] { return writing->Counters().SampleBytes; };

    std::uint64_t before = sentBytes();
    ASSERT_EQ(writeHeld(MakeSample(0, large)), WriteResult::Ok);
    EXPECT_LE(sentBytes() - before, 2 * 1500u);
    // The bytes that keys add to a datagram are known once it is sent.
    const std::size_t unsure = 2 * Net().MostAdded();
    EXPECT_GT(sentBytes(), before);
    int parts = 1;
    for (std::size_t next = writer->HeldBytes(); next > 0; next = writer->HeldBytes(), ++parts)
    {
        EXPECT_LE(next, 2 * 1500u);
        EXPECT_EQ(std::min(here.Count(), there.Count()), 0u);
        before = sentBytes();
        writer->SendHeld();
        EXPECT_LE(sentBytes() - before, next + unsure);
        EXPECT_GE(sentBytes() - before + unsure, next);
        if (parts == 5)
        {
            EXPECT_TRUE(Until(
                [&]
                {
                    EXPECT_EQ(WriteOnceTaken(*beats, MakeSample(0, "beat"), 1), WriteResult::Ok);
                    return beat.Count() > 0;
                }));
            EXPECT_EQ(there.Count(), 0u);
        }
    }
    EXPECT_GE(parts, 15);
    EXPECT_TRUE(Until([&] { return here.Count() == 1 && there.Count() == 1; }));
    EXPECT_EQ(here.Texts(), std::vector<std::string>{large});
    EXPECT_EQ(there.Texts(), std::vector<std::string>{large});

    ASSERT_EQ(writeHeld(MakeSample(0, "small")), WriteResult::Ok);
    writer->SendHeld();  // where each reader gets its own, the second one is held
    EXPECT_EQ(writer->HeldBytes(), 0u);
    EXPECT_TRUE(Until([&] { return here.Count() == 2 && there.Count() == 2; }));

    // The next sample does not overtake the held one.
    ASSERT_EQ(writeHeld(MakeSample(0, large)), WriteResult::Ok);
    EXPECT_GT(writer->HeldBytes(), 0u);
    ASSERT_EQ(WriteOnceTaken(*writer, MakeSample(0, "next"), 2), WriteResult::Ok);
    EXPECT_EQ(writer->HeldBytes(), 0u);
    EXPECT_TRUE(Until([&] { return here.Count() == 4 && there.Count() == 4; }));
    EXPECT_EQ(here.Texts(), (std::vector<std::string>{large, "small", large, "next"}));
    writer->SendHeld();  // nothing
}

TEST_P(Conformance, ALargeSampleCanBeHeldWhereEachReaderGetsItsOwn)
{
    ExpectThatALargeSampleCanBeHeld(false);
}

TEST_P(Conformance, ALargeSampleCanBeHeldWhereAllGetItByMulticast)
{
    ExpectThatALargeSampleCanBeHeld(true);
}

TEST_P(Conformance, AWriterMayEndWithASampleThatIsHeld)
{
    const auto writing = Open("uav1");
    const auto reading = Open("ground");
    auto writer = writing->CreateWriter(TextTopic(), State(), {});
    SampleRecorder recorder;
    const auto reader = reading->CreateReader(TextTopic(), Telemetry(), {}, recorder.Handler());
    ASSERT_TRUE(Matched(writer, reader));
    writer->WriteHeld(MakeSample(0, std::string(20'000, 'x')), 1);
    writer.reset();
    // Samples of the next writer go behind all datagrams of the first one, to the same reader.
    const auto next = writing->CreateWriter(TextTopic(), State(), {});
    ASSERT_TRUE(Until(
        [&]
        {
            EXPECT_EQ(WriteOnceTaken(*next, MakeSample(0, "fence"), 1), WriteResult::Ok);
            return recorder.Count() > 0;
        }));
    EXPECT_THAT(recorder.Texts(), testing::Each("fence"));
}

TEST_P(Conformance, AReliableOrKeyedWriterDoesNotWriteToOneNode)
{
    const auto session = Open("uav1");
    const auto reliable = session->CreateWriter(TextTopic(), State(), {});
    const auto keyed = session->CreateWriter(KeyedTopic(), Telemetry(), {});
    EXPECT_EQ(reliable->WriteTo("ground", MakeSample(0, "x"), 1), WriteResult::Failed);
    EXPECT_EQ(keyed->WriteTo("ground", MakeSample(0, "x"), 1), WriteResult::Failed);
}

// The sessions are new, so that the counters of others stay as they are.
void Conformance::ExpectHeartbeatsAndAcknowledgements(bool multicast)
{
    constexpr int Acknowledgements = 5;
    const auto writing = OpenWith("uav3", multicast);
    const auto reading = OpenWith("uav4", multicast);
    const auto writer = writing->CreateWriter(TextTopic("Fence"), State(), {});
    SampleRecorder recorder;
    const auto reader = reading->CreateReader(TextTopic("Fence"), State(), {}, recorder.Handler());
    ASSERT_TRUE(Matched(writer, reader));
    // This session has nothing but acknowledgements to send.
    for (int i = 0; i < Acknowledgements; ++i)
    {
        const std::uint64_t before = reading->Counters().SampleDatagrams;
        ASSERT_EQ(WriteOnceTaken(*writer, MakeSample(0, "fence"), 1), WriteResult::Ok);
        ASSERT_TRUE(Until([&] { return reading->Counters().SampleDatagrams > before; }));
    }
}

void Conformance::ExpectNothingButSamplesForBestEffortReaders(bool multicast, int destinations)
{
    const auto writing = OpenWith("uav1", multicast);
    const auto first = OpenWith("ground", multicast);
    const auto second = OpenWith("uav2", multicast);
    const auto writer = writing->CreateWriter(TextTopic(), State(), {});
    SampleRecorder here;
    SampleRecorder there;
    const auto reader = first->CreateReader(TextTopic(), Telemetry(), {}, here.Handler());
    const auto other = second->CreateReader(TextTopic(), Telemetry(), {}, there.Handler());
    ASSERT_TRUE(Until(
        [&] {
            return writer->MatchedReaders() == 2 && reader->MatchedWriters() == 1 &&
                   other->MatchedWriters() == 1;
        }));
    EXPECT_EQ(writer->Destinations(), destinations);
    const std::uint64_t before = writing->Counters().SampleDatagrams;
    for (std::uint64_t i = 0; i < Samples; ++i)
    {
        ASSERT_EQ(WriteOnceTaken(*writer, MakeSample(0, "state"), 1), WriteResult::Ok);
    }
    EXPECT_TRUE(Until([&] { return here.Count() > 0 && there.Count() > 0; }));
    ExpectHeartbeatsAndAcknowledgements(multicast);
    EXPECT_EQ(writing->Counters().SampleDatagrams,
              before + Samples * static_cast<std::uint64_t>(destinations));
    EXPECT_EQ(first->Counters().SampleDatagrams, 0u);
    EXPECT_EQ(second->Counters().SampleDatagrams, 0u);
}

TEST_P(Conformance, BestEffortReadersOfAStateCostItsSamplesAndNoHeartbeatsOrAcknowledgements)
{
    ExpectNothingButSamplesForBestEffortReaders(true, 1);
}

TEST_P(Conformance, SoTheyDoWhereEachGetsItsOwn)
{
    ExpectNothingButSamplesForBestEffortReaders(false, 2);
}

TEST_P(Conformance, NothingWaitsForAcknowledgementsOfBestEffortReaders)
{
    const auto writing = Open("uav1");
    const auto reading = Open("ground");
    const auto writer = writing->CreateWriter(KeyedTopic(), State(), {});
    SampleRecorder recorder;
    const auto reader = reading->CreateReader(KeyedTopic(), Telemetry(), {}, recorder.Handler());
    ASSERT_TRUE(Matched(writer, reader));
    ASSERT_EQ(WriteOnceTaken(*writer, MakeSample(1, "gone"), 1), WriteResult::Ok);
    ASSERT_EQ(DisposeOnceTaken(*writer, MakeSample(1, "gone"), 2), WriteResult::Ok);
    ASSERT_EQ(WriteOnceTaken(*writer, MakeSample(2, "there"), 3), WriteResult::Ok);
    const auto late = Open("late");
    SampleRecorder history;
    const auto another = late->CreateReader(KeyedTopic(), State(), {}, history.Handler());
    ASSERT_EQ(WriteOnceTaken(*writer, MakeSample(3, "fence"), 4), WriteResult::Ok);
    ASSERT_TRUE(Until([&] { return history.Count() > 0 && history.All().back().Text == "fence"; }));
    EXPECT_THAT(history.Texts(), testing::ElementsAre("there", "fence"));
}

TEST_P(Conformance, ANodeWithoutAReaderOfTheTopicIsNotWrittenTo)
{
    const auto writing = Open("uav1");
    const auto reading = Open("ground");
    const auto idle = Open("uav2");
    const auto writer = writing->CreateWriter(TextTopic(), Telemetry(), {"fleet"});
    const auto elsewhere = writing->CreateWriter(TextTopic("Other"), Telemetry(), {"fleet"});
    SampleRecorder recorder;
    const auto reader = reading->CreateReader(TextTopic(), Telemetry(), {"fleet"}, recorder.Handler());
    const auto other = idle->CreateReader(TextTopic("Other"), Telemetry(), {"fleet"}, recorder.Handler());
    ASSERT_TRUE(Matched(writer, reader));
    ASSERT_TRUE(Matched(elsewhere, other));
    const std::uint64_t before = writing->Counters().SampleDatagrams;
    EXPECT_EQ(writer->WriteTo("uav2", MakeSample(0, "one"), 1), WriteResult::Ok);
    EXPECT_EQ(writing->Counters().SampleDatagrams, before);
}

TEST_P(Conformance, OneWriterWritesToManyNodesEachAloneWhileOneOfThemGoesAndReturns)
{
    const auto writing = Open("ground");
    const auto writer = writing->CreateWriter(TextTopic(), Telemetry(), {"fleet"});
    struct Node
    {
        SessionPtr Session;
        SampleRecorder Heard;
        ReaderPtr Reader;
    };
    std::array<Node, 4> nodes;
    const auto nameOf = [](std::size_t i) { return "uav" + std::to_string(i); };
    const auto join = [&](Node &node, std::size_t i, std::uint64_t incarnation)
    {
        node.Session = Open(nameOf(i), incarnation);
        node.Reader = node.Session->CreateReader(TextTopic(), Telemetry(), {"fleet"}, node.Heard.Handler());
    };
    const auto matched = [&](int count)
    {
        return Until(
            [&]
            {
                return writer->MatchedReaders() == count &&
                       std::all_of(nodes.begin(), nodes.end(),
                                   [](const Node &node)
                                   { return !node.Reader || node.Reader->MatchedWriters() == 1; });
            });
    };
    const auto reaches = [&](std::size_t i)
    {
        const std::uint64_t before = writing->Counters().SampleDatagrams;
        const std::size_t heard = nodes[i].Heard.Count();
        std::uint64_t written = 0;  // some may be lost
        EXPECT_TRUE(Until(
            [&]
            {
                written += writer->WriteTo(nameOf(i), MakeSample(0, nameOf(i)), 1) == WriteResult::Ok ? 1 : 0;
                return nodes[i].Heard.Count() > heard;
            }));
        EXPECT_EQ(writing->Counters().SampleDatagrams, before + written);
    };
    for (std::size_t i = 0; i < nodes.size(); ++i)
    {
        join(nodes[i], i, 1);
    }
    ASSERT_TRUE(matched(4));
    for (std::size_t i = 0; i < nodes.size(); ++i)
    {
        reaches(i);
    }
    nodes[2].Reader.reset();
    nodes[2].Session.reset();
    ASSERT_TRUE(matched(3));
    const std::uint64_t before = writing->Counters().SampleDatagrams;
    EXPECT_EQ(writer->WriteTo(nameOf(2), MakeSample(0, "nobody"), 1), WriteResult::Ok);
    EXPECT_EQ(writing->Counters().SampleDatagrams, before);
    reaches(1);
    join(nodes[2], 2, 2);
    ASSERT_TRUE(matched(4));
    reaches(2);
    reaches(3);
    for (std::size_t i = 0; i < nodes.size(); ++i)
    {
        EXPECT_THAT(nodes[i].Heard.Texts(), testing::Each(nameOf(i)));
    }
}

// The first session is the remains of a killed node until its lease runs out, or a live node of the same
// name.
TEST_P(Conformance, WhatIsWrittenToANodeGoesToItsNewestSessionAndToThoseHeardSinceThatAppeared)
{
    TransportSettings settings = Net().SettingsFor("ground", 1);
    settings.Multicast = false;
    settings.Peers = {"127.0.0.1"};
    // A former session that is silent for some of these periods is ended: longer than this test takes.
    settings.AnnouncementPeriod = std::chrono::seconds(40);
    settings.Lease = std::chrono::seconds(120);
    const auto writing = Net().Backend().Open(settings, {});
    const auto writer = writing->CreateWriter(TextTopic(), Telemetry(), {});
    SampleRecorder atGround;
    const auto hearing = writing->CreateReader(TextTopic("Voice"), Telemetry(), {}, atGround.Handler());
    const auto first = OpenWith("uav1", false, 12);
    SampleRecorder atFirst;
    const auto firstReader = first->CreateReader(TextTopic(), Telemetry(), {}, atFirst.Handler());
    const auto voice = first->CreateWriter(TextTopic("Voice"), Telemetry(), {});
    ASSERT_TRUE(Matched(writer, firstReader));
    ASSERT_TRUE(Matched(voice, hearing));
    // The second incarnation has the lower number, as if a clock was set back between the two.
    const auto second = OpenWith("uav1", false, 11);
    SampleRecorder atSecond;
    const auto secondReader = second->CreateReader(TextTopic(), Telemetry(), {}, atSecond.Handler());
    ASSERT_TRUE(Until([&] { return writer->MatchedReaders() == 2 && secondReader->MatchedWriters() == 1; }));
    const auto datagramsForOne = [&]
    {
        const std::uint64_t before = writing->Counters().SampleDatagrams;
        EXPECT_EQ(writer->WriteTo("uav1", MakeSample(0, "one"), 1), WriteResult::Ok);
        return writing->Counters().SampleDatagrams - before;
    };
    EXPECT_TRUE(Until(
        [&]
        {
            EXPECT_EQ(datagramsForOne(), 1u);
            return atSecond.Count() >= 3;
        }));
    EXPECT_EQ(atFirst.Count(), 0u);
    EXPECT_TRUE(Until(
        [&]
        {
            EXPECT_EQ(WriteOnceTaken(*voice, MakeSample(0, "I live"), 1), WriteResult::Ok);
            return atGround.Count() >= 1;
        }));
    EXPECT_TRUE(Until(
        [&]
        {
            EXPECT_EQ(datagramsForOne(), 2u);
            return atFirst.Count() >= 3;
        }));
}

}  // namespace Rabit::Conformance
