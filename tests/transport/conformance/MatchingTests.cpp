// Which writers and readers find each other.
#include "ConformanceTest.h"

namespace Rabit::Conformance
{

using testing::ElementsAre;
using testing::IsEmpty;

// Endpoints of one session become known in the order in which they were made: when the last of several is
// matched, the fate of those before it is decided.
TEST_P(Conformance, PartitionsDecideWhichReadersGetASample)
{
    const auto writing = Open("uav1");
    const auto reading = Open("ground");
    struct Case
    {
        std::vector<std::string> Partitions;
        bool Matches;
    };
    const std::vector<Case> cases = {{{"uav2"}, false}, {{"uav11"}, false},       {{"?av2"}, false},
                                     {{"uav"}, false},  {{"uav2*"}, false},       {{}, true},
                                     {{""}, true},      {{"uav1"}, true},         {{"uav*"}, true},
                                     {{"?av1"}, true},  {{"uav2", "uav1"}, true}, {{"*"}, true}};
    std::vector<std::unique_ptr<SampleRecorder>> recorders;
    std::vector<ReaderPtr> readers;
    int matching = 0;
    for (const auto &one : cases)
    {
        recorders.push_back(std::make_unique<SampleRecorder>());
        readers.push_back(
            reading->CreateReader(TextTopic(), State(), one.Partitions, recorders.back()->Handler()));
        matching += one.Matches ? 1 : 0;
    }
    const auto writer = writing->CreateWriter(TextTopic(), State(), {"", "uav1"});
    ASSERT_TRUE(
        Until([&] { return writer->MatchedReaders() == matching && readers.back()->MatchedWriters() == 1; }));
    ASSERT_EQ(WriteOnceTaken(*writer, MakeSample(0, "here"), 1), WriteResult::Ok);
    for (std::size_t i = 0; i < cases.size(); ++i)
    {
        if (cases[i].Matches)
        {
            EXPECT_TRUE(Until([&] { return recorders[i]->Count() == 1; })) << "case " << i;
        }
    }
    for (std::size_t i = 0; i < cases.size(); ++i)
    {
        EXPECT_EQ(readers[i]->MatchedWriters(), cases[i].Matches ? 1 : 0) << "case " << i;
        EXPECT_EQ(recorders[i]->Count(), cases[i].Matches ? 1u : 0u) << "case " << i;
    }
}

TEST_P(Conformance, ABestEffortReaderGetsNothingFromAnotherPartition)
{
    const auto writing = Open("uav1");
    const auto reading = Open("ground");
    SampleRecorder elsewhere;
    SampleRecorder here;
    const auto other = reading->CreateReader(TextTopic(), Telemetry(), {"uav2"}, elsewhere.Handler());
    const auto reader = reading->CreateReader(TextTopic(), Telemetry(), {"uav1"}, here.Handler());
    const auto writer = writing->CreateWriter(TextTopic(), Telemetry(), {"uav1"});
    ASSERT_TRUE(Matched(writer, reader));
    EXPECT_TRUE(Until(
        [&]
        {
            EXPECT_EQ(WriteOnceTaken(*writer, MakeSample(0, "fix"), 1), WriteResult::Ok);
            return here.Count() >= 3;
        }));
    EXPECT_EQ(elsewhere.Count(), 0u);
}

TEST_P(Conformance, AWriterInOnePartitionIsNotHeardInTheDefaultOne)
{
    const auto writing = Open("uav1");
    const auto reading = Open("ground");
    SampleRecorder recorder;
    const auto outside = reading->CreateReader(TextTopic(), State(), {}, recorder.Handler());
    const auto inside = reading->CreateReader(TextTopic(), State(), {"ground"}, recorder.Handler());
    const auto writer = writing->CreateWriter(TextTopic(), State(), {"ground"});
    ASSERT_TRUE(Matched(writer, inside));
    EXPECT_EQ(outside->MatchedWriters(), 0);
    // Partitions that differ are no fault (OMG DDS 1.4, 2.2.3.13).
    EXPECT_EQ(writing->Counters().IncompatibleQos, 0u);
    EXPECT_EQ(reading->Counters().IncompatibleQos, 0u);
}

TEST_P(Conformance, OtherTopicsAreNotHeard)
{
    const auto writing = Open("uav1");
    const auto reading = Open("ground");
    SampleRecorder others;
    SampleRecorder recorder;
    const auto other = reading->CreateReader(TextTopic("Text2"), State(), {}, others.Handler());
    const auto reader = reading->CreateReader(TextTopic(), State(), {}, recorder.Handler());
    const auto writer = writing->CreateWriter(TextTopic(), State(), {});
    ASSERT_TRUE(Matched(writer, reader));
    ASSERT_EQ(WriteOnceTaken(*writer, MakeSample(0, "here"), 1), WriteResult::Ok);
    ASSERT_TRUE(Until([&] { return recorder.Count() == 1; }));
    EXPECT_EQ(others.Count(), 0u);
}

TEST_P(Conformance, AnotherTypeOnTheTopicIsNotMatchedAndIsCountedOnBothSides)
{
    const auto writing = Open("uav1");
    const auto reading = Open("ground");
    SampleRecorder recorder;
    TopicDescription other = TextTopic();
    other.TypeName = "Test::OtherText";
    const auto reader = reading->CreateReader(other, State(), {}, recorder.Handler());
    const auto writer = writing->CreateWriter(TextTopic(), State(), {});
    EXPECT_TRUE(Until([&] { return writing->Counters().InconsistentTypes >= 1; }));
    EXPECT_TRUE(Until([&] { return reading->Counters().InconsistentTypes >= 1; }));
    EXPECT_EQ(writer->MatchedReaders(), 0);
    EXPECT_EQ(reader->MatchedWriters(), 0);
}

TEST_P(Conformance, TheReportOfAnotherTypeNamesBothSides)
{
    LineRecorder atUav;
    LineRecorder atGround;
    const auto writing = Open("uav1", 1, {}, atUav.Sink());
    const auto reading = Open("ground", 1, {}, atGround.Sink());
    SampleRecorder recorder;
    TopicDescription other = TextTopic();
    other.TypeName = "Test::OtherText";
    const auto reader = reading->CreateReader(other, State(), {}, recorder.Handler());
    const auto writer = writing->CreateWriter(TextTopic(), State(), {});
    EXPECT_TRUE(Until(
        [&] {
            return atUav.Has({"uav1", "ground", "Text", "Test::Text", "Test::OtherText"});
        }));
    EXPECT_TRUE(Until(
        [&] {
            return atGround.Has({"uav1", "ground", "Text", "Test::Text", "Test::OtherText"});
        }));
}

TEST_P(Conformance, TellsOfTheEndpointsThatOthersHaveWhateverTheirTypeAndQos)
{
    const auto writing = Open("uav1");
    const auto reading = Open("ground");
    auto writer = writing->CreateWriter(TextTopic(), State(), {"", "uav1"});
    TopicDescription other = TextTopic();
    other.Name = "Other";
    other.TypeName = "Other::Type";
    const auto reader = writing->CreateReader(other, Telemetry(), {}, [](SampleBytes, const SampleInfo &) {});
    ASSERT_TRUE(Until(
        [&]
        {
            return reading->RemoteEndpointsOn(TextTopic().Name).size() == 1 &&
                   reading->RemoteEndpointsOn("Other").size() == 1;
        }));
    const RemoteEndpoint written = reading->RemoteEndpointsOn(TextTopic().Name).front();
    EXPECT_TRUE(written.IsWriter);
    EXPECT_EQ(written.Type, TextTopic().TypeName);
    EXPECT_EQ(written.Node, "uav1");
    EXPECT_EQ(written.Reliability, Reliability::Reliable);
    EXPECT_EQ(written.Durability, Durability::TransientLocal);
    EXPECT_THAT(written.Partitions, testing::ElementsAre("", "uav1"));
    const RemoteEndpoint read = reading->RemoteEndpointsOn("Other").front();
    EXPECT_FALSE(read.IsWriter);
    EXPECT_EQ(read.Type, "Other::Type");
    EXPECT_EQ(read.Reliability, Reliability::BestEffort);
    EXPECT_EQ(read.Durability, Durability::Volatile);
    for (const RemoteEndpoint &endpoint : {written, read})
    {
        EXPECT_FALSE(endpoint.HasDeadline || endpoint.HasLiveliness || endpoint.IsExclusive);
    }
    EXPECT_THAT(reading->RemoteTopics(), testing::IsSupersetOf({TextTopic().Name, std::string("Other")}));
    writer.reset();
    EXPECT_TRUE(Until([&] { return reading->RemoteEndpointsOn(TextTopic().Name).empty(); }));
    EXPECT_THAT(writing->RemoteEndpointsOn("Other"), IsEmpty());  // its own
}

TEST_P(Conformance, OneSessionCannotOpenATopicWithTwoTypes)
{
    const auto session = Open("uav1");
    TopicDescription other = TextTopic();
    other.TypeName = "Test::OtherText";
    {
        const auto writer = session->CreateWriter(TextTopic(), State(), {});
        EXPECT_THROW(session->CreateWriter(other, State(), {}), TransportError);
        EXPECT_THROW(session->CreateReader(other, State(), {}, [](SampleBytes, const SampleInfo &) {}),
                     TransportError);
    }
    EXPECT_NO_THROW(session->CreateWriter(other, State(), {}));
}

TEST_P(Conformance, AReliableReaderDoesNotMatchABestEffortWriter)
{
    const auto writing = Open("uav1");
    const auto reading = Open("ground");
    SampleRecorder recorder;
    const auto reader = reading->CreateReader(TextTopic(), Stream(1), {}, recorder.Handler());
    const auto writer = writing->CreateWriter(TextTopic(), Telemetry(), {});
    EXPECT_TRUE(Until([&] { return writing->Counters().IncompatibleQos >= 1; }));
    EXPECT_TRUE(Until([&] { return reading->Counters().IncompatibleQos >= 1; }));
    EXPECT_EQ(writer->MatchedReaders(), 0);
    EXPECT_EQ(reader->MatchedWriters(), 0);
}

TEST_P(Conformance, ATransientLocalReaderDoesNotMatchAVolatileWriter)
{
    const auto writing = Open("uav1");
    const auto reading = Open("ground");
    SampleRecorder recorder;
    const auto reader = reading->CreateReader(TextTopic(), State(), {}, recorder.Handler());
    const auto writer = writing->CreateWriter(TextTopic(), Stream(1), {});
    EXPECT_TRUE(Until([&] { return writing->Counters().IncompatibleQos >= 1; }));
    EXPECT_TRUE(Until([&] { return reading->Counters().IncompatibleQos >= 1; }));
    EXPECT_EQ(writer->MatchedReaders(), 0);
    EXPECT_EQ(reader->MatchedWriters(), 0);
}

TEST_P(Conformance, ALesserReaderMatchesAStateWriter)
{
    const auto writing = Open("uav1");
    const auto reading = Open("ground");
    SampleRecorder recorder;
    const auto reader = reading->CreateReader(TextTopic(), Telemetry(), {}, recorder.Handler());
    const auto writer = writing->CreateWriter(TextTopic(), State(), {});
    ASSERT_TRUE(Matched(writer, reader));
    EXPECT_TRUE(Until(
        [&]
        {
            EXPECT_EQ(WriteOnceTaken(*writer, MakeSample(0, "mode"), 1), WriteResult::Ok);
            return recorder.Count() >= 1;
        }));
}

TEST_P(Conformance, MatchesEndWhenAnEndpointIsClosed)
{
    const auto writing = Open("uav1");
    const auto reading = Open("ground");
    SampleRecorder recorder;
    auto reader = reading->CreateReader(TextTopic(), State(), {}, recorder.Handler());
    auto writer = writing->CreateWriter(TextTopic(), State(), {});
    ASSERT_TRUE(Matched(writer, reader));
    reader.reset();
    EXPECT_TRUE(Until([&] { return writer->MatchedReaders() == 0; }));
    reader = reading->CreateReader(TextTopic(), State(), {}, recorder.Handler());
    ASSERT_TRUE(Matched(writer, reader));
    writer.reset();
    EXPECT_TRUE(Until([&] { return reader->MatchedWriters() == 0; }));
}

TEST_P(Conformance, TheOwnSessionIsNeitherMatchedNorHeard)
{
    const auto both = Open("uav1");
    const auto reading = Open("ground");
    SampleRecorder own;
    SampleRecorder others;
    const auto ownBefore = both->CreateReader(TextTopic(), State(), {}, own.Handler());
    const auto writer = both->CreateWriter(TextTopic(), State(), {});
    const auto ownAfter = both->CreateReader(TextTopic(), State(), {}, own.Handler());
    const auto reader = reading->CreateReader(TextTopic(), State(), {}, others.Handler());
    ASSERT_TRUE(Matched(writer, reader));
    ASSERT_EQ(WriteOnceTaken(*writer, MakeSample(0, "hello"), 1), WriteResult::Ok);
    ASSERT_TRUE(Until([&] { return others.Count() == 1; }));
    // The other session's answer comes behind everything that the own session hears of itself.
    const auto answering = reading->CreateWriter(TextTopic(), State(), {});
    ASSERT_EQ(WriteOnceTaken(*answering, MakeSample(0, "answer"), 1), WriteResult::Ok);
    ASSERT_TRUE(Until([&] { return own.Count() >= 2; }));
    EXPECT_THAT(own.Texts(), ElementsAre("answer", "answer"));
    EXPECT_THAT(others.Texts(), ElementsAre("hello"));
    EXPECT_EQ(writer->MatchedReaders(), 1);
    EXPECT_EQ(ownBefore->MatchedWriters(), 1);
    EXPECT_EQ(ownAfter->MatchedWriters(), 1);
}

TEST_P(Conformance, ImpossibleSettingsAreRefused)
{
    TransportSettings settings = Net().SettingsFor("uav1", 1);
    settings.Node.clear();
    EXPECT_THROW(Net().Backend().Open(settings, {}), TransportError);
    settings = Net().SettingsFor("uav1", 1);
    settings.Domain = 300;
    EXPECT_THROW(Net().Backend().Open(settings, {}), TransportError);
    const auto session = Open("uav1");
    EXPECT_THROW(session->CreateWriter(TextTopic(), State(0), {}), TransportError);
    EXPECT_THROW(session->CreateWriter(TextTopic(""), State(), {}), TransportError);
}

}  // namespace Rabit::Conformance
