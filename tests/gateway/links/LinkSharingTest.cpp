// Resources that links share at a receiver: room in a queue, memory, and datagrams.
#include "NodeUnderTest.h"

#include <rabit/gateway/links/LinkFrameCodec.h>

#include <gmock/gmock.h>

namespace Rabit::Test
{
namespace
{

using testing::Contains;
using testing::Each;
using testing::ElementsAre;
using testing::IsEmpty;
using testing::Le;

class LinkSharing : public testing::Test
{
protected:
    StoredFrame From(const std::string &source, std::uint64_t first, const std::vector<std::string> &texts)
    {
        StoredFrame frame = b.Data(first, texts, a.Now);
        frame.Source = source;
        return frame;
    }
    // Puts the frame on link `link`, into a queue of its own.
    StoredFrame On(std::uint32_t link, StoredFrame frame)
    {
        frame.Queue = "q" + std::to_string(link);
        frame.Fields.Data.Link = link;
        return frame;
    }
    std::vector<std::string> Texts()
    {
        std::vector<std::string> texts;
        for (const DeliveredMessage &message : a.TakeDelivered())
        {
            texts.push_back(message.Text);
        }
        return texts;
    }

    NodeUnderTest a;
    PlayedPeer b;
};

// Room

TEST_F(LinkSharing, OfAFullQueueServesTheSendersInTurn)
{
    a.Places = 0;
    for (const std::string name : {"b", "m", "z"})
    {
        a.Hear(From(name, 1, {name + "1", name + "2", name + "3"}));
    }
    for (int i = 0; i < 4; ++i)
    {
        a.Places = 1;
        a.Node->OnRoom("q");
        a.Pass(1ms);
    }
    EXPECT_THAT(Texts(), ElementsAre("b1", "m1", "z1", "b2"));
    a.Places = 5;
    a.Node->OnRoom("q");
    a.Pass(1ms);
    EXPECT_THAT(Texts(), ElementsAre("m2", "z2", "b3", "m3", "z3"));
}

TEST_F(LinkSharing, OfTheRoomOfAQueueTellsEachWaitingSenderItsShare)
{
    a.Places = 0;
    a.RoomLeft = 0;
    for (const std::string name : {"b", "m", "z"})
    {
        a.Hear(From(name, 1, {"1"}));
    }
    a.Pass(1ms);
    for (const StoredFrame &frame : a.TakeAcks())
    {
        EXPECT_EQ(frame.Ack().Credit, 1U) << "one message may wait for its turn";
    }
    a.Places = 30;
    a.RoomLeft = 27;
    a.Node->OnRoom("q");
    a.Live(10ms);
    const auto acks = a.TakeAcks();
    EXPECT_EQ(acks.size(), 3U);
    for (const StoredFrame &frame : acks)
    {
        EXPECT_EQ(frame.Ack().Credit, 9U);
    }
}

TEST_F(LinkSharing, OfAFullQueuePassesOverSendersThatHaveNothing)
{
    a.Places = 0;
    a.Hear(From("b", 1, {"b1", "b2"}));
    a.Hear(From("m", 1, {"m1"}));
    a.Places = 3;
    a.Node->OnRoom("q");
    a.Pass(1ms);
    EXPECT_THAT(Texts(), ElementsAre("b1", "m1", "b2"));
}

// Memory

LinkSettings LittleMemory()
{
    LinkSettings settings;
    settings.AssemblyBytesOfNode = 10;
    return settings;
}

// The first of two parts; 12 bytes are reserved for the message.
StoredFrame FirstHalf(PlayedPeer &b, std::uint64_t first, LinkTime now)
{
    StoredFrame frame = b.Parts(first, {"abcdef", "ghijkl"}, now);
    frame.Items.pop_back();
    return frame;
}

TEST_F(LinkSharing, OfMemoryDoesNotBarALinkWhoseMessageExpiredForWantOfIt)
{
    NodeUnderTest node(LittleMemory());
    node.Hear(On(1, FirstHalf(b, 1, node.Now)));
    node.Hear(On(2, FirstHalf(b, 1, node.Now)));
    ASSERT_EQ(node.ReceiverCounters("b", "q2").HeldBackMemory, 1U);
    StoredFrame skip = On(2, b.Data(1, {""}, node.Now));
    MakeSkip(skip.Items[0], 1, 2);
    node.Hear(skip);
    node.Hear(On(2, b.Data(4, {"4"}, node.Now)));
    EXPECT_EQ(node.ReceiverCounters("b", "q2").Kept, 1U);
    node.Pass(300ms);
    EXPECT_GT(node.TakeAcks().back().Fields.Acks.back().Credit, 0U);
    node.Hear(On(2, b.Data(3, {"3"}, node.Now)));
    EXPECT_EQ(node.TakeDelivered().size(), 2U);
}

TEST_F(LinkSharing, OfMemoryTakesItBackWhenTheLifeOfTheSourceIsOver)
{
    a.Hear(On(1, FirstHalf(b, 1, a.Now)));
    a.Hear(On(2, b.Data(1, {"1"}, a.Now)));
    a.Hear(On(2, b.Data(3, {"3"}, a.Now)));
    ASSERT_GT(a.ReceiverCounters("b", "q1").AssemblyBytes, 0U);
    ASSERT_GT(a.ReceiverCounters("b", "q2").KeptBytes, 0U);
    b.Life += 1ULL << 32;
    a.Hear(b.Hello());
    EXPECT_EQ(a.ReceiverCounters("b", "q1").AssemblyBytes, 0U);
    EXPECT_EQ(a.ReceiverCounters("b", "q2").KeptBytes, 0U);
}

TEST_F(LinkSharing, OfMemoryKeepsWhatIsCompleteWhenTheLifeOfTheSourceIsOver)
{
    a.Places = 0;
    a.Hear(b.Parts(1, {"abcdef", "ghijkl"}, a.Now));
    b.Life += 1ULL << 32;
    a.Hear(b.Hello());
    a.Places = 1;
    a.Node->OnRoom("q");
    a.Pass(1ms);
    EXPECT_THAT(Texts(), ElementsAre("abcdefghijkl"));
}

TEST_F(LinkSharing, OfMemoryTakesBackWhatWaitsForAGapWhenTheSourceIsSilent)
{
    a.Hear(From("b", 1, {"1"}));
    a.Hear(From("b", 3, {"3"}));
    ASSERT_GT(a.ReceiverCounters().KeptBytes, 0U);
    a.Live(LinkSettings().SilentAfter - 1ms);
    EXPECT_GT(a.ReceiverCounters().KeptBytes, 0U);
    a.Live(1ms);
    EXPECT_EQ(a.ReceiverCounters().KeptBytes, 0U);
    a.TakeDelivered();
    a.Hear(From("b", 2, {"2", "3"}));
    EXPECT_THAT(Texts(), ElementsAre("2", "3")) << "the sender sends again what was dropped";
}

TEST_F(LinkSharing, OfMemoryLetsAMessageGrowInPlaceOfOneThatHasLongStalled)
{
    NodeUnderTest node(LittleMemory());
    node.Hear(On(1, FirstHalf(b, 1, node.Now)));
    node.Pass(5min);
    node.Hear(On(2, FirstHalf(b, 1, node.Now)));
    EXPECT_EQ(node.ReceiverCounters("b", "q2").HeldBackMemory, 0U);
    EXPECT_EQ(node.ReceiverCounters("b", "q1").AssemblyBytes, 0U);
    StoredFrame rest = On(1, b.Parts(1, {"abcdef", "ghijkl"}, node.Now));
    rest.Items.erase(rest.Items.begin());
    rest.Items[0].Fields.Sequence = rest.Items[0].Fields.Through = 2;
    node.TakeAcks();
    node.Hear(rest);
    node.Pass(300ms);
    EXPECT_THAT(node.TakeDelivered(), IsEmpty());
    EXPECT_EQ(node.TakeAcks().back().Fields.Acks.front().Refused[0] & 0b110U, 0b100U);
}

// Queues that the node does not accept

TEST_F(LinkSharing, RefusesWhatIsForQueuesThatAreNotAcceptedWithoutRememberingThem)
{
    for (std::uint32_t link = 1; link <= 300; ++link)
    {
        StoredFrame data = b.Data(7, {"x"}, a.Now);
        data.Queue = "none" + std::to_string(link);
        data.Fields.Data.Link = link;
        data.Fields.Data.Oldest = 7;
        a.Hear(data);
        a.Pass(1ms);
        const auto acks = a.TakeAcks();
        ASSERT_EQ(acks.size(), 1U);
        EXPECT_EQ(acks[0].Ack().Link, link);
        EXPECT_EQ(acks[0].Ack().Cumulative, 7U);
        EXPECT_TRUE((acks[0].Ack().Refused[0] >> 7 & 1) != 0);
        EXPECT_GT(acks[0].Ack().Credit, 0U);
    }
    int receivers = 0;
    a.Node->VisitReceivers([&](auto, auto, const auto &) { ++receivers; });
    EXPECT_EQ(receivers, 0);
    EXPECT_EQ(a.Node->Counters().RefusedUnknown, 300U);
    EXPECT_THAT(a.TakeDelivered(), IsEmpty());
}

TEST_F(LinkSharing, RefusesMessagesOfTypesThatAreNotAcceptedAndDoesNotOfferThem)
{
    StoredFrame data = From("b", 1, {"x"});
    data.Items[0].Type = NodeUnderTest::NoType;
    a.Hear(data);
    a.Pass(1ms);
    EXPECT_EQ(a.TakeAcks().at(0).Ack().Refused[0], 0b10U);
    EXPECT_EQ(a.ReceiverCounters().RefusedWrongType, 1U);
    EXPECT_THAT(a.Offered, IsEmpty());
}

// Datagrams

TEST_F(LinkSharing, OfDatagramsLeavesAcknowledgementsThatHaveNoRoomForTheNextOne)
{
    LinkSettings settings;
    settings.MaxDatagram = 300;
    NodeUnderTest node(settings);
    constexpr std::uint32_t Links = 60;
    node.Enqueue(std::string(5000, '.'));
    for (std::uint32_t link = 1; link <= Links; ++link)
    {
        StoredFrame data = On(link, b.Data(1, {"x"}, node.Now));
        data.Fields.Ask = true;
        node.Hear(data);
    }
    node.Pass(0ms);
    std::vector<std::size_t> sizes;
    std::vector<std::uint32_t> links;
    for (const StoredFrame &frame : node.TakeAcks())
    {
        sizes.push_back(LinkFrameCodec::EncodedSize(frame.View()));
        for (const LinkAck &ack : frame.Fields.Acks)
        {
            links.push_back(ack.Link);
        }
    }
    EXPECT_THAT(sizes, Each(Le(settings.MaxDatagram)));
    for (std::uint32_t link = 1; link <= Links; ++link)
    {
        EXPECT_THAT(links, Contains(link));
    }
}

}  // namespace
}  // namespace Rabit::Test
