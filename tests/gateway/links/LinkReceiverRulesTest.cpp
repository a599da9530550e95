// The receiver's rules, one by one, against a peer that is played by hand.
#include "NodeUnderTest.h"

#include <gmock/gmock.h>

namespace Rabit::Test
{
namespace
{

using testing::ElementsAre;
using testing::IsEmpty;
using testing::Pair;
using testing::SizeIs;

class LinkReceiverRules : public testing::Test
{
protected:
    std::vector<std::string> Texts()
    {
        std::vector<std::string> texts;
        for (const DeliveredMessage &message : a.TakeDelivered())
        {
            texts.push_back(message.Text);
        }
        return texts;
    }
    // Returns the acknowledgement sent now, which must be the only one.
    LinkAck Acknowledgement()
    {
        a.Pass(0ms);
        const auto acks = a.TakeAcks();
        EXPECT_THAT(acks, SizeIs(1));
        return acks.empty() ? LinkAck() : acks[0].Ack();
    }
    StoredFrame Data(std::uint64_t first, const std::vector<std::string> &texts)
    {
        return b.Data(first, texts, a.Now);
    }
    // Opens a session in which message 1 was delivered and acknowledged.
    void OpenSession()
    {
        a.Hear(Data(1, {"1"}));
        a.Pass(10ms);
        a.TakeAcks();
        a.TakeDelivered();
    }

