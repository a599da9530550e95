// A node forgets others without breaking a promise. Node `a` is under test, `b` is played.
#include <gmock/gmock.h>

#include "NodeUnderTest.h"

namespace Rabit::Test
{
namespace
{

using testing::IsEmpty;
using testing::SizeIs;

LinkSettings ForTwo()
{
    LinkSettings settings;
    settings.MaxPeers = 2;
    return settings;
}

StoredFrame HelloOf(const std::string &node, PlayedPeer &peer)
{
    StoredFrame hello = peer.Hello();
    hello.Source = node;
    return hello;
}

TEST(LinkForgetting, ACrowdOfNamesWithoutLinksMakesRoomForEachNextOne)
{
    NodeUnderTest a(ForTwo());
    PlayedPeer peer;
    for (int i = 0; i < 100; ++i)
    {
        a.Hear(HelloOf(std::string("n").append(std::to_string(i)), peer));
        a.Pass(1ms);
    }
    EXPECT_EQ(a.Node->Counters().TooManyPeers, 0U);
    EXPECT_EQ(a.Node->Counters().Forgotten, 98U);
    EXPECT_NE(a.Enqueue("m"), 0U);
}

TEST(LinkForgetting, APeerForWhichMessagesWaitIsKept)
{
    NodeUnderTest a(ForTwo());
    a.Enqueue("m", "b");
    a.Enqueue("m", "c");
    a.Pass(1h);
    EXPECT_FALSE(a.Node->Forget("b"));
    EXPECT_TRUE(a.Node->HasPending("b"));
    EXPECT_EQ(a.Node->Enqueue("d", "q", "T", {}, a.Now).Refusal, LinkRefusal::TooManyPeers);
    EXPECT_EQ(a.SenderCounters().Pending, 1U);
}

TEST(LinkForgetting, ALivePeerWithLinksIsKeptAndASilentOneMakesRoom)
{
    NodeUnderTest a(ForTwo());
    PlayedPeer b;
    a.Configure({}, "c");
    a.Hear(b.Data(1, {"m"}, a.Now));
    a.Pass(9s);
    a.Hear(b.Hello());
    EXPECT_EQ(a.Node->Enqueue("d", "q", "T", {}, a.Now).Refusal, LinkRefusal::TooManyPeers);
    a.Pass(2s);
    EXPECT_EQ(a.Node->Enqueue("d", "q", "T", {}, a.Now).Refusal, LinkRefusal::None);
    EXPECT_THAT(a.ReceiverCounters().SessionsOpened, 1U) << "b was heard 2 s ago";
}

TEST(LinkForgetting, WhatWasDeliveredBeforeIsNotDeliveredAgainWhenTheSenderComesBack)
{
    NodeUnderTest a;
    PlayedPeer b;
    a.Hear(b.Data(1, {"m"}, a.Now));
    ASSERT_THAT(a.TakeDelivered(), SizeIs(1));
    a.Pass(60s);
    ASSERT_TRUE(a.Node->Forget("b"));
    // The acknowledgement was lost: the peer retransmits the message, with a fresh token.
    a.Hear(b.Data(1, {"m"}, a.Now));
    a.Pass(5ms);
    EXPECT_THAT(a.TakeDelivered(), IsEmpty());
    const std::vector<StoredFrame> hellos = a.TakeHellos();
    ASSERT_FALSE(hellos.empty());
    EXPECT_GT(hellos.back().Fields.SenderLife, b.KnownLife) << "the sender must take it for a restart";
}

TEST(LinkForgetting, TheSenderGoesOnOnceItKnows)
{
    NodeUnderTest a;
    PlayedPeer b;
    a.Hear(b.Data(1, {"m1", "m2"}, a.Now));
    a.Pass(60s);
    ASSERT_TRUE(a.Node->Forget("b"));
    a.TakeDelivered();
    b.KnownLife = a.Node->IncarnationTo("b");
    StoredFrame data = b.Data(3, {"m3"}, a.Now);
    data.Fields.Data.Oldest = 3;
    a.Hear(data);
    EXPECT_THAT(a.TakeDelivered(), SizeIs(1));
}

TEST(LinkForgetting, TheNextStreamToAForgottenPeerOutranksTheLastOne)
{
    NodeUnderTest a;
    PlayedPeer b;
    a.Hear(b.Hello());
    a.Enqueue("m");
    a.Pass(1ms);
    const std::vector<StoredFrame> first = a.TakeDatas();
    ASSERT_THAT(first, SizeIs(1));
    a.Hear(b.Ack(1));
    ASSERT_TRUE(a.Node->Forget("b"));
    a.Hear(b.Hello());
    a.Enqueue("n");
    a.Pass(30ms);
    const std::vector<StoredFrame> second = a.TakeDatas();
    ASSERT_THAT(second, SizeIs(1));
    EXPECT_GT(second[0].Fields.SenderLife, first[0].Fields.SenderLife);
}

TEST(LinkForgetting, OtherPeersSeeNothingOfIt)
{
    NodeUnderTest a;
    PlayedPeer b;
    a.Configure({}, "c");
    a.Hear(b.Data(1, {"m1"}, a.Now));
    ASSERT_TRUE(a.Node->Forget("c"));
    a.Hear(b.Data(2, {"m2"}, a.Now));
    EXPECT_THAT(a.TakeDelivered(), SizeIs(2));
    EXPECT_EQ(a.Node->IncarnationTo("b"), NodeUnderTest::FirstLife);
    EXPECT_GT(a.Node->IncarnationTo("c"), NodeUnderTest::FirstLife);
}

TEST(LinkForgetting, APeerThatRemembersMoreThanThisNodeToldItStillMakesItRaise)
{
    NodeUnderTest a;
    PlayedPeer b;
    a.Hear(b.Hello());
    a.Configure({}, "c");
    ASSERT_TRUE(a.Node->Forget("c"));
    ASSERT_GT(a.Node->Incarnation(), a.Node->IncarnationTo("b"));
    b.KnownLife = a.Node->Incarnation();
    a.Hear(b.Hello());
    EXPECT_EQ(a.Node->Counters().Raises, 1U);
    EXPECT_GT(a.Node->IncarnationTo("b"), b.KnownLife);
}

}  // namespace
}  // namespace Rabit::Test
