// Sessions that come and go.
#include "ConformanceTest.h"

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
    Net().Settle();
    EXPECT_EQ(atUav.CountAll(), 1u);
    EXPECT_EQ(atGround.CountAll(), 1u);
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
    const auto ground = Open("ground", 1, atGround.Handler());
    const auto reader = ground->CreateReader(KeyedTopic(), State(), {}, recorder.Handler());
    const auto remote = Net().StartRemote("uav9", 99);
    ASSERT_TRUE(Until([&] { return atGround.Count(Kind::Appeared, "uav9", 99) == 1; }));
    ASSERT_TRUE(Until([&] { return recorder.Count() == 1; }));
    EXPECT_EQ(recorder.All()[0].Text, "remote");
    EXPECT_EQ(recorder.All()[0].Node, "uav9");
    EXPECT_EQ(recorder.All()[0].Incarnation, 99u);
    remote->Kill();
    ASSERT_TRUE(Until([&] { return atGround.Count(Kind::Lost, "uav9", 99) == 1; }));
    EXPECT_EQ(atGround.Count(Kind::Left, "uav9", 99), 0);
    ASSERT_TRUE(Until([&] { return recorder.Count() == 2; }));
    EXPECT_FALSE(recorder.All()[1].Alive);
    EXPECT_EQ(recorder.All()[1].Key, HashOf(7));
    EXPECT_TRUE(Until([&] { return reader->MatchedWriters() == 0; }));
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
        ASSERT_EQ(writer->Write(MakeSample(0, std::to_string(life)), 1), WriteResult::Ok);
        ASSERT_TRUE(Until([&] { return recorder.Count() >= 1; })) << "life " << life;
        EXPECT_EQ(recorder.All()[0].Incarnation, life);
        EXPECT_EQ(recorder.All()[0].Text, std::to_string(life));
    }
}

}  // namespace Rabit::Conformance