    NodeUnderTest a;
    PlayedPeer b;
};

// Rule R1

TEST_F(LinkReceiverRules, R1_DataForAnotherLifeIsAnsweredWithAHelloOnly)
{
    StoredFrame data = Data(1, {"1"});
    data.Fields.ReceiverLife -= 1;
    a.Hear(data);
    a.Pass(0ms);
    EXPECT_THAT(Texts(), IsEmpty());
    EXPECT_THAT(a.TakeAcks(), IsEmpty());
    const auto hellos = a.TakeHellos();
    ASSERT_THAT(hellos, SizeIs(1));
    EXPECT_EQ(hellos[0].Fields.SenderLife, NodeUnderTest::FirstLife);
    EXPECT_EQ(hellos[0].Fields.ReceiverLife, b.Life);
    EXPECT_EQ(hellos[0].Fields.Clock, PlayedPeer::ClockOfA);
    EXPECT_EQ(hellos[0].Fields.Time, a.Now.count());
    EXPECT_FALSE(hellos[0].Fields.Short);
    EXPECT_EQ(a.Node->Counters().Stale, 1U);
}

TEST_F(LinkReceiverRules, R1_DataForAHigherLifeMakesMeTakeAYetHigherOneAndDropTheSessions)
{
    OpenSession();
    StoredFrame data = Data(2, {"2"});
    data.Fields.ReceiverLife += 3ULL << 32;
    a.Hear(data);
    EXPECT_THAT(Texts(), IsEmpty());
    EXPECT_GT(a.Node->Incarnation(), data.Fields.ReceiverLife);
    a.Pass(0ms);
    EXPECT_EQ(a.TakeHellos().at(0).Fields.SenderLife, a.Node->Incarnation());
    b.KnownLife = a.Node->Incarnation();
    a.Hear(Data(2, {"2"}));
    EXPECT_THAT(Texts(), IsEmpty()) << "the session is gone, and 1 has to come first";
}

TEST_F(LinkReceiverRules, HelloWithAHigherLifeOfMineMakesMeTakeAYetHigherOne)
{
    OpenSession();
    b.KnownLife += 5;
    a.Hear(b.Hello());
    EXPECT_GT(a.Node->Incarnation(), b.KnownLife);
    b.KnownLife = a.Node->Incarnation();
    a.Hear(Data(2, {"2"}));
    EXPECT_THAT(Texts(), IsEmpty()) << "the session is gone: 1 has to come first";
}

// Rule R2

TEST_F(LinkReceiverRules, R2_DataOfAnOlderLifeOfTheSenderIsAnsweredWithAHelloOnly)
{
    OpenSession();
    a.TakeHellos();
    StoredFrame data = Data(2, {"2"});
    data.Fields.SenderLife -= 1;
    a.Hear(data);
    a.Pass(0ms);
    EXPECT_THAT(Texts(), IsEmpty());
    EXPECT_EQ(a.TakeHellos().at(0).Fields.ReceiverLife, b.Life);
    EXPECT_EQ(a.Node->Counters().Stale, 1U);
}

// Rule R3

TEST_F(LinkReceiverRules, R3_OpensASessionAtTheOldestNumberUnderWay)
{
    StoredFrame data = Data(41, {"41"});
    data.Fields.Data.Oldest = 41;
    a.Hear(data);
    EXPECT_THAT(Texts(), ElementsAre("41"));
    const LinkAck ack = Acknowledgement();
    EXPECT_TRUE(ack.Open);
    EXPECT_EQ(ack.Cumulative, 41U);
}

TEST_F(LinkReceiverRules, R3_OpensNoSessionWithoutAnEchoOfMyClock)
{
    StoredFrame data = Data(1, {"1"});
    data.Fields.Echo.Clock += 1;
    a.Hear(data);
    EXPECT_THAT(Texts(), IsEmpty());
    EXPECT_FALSE(Acknowledgement().Open);
}

TEST_F(LinkReceiverRules, R3_OpensNoSessionWithAnEchoFromTheFuture)
{
    StoredFrame data = Data(1, {"1"});
    data.Fields.Echo.Time = (a.Now + 1ns).count();
    a.Hear(data);
    EXPECT_THAT(Texts(), IsEmpty());
}

TEST_F(LinkReceiverRules, R3_ALateDatagramOfAnotherLifeDoesNotReplaceASessionYoungerThanIt)
{
    StoredFrame straggler = Data(1, {"old"});
    straggler.Fields.SenderLife += 1;  // a higher life, whose storage was lost afterwards
    a.Now += 1s;
    OpenSession();
    a.Now += 90s;
    a.Hear(straggler);
    EXPECT_THAT(Texts(), IsEmpty());
    StoredFrame atOpening = straggler;
    atOpening.Fields.Echo.Time = (a.Now - 90s - 10ms).count();
    a.Hear(atOpening);
    EXPECT_FALSE(Acknowledgement().Open) << "there is none with that life";
    EXPECT_THAT(Texts(), IsEmpty()) << "a reading of the very moment of opening proves nothing";
}

TEST_F(LinkReceiverRules, R3_ANewLifeOfTheSenderReplacesTheSession)
{
    OpenSession();
    b.Life += 1;
    a.Hear(Data(1, {"new"}));
    EXPECT_THAT(Texts(), ElementsAre("new"));
    EXPECT_EQ(a.ReceiverCounters().SessionsOpened, 2U);
}

TEST_F(LinkReceiverRules, R3_ANewSessionKnowsNoOutcomesOfTheOldOne)
{
    OpenSession();
    b.Life += 1;
    StoredFrame data = Data(1, {""});
    MakeSkip(data.Items[0], 1, 1);
    a.Hear(data);
    EXPECT_EQ(Acknowledgement().Delivered, LinkBitmap{});
}

TEST_F(LinkReceiverRules, HelloOfAPeerThatDoesNotKnowThisLifeIsAnsweredAtOnce)
{
    a.Hear(b.Hello());
    a.Pass(30ms);
    a.TakeHellos();
    a.Pass(30ms);
    a.Hear(b.Hello());
    a.Pass(0ms);
    EXPECT_THAT(a.TakeHellos(), IsEmpty()) << "it knows";
    b.KnownLife = 0;
    a.Hear(b.Hello());
    a.Pass(0ms);
    const auto hellos = a.TakeHellos();
    ASSERT_THAT(hellos, SizeIs(1));
    EXPECT_EQ(hellos[0].Fields.SenderLife, NodeUnderTest::FirstLife);
    EXPECT_EQ(hellos[0].Fields.ReceiverLife, b.Life);
}

// Rule R4

TEST_F(LinkReceiverRules, R4_ARepeatedMessageIsAcknowledgedOnly)
{
    OpenSession();
    a.Hear(Data(1, {"1"}));
    EXPECT_THAT(Texts(), IsEmpty());
    a.Pass(2ms);
    ASSERT_THAT(a.TakeAcks(), SizeIs(1));
    EXPECT_EQ(a.ReceiverCounters().Duplicates, 1U);
}

TEST_F(LinkReceiverRules, Acknowledgements_go_in_frames_of_their_own_if_the_driver_wants_that)
{
    OpenSession();
    a.AcksAlone = true;
    a.Enqueue("x");
    a.Hear(Data(2, {"2"}));
    a.Pass(10ms);
    const auto acks = a.TakeAcks();
    ASSERT_THAT(acks, SizeIs(1));
    EXPECT_FALSE(acks[0].Fields.HasData);
    EXPECT_THAT(a.TakeDatas(), SizeIs(1));
}

TEST_F(LinkReceiverRules, R4_WhatComesAfterAGapIsHeldAndDeliveredWhenTheGapIsFilled)
{
    OpenSession();
    a.Hear(Data(3, {"3", "4"}));
    EXPECT_THAT(Texts(), IsEmpty());
    a.Pass(2ms);
    const auto acks = a.TakeAcks();
    ASSERT_THAT(acks, SizeIs(1));
    EXPECT_EQ(acks[0].Ack().Cumulative, 1U);
    EXPECT_EQ(acks[0].Ack().Held[0], 0b110U);
    a.Hear(Data(2, {"2"}));
    EXPECT_THAT(Texts(), ElementsAre("2", "3", "4"));
}

TEST_F(LinkReceiverRules, R4_WhatIsHeldIsBoundedInBytes)
{
    LinkSettings settings;
    settings.ReorderBytes = 1000;
    NodeUnderTest node(settings);
    node.Hear(b.Data(1, {"1"}, node.Now));
    node.Hear(b.Data(3, {std::string(600, '3'), std::string(600, '4')}, node.Now));
    node.Pass(2ms);
    EXPECT_EQ(node.TakeAcks().back().Ack().Held[0], 0b10U) << "the second did not fit";
    EXPECT_EQ(node.ReceiverCounters().NotKept, 1U);
    node.Hear(b.Data(2, {"2"}, node.Now));
    EXPECT_THAT(node.TakeDelivered(), SizeIs(3));
    EXPECT_EQ(node.ReceiverCounters().KeptBytes, 0U);
}

TEST_F(LinkReceiverRules, R4_WhatIsHeldOnAllLinksIsBoundedInBytes)
{
    LinkSettings settings;
    settings.ReorderBytesOfNode = 1000;
    NodeUnderTest node(settings);
    for (std::uint32_t link = 1; link <= 3; ++link)
    {
        StoredFrame data = b.Data(2, {std::string(600, '2')}, node.Now);
        data.Queue = "q" + std::to_string(link);
        data.Fields.Data.Link = link;
        node.Hear(data);
    }
    EXPECT_EQ(node.ReceiverCounters("b", "q1").Kept, 1U);
    EXPECT_EQ(node.ReceiverCounters("b", "q2").NotKept, 1U);
    EXPECT_EQ(node.ReceiverCounters("b", "q3").NotKept, 1U);
}

TEST_F(LinkReceiverRules, R4_WhatWasHeldIsAsOldAsItIsWhenItIsDelivered)
{
    OpenSession();
    StoredFrame data = Data(3, {"3"});
    data.Items[0].Fields.TtlLeft = LinkTime(100ms).count();
    a.Hear(data);
    a.Now += 100ms;
    a.Hear(Data(2, {"2"}));
    EXPECT_THAT(Texts(), ElementsAre("2"));
    const LinkAck ack = Acknowledgement();
    EXPECT_EQ(ack.Cumulative, 2U);
    EXPECT_EQ(ack.Held, LinkBitmap{}) << "it must be sent again, with what is left of its life";
    EXPECT_EQ(a.ReceiverCounters().HeldBackLate, 1U);
}

TEST_F(LinkReceiverRules, R4_WhatWasHeldForLessThanItsLifeIsDelivered)
{
    OpenSession();
    StoredFrame data = Data(3, {"3"});
    data.Items[0].Fields.TtlLeft = LinkTime(100ms).count();
    a.Hear(data);
    a.Now += 99ms;
    a.Hear(Data(2, {"2"}));
    EXPECT_THAT(Texts(), ElementsAre("2", "3"));
}

TEST_F(LinkReceiverRules, R4_ThePartsOfALargeMessageArePutTogether)
{
    OpenSession();
    a.Hear(b.Parts(2, {"abc", "def", "g"}, a.Now));
    EXPECT_THAT(a.TakeDelivered(), ElementsAre(DeliveredMessage{"b", "q", "T", "abcdefg"}));
    EXPECT_EQ(a.ReceiverCounters().Delivered, 2U);
}

TEST_F(LinkReceiverRules, R4_ThePartsOfALargeMessageArePutTogetherInTheirOrder)
{
    OpenSession();
    StoredFrame parts = b.Parts(2, {"abc", "def", "g"}, a.Now);
    StoredFrame last = parts;
    last.Items = {parts.Items[2]};
    a.Hear(last);
    parts.Items.pop_back();
    a.Hear(parts);
    EXPECT_THAT(Texts(), ElementsAre("abcdefg"));
}

TEST_F(LinkReceiverRules, R4_ALargeMessageOfAnotherSizeThanWasSaidIsRefused)
{
    OpenSession();
    StoredFrame longer = b.Parts(2, {"abc", "def"}, a.Now);
    longer.Items[0].Fields.Size = 5;
    a.Hear(longer);
    StoredFrame shorter = b.Parts(4, {"abc", "def"}, a.Now);
    shorter.Items[0].Fields.Size = 7;
    a.Hear(shorter);
    a.Hear(Data(6, {"6"}));
    EXPECT_THAT(Texts(), ElementsAre("6"));
    EXPECT_EQ(a.ReceiverCounters().RefusedUndecodable, 2U);
}

TEST_F(LinkReceiverRules, R4_AMessageLargerThanTheLargestIsRefusedAndTakesNoMemory)
{
    LinkSettings settings;
    settings.LargestMessage = 5;
    NodeUnderTest node(settings);
    StoredFrame parts = b.Parts(1, {"abc", "def"}, node.Now);
    StoredFrame first = parts;
    first.Items.pop_back();
    node.Hear(first);
    EXPECT_EQ(node.ReceiverCounters().AssemblyBytes, 0U);
    node.Hear(parts);
    node.Pass(2ms);
    EXPECT_EQ(node.TakeAcks().back().Ack().Refused[0], 0b100U);
    EXPECT_THAT(node.TakeDelivered(), IsEmpty());
}

TEST_F(LinkReceiverRules, R4_MemoryIsTakenAsBytesArriveNotAsTheyAreAnnounced)
{
    OpenSession();
    StoredFrame parts = b.Parts(2, {"abc", "d"}, a.Now);
    parts.Items.pop_back();
    parts.Items[0].Fields.Size = 60 << 20;
    a.Hear(parts);
    EXPECT_EQ(a.ReceiverCounters().AssemblyBytes, 3U);
}

TEST_F(LinkReceiverRules,
       R4_the_beginnings_of_large_messages_are_bounded_and_do_not_block_each_other_for_ever)
{
    LinkSettings settings;
    settings.AssemblyBytesOfNode = 10;
    NodeUnderTest node(settings);
    const auto parts = [&](std::uint32_t link)
    {
        StoredFrame frame = b.Parts(1, {"abcdef", "ghijkl"}, node.Now);
        frame.Queue = "q" + std::to_string(link);
        frame.Fields.Data.Link = link;
        return frame;
    };
    for (std::uint32_t link = 1; link <= 3; ++link)
    {
        StoredFrame first = parts(link);
        first.Items.pop_back();
        node.Hear(first);
    }
    EXPECT_EQ(node.ReceiverCounters("b", "q2").HeldBackMemory, 1U) << "12 bytes each: the first went beyond";
    EXPECT_EQ(node.ReceiverCounters("b", "q3").HeldBackMemory, 1U);
    node.Pass(2ms);
    EXPECT_EQ(node.TakeAcks().back().Fields.Acks.back().Credit, 0U);
    node.Hear(parts(2));
    EXPECT_THAT(node.TakeDelivered(), IsEmpty());
    node.Hear(parts(1));
    node.Hear(parts(2));
    node.Hear(parts(3));
    EXPECT_THAT(node.TakeDelivered(), SizeIs(3));
}

TEST_F(LinkReceiverRules, R4_TypesAreKnownByTheNumbersThatWereSaidWithTheirNames)
{
    OpenSession();
    StoredFrame named = Data(2, {"2"});
    named.Items[0].Type = "Other";
    named.Items[0].Fields.TypeNumber = 1;
    a.Hear(named);
    StoredFrame numbered = Data(3, {"3"});
    numbered.Items[0].Type.clear();
    numbered.Items[0].Fields.TypeNumber = 1;
    a.Hear(numbered);
    EXPECT_EQ(a.TakeDelivered().back().Type, "Other");
    numbered.Items[0].Fields.TypeNumber = 2;
    numbered.Items[0].Fields.Sequence = numbered.Items[0].Fields.Through = 4;
    a.Hear(numbered);
    EXPECT_THAT(a.TakeDelivered(), IsEmpty());
    EXPECT_EQ(a.ReceiverCounters().RefusedWrongType, 1U) << "a number that means nothing";
}

TEST_F(LinkReceiverRules, R4_ALinkWhoseNumberMeansNothingIsAskedForItsQueue)
{
    a.Hear(b.Hello());
    StoredFrame data = Data(1, {"1"});
    data.Queue.clear();
    data.Fields.Data.Link = 9;
    a.Hear(data);
    const LinkAck ack = Acknowledgement();
    EXPECT_EQ(ack.Link, 9U);
    EXPECT_FALSE(ack.Open);
    data.Queue = "q";
    a.Hear(data);
    EXPECT_THAT(Texts(), ElementsAre("1"));
}

TEST_F(LinkReceiverRules, R4_NewMessagesBehindRepeatedOnesInADatagramAreDelivered)
{
    OpenSession();
    a.Hear(Data(1, {"1", "2", "3"}));
    EXPECT_THAT(Texts(), ElementsAre("2", "3"));
}

// Rule R5

TEST_F(LinkReceiverRules, R5_AMessageWithAnExpiryNeedsAnEchoOfMyClock)
{
    OpenSession();
    StoredFrame data = Data(2, {"2"});
    data.Fields.Echo.Clock += 1;
    data.Items[0].Fields.TtlLeft = LinkTime(1h).count();
    a.Hear(data);
    EXPECT_THAT(Texts(), IsEmpty());
    EXPECT_EQ(Acknowledgement().Cumulative, 1U);
    EXPECT_EQ(a.ReceiverCounters().HeldBackLate, 1U);
    data.Items[0].Fields.TtlLeft = LinkNoExpiry;
    a.Hear(data);
    EXPECT_THAT(Texts(), ElementsAre("2")) << "one without an expiry does not";
}

// Rule R6

TEST_F(LinkReceiverRules, R6_AMessageThatMayHaveExpiredOnTheWayIsNotDelivered)
{
    OpenSession();
    StoredFrame data = Data(2, {"2"});
    data.Fields.Echo.HeldFor = LinkTime(30ms).count();
    data.Items[0].Fields.TtlLeft = LinkTime(70ms).count();
    a.Now += 100ms;  // 70 ms of them in transit
    a.Hear(data);
    EXPECT_THAT(Texts(), IsEmpty());
    a.Pass(0ms);
    const auto acks = a.TakeAcks();
    ASSERT_THAT(acks, SizeIs(1));
    EXPECT_EQ(acks[0].Ack().Cumulative, 1U) << "the sender says when it has expired";
    EXPECT_EQ(acks[0].Fields.Time, a.Now.count()) << "a fresh token";
}

TEST_F(LinkReceiverRules, R6_AMessageWithTimeLeftIsDelivered)
{
    OpenSession();
    StoredFrame data = Data(2, {"2"});
    data.Fields.Echo.HeldFor = LinkTime(30ms).count();
    data.Items[0].Fields.TtlLeft = LinkTime(71ms).count();
    a.Now += 100ms;
    a.Hear(data);
    EXPECT_THAT(Texts(), ElementsAre("2"));
}

TEST_F(LinkReceiverRules, R6_AllowsForTheDriftOfTheTwoClocks)
{
    OpenSession();
    StoredFrame data = Data(2, {"2"});
    data.Fields.Echo.HeldFor = LinkTime(100s).count();
    data.Items[0].Fields.TtlLeft = LinkTime(100ms).count();
    a.Now += 100s;  // none of it in transit, as it seems; but 100 s held may have been 100.1 s
    a.Hear(data);
    EXPECT_THAT(Texts(), IsEmpty());
}

TEST_F(LinkReceiverRules, R6_ASkipIsConsumedAndNotDelivered)
{
    OpenSession();
    StoredFrame data = Data(2, {"2", "3"});
    MakeSkip(data.Items[0], 2, 2);
    a.Hear(data);
    EXPECT_THAT(Texts(), ElementsAre("3"));
    a.Pass(2ms);
    const auto acks = a.TakeAcks();
    ASSERT_THAT(acks, SizeIs(1));
    EXPECT_EQ(acks[0].Ack().Cumulative, 3U);
    EXPECT_EQ(acks[0].Ack().Delivered[0], 0b1010U);
    EXPECT_EQ(acks[0].Ack().Refused[0], 0U);
}

TEST_F(LinkReceiverRules, R6_ASkipOfSeveralPartsDropsWhatWasThereOfTheMessage)
{
    OpenSession();
    StoredFrame parts = b.Parts(2, {"abc", "def", "g"}, a.Now);
    StoredFrame last = parts;
    last.Items = {parts.Items[2]};
    parts.Items.resize(1);
    a.Hear(parts);
    a.Hear(last);
    StoredFrame skip = Data(2, {"", "5"});
    MakeSkip(skip.Items[0], 2, 4);
    skip.Items[1].Fields.Sequence = skip.Items[1].Fields.Through = 5;
    a.Hear(skip);
    EXPECT_THAT(Texts(), ElementsAre("5"));
    a.Pass(2ms);
    EXPECT_EQ(a.TakeAcks().back().Ack().Cumulative, 5U);
    EXPECT_EQ(a.ReceiverCounters().AssemblyBytes, 0U);
    EXPECT_EQ(a.ReceiverCounters().KeptBytes, 0U);
}

TEST_F(LinkReceiverRules, R6_ASkipGivesTheMemoryOfTheMessageBack)
{
    OpenSession();
    StoredFrame parts = b.Parts(2, {"abc", "def", "g"}, a.Now);
    parts.Items.pop_back();
    a.Hear(parts);
    ASSERT_EQ(a.ReceiverCounters().AssemblyBytes, 6U);
    StoredFrame skip = Data(4, {""});
    MakeSkip(skip.Items[0], 4, 4);
    a.Hear(skip);
    EXPECT_EQ(a.ReceiverCounters().AssemblyBytes, 0U);
}

TEST_F(LinkReceiverRules, R3_ASessionThatIsDroppedGivesItsMemoryBack)
{
    OpenSession();
    StoredFrame parts = b.Parts(2, {"abc", "def", "g"}, a.Now);
    parts.Items.pop_back();
    a.Hear(parts);
    a.Hear(Data(6, {"6"}));
    ASSERT_GT(a.ReceiverCounters().KeptBytes, 0U);
    b.KnownLife += 5;
    a.Hear(b.Hello());
    EXPECT_EQ(a.ReceiverCounters().AssemblyBytes, 0U);
    EXPECT_EQ(a.ReceiverCounters().KeptBytes, 0U);
}

// Rule R7

TEST_F(LinkReceiverRules, R7_AFullQueueHoldsTheStreamBackAndGivesCreditForOneMessageThatWaits)
{
    OpenSession();
    a.Answer = LocalQueueResult::Full;
    a.RoomLeft = 0;
    a.Hear(Data(2, {"2", "3"}));
    const LinkAck ack = Acknowledgement();
    EXPECT_EQ(ack.Cumulative, 1U);
    EXPECT_EQ(ack.Credit, 1U);
    EXPECT_EQ(ack.Held[0], 0b11U) << "it need not be sent again";
    EXPECT_TRUE(a.ReceiverCounters().HeldBack);
    EXPECT_EQ(a.ReceiverCounters().HeldBackFull, 1U) << "what comes behind is not even tried";
}

TEST_F(LinkReceiverRules, R7_AFullQueueHoldsNoStreamBackOfWhichNothingWaits)
{
    a.RoomLeft = 0;
    OpenSession();
    EXPECT_FALSE(a.ReceiverCounters().HeldBack) << "the message went into the last place";
    a.Answer = LocalQueueResult::Full;
    a.Hear(Data(2, {"2"}));
    a.Pass(10ms);
    EXPECT_TRUE(a.ReceiverCounters().HeldBack);
    a.Answer = LocalQueueResult::Ok;
    a.Node->OnRoom("q");
    a.Pass(10ms);
    EXPECT_FALSE(a.ReceiverCounters().HeldBack) << "it was delivered";
}

TEST_F(LinkReceiverRules, R7_RoomIsMadeKnown)
{
    OpenSession();
    a.Answer = LocalQueueResult::Full;
    a.RoomLeft = 0;
    a.Hear(Data(2, {"2"}));
    Acknowledgement();
    a.Answer = LocalQueueResult::Ok;
    a.RoomLeft = 4;
    a.Node->OnRoom("other");
    a.Pass(100ms);
    EXPECT_THAT(a.TakeAcks(), IsEmpty());
    a.Node->OnRoom("q");
    a.Pass(0ms);
    a.Pass(2ms);
    const auto acks = a.TakeAcks();
    ASSERT_THAT(acks, SizeIs(1));
    EXPECT_EQ(acks[0].Ack().Credit, 4U);
    a.Node->OnRoom("q");
    a.Pass(100ms);
    EXPECT_THAT(a.TakeAcks(), IsEmpty()) << "once is enough";
}

TEST_F(LinkReceiverRules, R7_WhatWaitedForRoomIsDeliveredWhenThereIsRoom)
{
    OpenSession();
    a.Answer = LocalQueueResult::Full;
    a.RoomLeft = 0;
    a.Hear(Data(2, {"2", "3"}));
    Acknowledgement();
    a.Answer = LocalQueueResult::Ok;
    a.RoomLeft = 4;
    a.Node->OnRoom("q");
    EXPECT_LE(a.Node->NextDue(), a.Now);
    a.Pass(0ms);
    EXPECT_THAT(Texts(), ElementsAre("2", "3"));
}

TEST_F(LinkReceiverRules, R7_WhatWaitedForRoomIsTriedAgainWhenTheSenderAsks)
{
    OpenSession();
    a.Answer = LocalQueueResult::Full;
    a.Hear(Data(2, {"2"}));
    a.Answer = LocalQueueResult::Ok;
    a.Hear(Data(2, {"2"}));
    EXPECT_THAT(Texts(), ElementsAre("2"));
}

// A driver that decodes large messages elsewhere.
class LinkReceiverPreparation : public LinkReceiverRules
{
protected:
    void GiveOut(std::uint64_t first, const std::vector<std::string> &parts)
    {
        a.Answer = LocalQueueResult::Later;
        a.Hear(b.Parts(first, parts, a.Now));
        a.Answer = LocalQueueResult::Ok;
    }
    void Prepare(std::uint64_t number, std::uint64_t life = PlayedPeer().Life)
    {
        a.Node->Prepared("b", "q", life, number, std::make_shared<int>(), a.Now);
    }
};

TEST_F(LinkReceiverPreparation, R7_WhatIsPreparedIsNotOfferedAgainBeforeItIsReady)
{
    OpenSession();
    a.Offered.clear();
    GiveOut(2, {"ab", "c"});
    a.Hear(b.Parts(2, {"ab", "c"}, a.Now));
    a.Node->OnRoom("q");
    a.Pass(1ms);
    EXPECT_THAT(a.Offered, ElementsAre(Pair(b.Life, 3U)));
    EXPECT_THAT(Texts(), IsEmpty());
    Prepare(3);
    EXPECT_THAT(Texts(), ElementsAre("abc"));
    Prepare(3);
    EXPECT_THAT(Texts(), IsEmpty());
}

TEST_F(LinkReceiverPreparation, R7_WhatWasPreparedOfOneMessageIsNotTakenForAnotherOfItsSize)
{
    OpenSession();
    GiveOut(2, {"ab", "c"});
    Prepare(3);
    ASSERT_THAT(Texts(), ElementsAre("abc"));
    GiveOut(4, {"de", "f"});
    Prepare(3);
    EXPECT_THAT(Texts(), IsEmpty());
    Prepare(5, b.Life + 1);
    EXPECT_THAT(Texts(), IsEmpty());
    Prepare(5);
    EXPECT_THAT(Texts(), ElementsAre("def"));
}

TEST_F(LinkReceiverPreparation, R7_WhatWasPreparedForAQueueThatIsFullNowIsKeptForTheNextTurn)
{
    OpenSession();
    GiveOut(2, {"ab", "c"});
    a.Answer = LocalQueueResult::Full;
    Prepare(3);
    a.Answer = LocalQueueResult::Ok;
    a.Node->OnRoom("q");
    a.Pass(0ms);
    EXPECT_THAT(Texts(), ElementsAre("abc"));
}

TEST_F(LinkReceiverPreparation, R7_WhatCouldNotBePreparedIsOfferedAgain)
{
    OpenSession();
    GiveOut(2, {"ab", "c"});
    a.Node->Prepared("b", "q", b.Life, 3, nullptr, a.Now);
    EXPECT_THAT(Texts(), ElementsAre("abc"));
}

TEST_F(LinkReceiverPreparation, R7_WhatExpiresWhileItIsPreparedIsNotDelivered)
{
    OpenSession();
    GiveOut(2, {"ab", "c"});
    StoredFrame skip = Data(2, {""});
    MakeSkip(skip.Items[0], 2, 3);
    a.Hear(skip);
    Prepare(3);
    EXPECT_THAT(Texts(), IsEmpty());
    a.Hear(Data(4, {"4"}));
    EXPECT_THAT(Texts(), ElementsAre("4"));
}

// Rule R8

TEST_F(LinkReceiverRules, R8_DeliversInOrderWithSourceQueueAndType)
{
    a.Hear(Data(1, {"1", "2"}));
    a.Hear(Data(3, {"3"}));
    EXPECT_THAT(a.TakeDelivered(),
                ElementsAre(DeliveredMessage{"b", "q", "T", "1"}, DeliveredMessage{"b", "q", "T", "2"},
                            DeliveredMessage{"b", "q", "T", "3"}));
}

TEST_F(LinkReceiverRules, R8_PassesOnTheRedeliveredMark)
{
    StoredFrame data = Data(1, {"1"});
    data.Items[0].Fields.Flags |= LinkFlagRedelivered;
    a.Hear(data);
    EXPECT_THAT(a.TakeDelivered(), ElementsAre(DeliveredMessage{"b", "q", "T", "1", true}));
}

TEST_F(LinkReceiverRules, R8_CombinesAcknowledgementsForTwoMilliseconds)
{
    OpenSession();
    a.Hear(Data(2, {"2"}));
    a.Pass(1ms);
    a.Hear(Data(3, {"3"}));
    EXPECT_THAT(a.TakeAcks(), IsEmpty());
    a.Pass(1ms);
    const auto acks = a.TakeAcks();
    ASSERT_THAT(acks, SizeIs(1));
    EXPECT_EQ(acks[0].Ack().Cumulative, 3U);
    EXPECT_EQ(acks[0].Ack().Delivered[0], 0b1110U);
    EXPECT_EQ(acks[0].Ack().Credit, 256U) << "room for 1000, told up to the largest window";
}

TEST_F(LinkReceiverRules, R8_AcknowledgesAtOnceAfterSixteenMessages)
{
    OpenSession();
    a.Hear(Data(2, std::vector<std::string>(16, "m")));
    EXPECT_EQ(Acknowledgement().Cumulative, 17U);
}

TEST_F(LinkReceiverRules, R8_AcknowledgesAtOnceWhenTheSenderAsks)
{
    OpenSession();
    StoredFrame data = Data(2, {"2"});
    data.Fields.Ask = true;
    a.Hear(data);
    EXPECT_EQ(Acknowledgement().Cumulative, 2U);
}

TEST_F(LinkReceiverRules, R8_AnAcknowledgementGoesWithDataThatGoesAnyway)
{
    a.Hear(Data(1, {"1"}));
    a.Enqueue("mine");
    a.Pass(0ms);
    const auto datas = a.TakeDatas();
    ASSERT_THAT(datas, SizeIs(1));
    EXPECT_THAT(datas[0].Fields.Acks, SizeIs(1));
    a.Pass(100ms);
    EXPECT_THAT(a.TakeAcks(), SizeIs(1)) << "that one";
}

// b says and a answers, a message each, in 100 us.
class LinkReceiverDialogue : public LinkReceiverRules
{
protected:
    LinkReceiverDialogue()
    {
        OpenSession();
        Exchange();
    }
    void Exchange()
    {
        Hear();
        a.Enqueue("mine");
        ++_answers;
        a.Pass(50us);
        EXPECT_THAT(a.TakeAcks(), SizeIs(1));
    }
    void Hear(bool asks = false)
    {
        a.Pass(50us);
        StoredFrame data = Data(_next++, {"m"});
        data.Fields.Ask = asks;
        if (_answers > 0)
        {
            data.Fields.Acks = b.Ack(_answers).Fields.Acks;
        }
        a.Hear(data);
    }

private:
    std::uint64_t _next = 2;
    std::uint64_t _answers = 0;  // messages of a
};

TEST_F(LinkReceiverDialogue, R8_AMessageOfADialogueMakesNothingDueEarlier)
{
    Exchange();
    const LinkTime due = a.Node->NextDue();
    Hear();
    EXPECT_GE(a.Node->NextDue(), due);
}

TEST_F(LinkReceiverDialogue, R8_TheLastMessageOfADialogueIsAcknowledgedInFourMilliseconds)
{
    Exchange();
    Hear();
    a.Live(3999us);
    EXPECT_THAT(a.TakeAcks(), IsEmpty());
    a.Live(1us);
    EXPECT_THAT(a.TakeAcks(), SizeIs(1));
}

TEST_F(LinkReceiverDialogue, R8_NothingMoreIsDueWhenADialogueIsOver)
{
    Exchange();
    Hear();
    a.Live(10ms);
    a.TakeAcks();
    EXPECT_EQ(a.Node->NextDue(), LinkNever);
}

TEST_F(LinkReceiverDialogue, R8_ADialogueWithPausesIsAcknowledgedInTwoMilliseconds)
{
    Exchange();
    a.Live(2ms);
    Hear();
    a.Live(2ms);
    EXPECT_THAT(a.TakeAcks(), SizeIs(1));
}

TEST_F(LinkReceiverDialogue, R8_MessagesWithoutAnswersAreAcknowledgedInTwoMilliseconds)
{
    Hear(true);
    a.Pass(0ms);
    EXPECT_THAT(a.TakeAcks(), SizeIs(1));
    Hear();
    a.Live(2ms);
    EXPECT_THAT(a.TakeAcks(), SizeIs(1));
}

TEST_F(LinkReceiverRules, R8_AcknowledgesAtOnceAfterHalfOfAWindowInBytes)
{
    OpenSession();
    a.Hear(Data(2, std::vector<std::string>(3, std::string(32 * 1024, 'm'))));
    EXPECT_THAT(a.TakeAcks(), IsEmpty());
    a.Hear(Data(5, {std::string(32 * 1024, 'm')}));
    EXPECT_EQ(Acknowledgement().Cumulative, 5U);
}

TEST_F(LinkReceiverRules, UndeliverableMessagesAreConsumedAndTheSenderLearnsOfIt)
{
    OpenSession();
    std::uint64_t sequence = 2;
    for (const LocalQueueResult answer :
         {LocalQueueResult::Unknown, LocalQueueResult::WrongType, LocalQueueResult::Undecodable})
    {
        a.Answer = answer;
        a.Hear(Data(sequence++, {"x"}));
    }
    a.Answer = LocalQueueResult::Ok;
    a.Hear(Data(5, {"5"}));
    EXPECT_THAT(Texts(), ElementsAre("5"));
    a.Pass(2ms);
    const auto acks = a.TakeAcks();
    ASSERT_THAT(acks, SizeIs(1));
    EXPECT_EQ(acks[0].Ack().Cumulative, 5U);
    EXPECT_EQ(acks[0].Ack().Delivered[0], 0b100010U);
    EXPECT_EQ(acks[0].Ack().Refused[0], 0b011100U);
    EXPECT_EQ(a.ReceiverCounters().RefusedUnknown, 1U);
    EXPECT_EQ(a.ReceiverCounters().RefusedWrongType, 1U);
    EXPECT_EQ(a.ReceiverCounters().RefusedUndecodable, 1U);
}

}  // namespace
}  // namespace Rabit::Test
