// Writers, readers and peers of a session that joins its networks anew.
#include <thread>

#include "RejoiningFixture.h"

namespace RejoiningTests
{

using testing::ElementsAre;
using testing::IsEmpty;

TEST_F(RejoiningSessionTest, RefusesImpossibleTopicsAlsoWhileItWaits)
{
    _networks = {};
    const auto session = Open();
    const auto writer = session->CreateWriter(_pose, {}, {});
    EXPECT_THROW(session->CreateWriter({"Pose", "Uav::Goto", {}}, {}, {}), TransportError);
    EXPECT_THROW(session->CreateReader({"", "Uav::Goto", {}}, {}, {}, {}), TransportError);
    TopicQos deep;
    deep.Depth = 0;
    EXPECT_THROW(session->CreateReader(_pose, deep, {}, {}), TransportError);
}

TEST_F(RejoiningSessionTest, OpensAllWritersAndReadersAnewForANetworkThatComes)
{
    const auto session = Open();
    const auto writer = session->CreateWriter(_pose, {}, {});
    const auto reader = session->CreateReader(_pose, {}, {}, {});
    session->CreateWriter({"Gone", "Uav::Pose", {}}, {}, {});
    _networks = {Wired, Radio};
    Follow(*session);
    ASSERT_EQ(_script.Opened.size(), 2u);
    EXPECT_THAT(_script.Opened[1].Interfaces, ElementsAre("10.0.0.1", "10.1.0.1"));
    EXPECT_THAT(_script.Writers, ElementsAre("Pose"));
    EXPECT_THAT(_script.Readers, ElementsAre("Pose"));
    EXPECT_EQ(writer->Write(Sample(), 1), WriteResult::Ok);
}

TEST_F(RejoiningSessionTest, LosesEachPeerAsOftenAsItAppeared)
{
    const auto session = Open();
    _script.OnPeer({PeerEvent::Kind::Appeared, "ground", 1});
    _script.OnPeer({PeerEvent::Kind::Appeared, "ground", 1});
    _script.OnPeer({PeerEvent::Kind::Appeared, "uav2", 7});
    _script.OnPeer({PeerEvent::Kind::Left, "uav2", 7});
    _events.clear();
    _networks = {Wired, Radio};
    Follow(*session);
    ASSERT_EQ(_events.size(), 2u);
    for (const PeerEvent &event : _events)
    {
        EXPECT_EQ(event.What, PeerEvent::Kind::Lost);
        EXPECT_EQ(event.Node, "ground");
    }
}

TEST_F(RejoiningSessionTest, KnowsNoTopicOfOthersThatItHasNotFoundAnew)
{
    const auto session = Open();
    _script.Topics->RemoteAppeared({.IsWriter = true, .Topic = "Pose", .Type = "Uav::Pose"});
    EXPECT_THAT(session->RemoteTopics(), ElementsAre("Pose"));
    EXPECT_EQ(session->RemoteEndpointsOn("Pose").size(), 1u);
    _networks = {Wired, Radio};
    Follow(*session);
    EXPECT_THAT(session->RemoteTopics(), IsEmpty());
}

TEST_F(RejoiningSessionTest, CountersNeverFallAndAreReadWhileTheNetworkIsJoined)
{
    const auto session = Open();
    EXPECT_EQ(session->Counters().SamplesLost, 5u);
    std::uint64_t meanwhile = 0;
    _script.InOpen = [&] { std::jthread([&] { meanwhile = session->Counters().SamplesLost; }); };
    _networks = {Wired, Radio};
    Follow(*session);
    EXPECT_EQ(meanwhile, 5u);
    EXPECT_EQ(session->Counters().SamplesLost, 10u);
}

TEST_F(RejoiningSessionTest, NobodyWaitsInWriteWhileTheNetworkIsJoined)
{
    const auto session = Open();
    const auto writer = session->CreateWriter(_pose, {}, {});
    const auto reader = session->CreateReader(_pose, {}, {}, {});
    std::vector<WriteResult> results;
    // Writes on a thread of its own, as the gateway does. If Write waited, the thread could not end before
    // the network is joined.
    _script.InOpen = [&]
    {
        std::jthread(
            [&]
            {
                for (int i = 0; i < 100; ++i)
                {
                    results.push_back(writer->Write(Sample(), 1));
                }
                EXPECT_EQ(writer->MatchedReaders(), 0);
                EXPECT_EQ(reader->MatchedWriters(), 0);
            });
    };
    _networks = {Wired, Radio};
    Follow(*session);
    EXPECT_THAT(results, testing::SizeIs(100));
    EXPECT_THAT(results, testing::Each(WriteResult::TimedOut));
}

TEST_F(RejoiningSessionTest, AWriteUnderWayEndsBeforeItsWriterIsClosed)
{
    const auto session = Open();
    const auto writer = session->CreateWriter(_pose, {}, {});
    _script.Blocks = true;
    WriteResult result = WriteResult::Failed;
    std::jthread writing([&] { result = writer->Write(Sample(), 1); });
    while (!_script.IsWriting)
    {
        std::this_thread::yield();
    }
    _networks = {Wired, Radio};
    std::jthread following([&] { Follow(*session); });
    while (writer->MatchedReaders() != 0)  // turned away: the session wants to join
    {
        std::this_thread::yield();
    }
    EXPECT_THAT(_script.Writers, ElementsAre("Pose"));
    _script.Blocks = false;
    _script.Blocks.notify_all();
    following.join();
    writing.join();
    EXPECT_EQ(result, WriteResult::Ok);
    EXPECT_EQ(_script.Opened.size(), 2u);
}

TEST_F(RejoiningSessionTest, AnEndpointThatCannotBeMadeAnewClosesTheOthersUntilItCan)
{
    const auto session = Open();
    const auto first = session->CreateWriter(_pose, {}, {});
    const auto second = session->CreateWriter({"Goto", "Uav::Goto", {}}, {}, {});
    _script.RefusedTopic = "Goto";
    _networks = {Wired, Radio};
    for (int i = 0; i < 4; ++i)
    {
        _now += session->Look().value_or(0ms);
    }
    EXPECT_FALSE(_script.IsOpen);
    EXPECT_EQ(first->Write(Sample(), 1), WriteResult::TimedOut);
    _script.RefusedTopic.clear();
    Follow(*session);
    EXPECT_THAT(_script.Writers, ElementsAre("Pose", "Goto"));
}

}  // namespace RejoiningTests
