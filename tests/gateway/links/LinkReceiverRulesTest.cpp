// The receiver's rules, one by one, against a peer that is played by hand.
#include "NodeUnderTest.h"

#include <gmock/gmock.h>

namespace Rabit::Test
{
namespace
{

using testing::ElementsAre;
using testing::IsEmpty;
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
    // The acknowledgement sent now, which must be the only one.
    LinkAck Acknowledgement()
    {
        a.Pass(0ms);
        const auto acks = a.TakeAcks();
        EXPECT_THAT(acks, SizeIs(1));
        return acks.empty() ? LinkAck() : acks[0].Fields;
    }
    StoredData Data(std::uint64_t first, const std::vector<std::string> &texts)
    {
        return b.Data(first, texts, a.Now);
    }
    // A session in which message 1 was delivered and acknowledged.
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

TEST_F(LinkReceiverRules, R1_data_for_another_life_is_acknowledged_only)
{
    StoredData data = Data(1, {"1"});
    data.Fields.ReceiverIncarnation -= 1;
    a.Hear(data);
    const LinkAck ack = Acknowledgement();
    EXPECT_THAT(Texts(), IsEmpty());
    EXPECT_EQ(ack.ReceiverIncarnation, NodeUnderTest::FirstLife);
    EXPECT_EQ(ack.SenderIncarnation, 0U);
    EXPECT_EQ(ack.Cumulative, 0U);
    EXPECT_EQ(ack.Clock, NodeUnderTest::MyClock);
    EXPECT_EQ(ack.Time, a.Now.count());
    EXPECT_EQ(ack.YourIncarnation, b.Life);
}

TEST_F(LinkReceiverRules, R1_data_for_a_higher_life_makes_me_take_a_yet_higher_one_and_drop_the_sessions)
{
    OpenSession();
    StoredData data = Data(2, {"2"});
    data.Fields.ReceiverIncarnation += 3ULL << 32;
    a.Hear(data);
    EXPECT_THAT(Texts(), IsEmpty());
    EXPECT_GT(a.Node->Incarnation(), data.Fields.ReceiverIncarnation);
    const LinkAck ack = Acknowledgement();
    EXPECT_EQ(ack.ReceiverIncarnation, a.Node->Incarnation());
    EXPECT_EQ(ack.SenderIncarnation, 0U);
}

TEST_F(LinkReceiverRules, hello_with_a_higher_life_of_mine_makes_me_take_a_yet_higher_one)
{
    OpenSession();
    b.KnownLife += 5;
    a.Hear(b.Hello());
    EXPECT_GT(a.Node->Incarnation(), b.KnownLife);
    b.KnownLife = a.Node->Incarnation();
    a.Hear(Data(2, {"2"}));
    EXPECT_THAT(Texts(), IsEmpty()) << "the session is gone: this would be a gap";
}

// Rule R2

TEST_F(LinkReceiverRules, R2_data_of_an_older_life_of_the_sender_is_acknowledged_only)
{
    OpenSession();
    StoredData data = Data(2, {"2"});
    data.Fields.SenderIncarnation -= 1;
    a.Hear(data);
    EXPECT_THAT(Texts(), IsEmpty());
    EXPECT_EQ(Acknowledgement().YourIncarnation, b.Life);
    EXPECT_EQ(a.ReceiverCounters().Stale, 1U);
}

// Rule R3

TEST_F(LinkReceiverRules, R3_opens_a_session_at_the_base_of_the_stream)
{
    StoredData data = Data(41, {"41"});
    data.Fields.Base = 41;
    a.Hear(data);
    EXPECT_THAT(Texts(), ElementsAre("41"));
    const LinkAck ack = Acknowledgement();
    EXPECT_EQ(ack.SenderIncarnation, b.Life);
    EXPECT_EQ(ack.Cumulative, 41U);
}

TEST_F(LinkReceiverRules, R3_opens_no_session_without_an_echo_of_my_clock)
{
    StoredData data = Data(1, {"1"});
    data.Fields.Echo.Clock = NodeUnderTest::MyClock + 1;
    a.Hear(data);
    EXPECT_THAT(Texts(), IsEmpty());
    EXPECT_EQ(Acknowledgement().SenderIncarnation, 0U);
}

TEST_F(LinkReceiverRules, R3_opens_no_session_with_an_echo_from_the_future)
{
    StoredData data = Data(1, {"1"});
    data.Fields.Echo.Time = (a.Now + 1ns).count();
    a.Hear(data);
    EXPECT_THAT(Texts(), IsEmpty());
}

TEST_F(LinkReceiverRules, R3_a_late_datagram_of_another_life_does_not_replace_a_session_younger_than_it)
{
    StoredData straggler = Data(1, {"old"});
    straggler.Fields.SenderIncarnation += 1;  // a higher life, whose storage was lost afterwards
    a.Now += 1s;
    OpenSession();
    a.Now += 90s;
    a.Hear(straggler);
    EXPECT_THAT(Texts(), IsEmpty());
    StoredData atOpening = straggler;
    atOpening.Fields.Echo.Time = (a.Now - 90s - 10ms).count();
    a.Hear(atOpening);
    EXPECT_THAT(Texts(), IsEmpty()) << "a reading of the very moment of opening proves nothing";
}

TEST_F(LinkReceiverRules, R3_a_new_life_of_the_sender_replaces_the_session)
{
    OpenSession();
    b.Life += 1;
    a.Hear(Data(1, {"new"}));
    EXPECT_THAT(Texts(), ElementsAre("new"));
    EXPECT_EQ(a.ReceiverCounters().SessionsOpened, 2U);
}

TEST_F(LinkReceiverRules, R3_a_new_session_knows_no_outcomes_of_the_old_one)
{
    OpenSession();
    b.Life += 1;
    StoredData data = Data(1, {""});
    data.Items[0] = {LinkFlagSkip, 0, "", {}};
    a.Hear(data);
    EXPECT_EQ(Acknowledgement().Delivered, LinkBitmap{});
}

TEST_F(LinkReceiverRules, hello_of_a_peer_that_does_not_know_this_life_is_answered_at_once)
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
    EXPECT_EQ(hellos[0].Fields.Incarnation, NodeUnderTest::FirstLife);
    EXPECT_EQ(hellos[0].Fields.YourIncarnation, b.Life);
}

// Rule R4

TEST_F(LinkReceiverRules, R4_a_repeated_message_is_acknowledged_only)
{
    OpenSession();
    a.Hear(Data(1, {"1"}));
    EXPECT_THAT(Texts(), IsEmpty());
    a.Pass(2ms);
    ASSERT_THAT(a.TakeAcks(), SizeIs(1));
    EXPECT_EQ(a.ReceiverCounters().Duplicates, 1U);
}

TEST_F(LinkReceiverRules, R4_a_message_after_a_gap_is_acknowledged_only)
{
    OpenSession();
    a.Hear(Data(3, {"3"}));
    EXPECT_THAT(Texts(), IsEmpty());
    a.Pass(2ms);
    EXPECT_EQ(a.TakeAcks().at(0).Fields.Cumulative, 1U);
}

TEST_F(LinkReceiverRules, R4_new_messages_behind_repeated_ones_in_a_datagram_are_delivered)
{
    OpenSession();
    a.Hear(Data(1, {"1", "2", "3"}));
    EXPECT_THAT(Texts(), ElementsAre("2", "3"));
}

// Rule R5

TEST_F(LinkReceiverRules, R5_a_message_with_an_expiry_needs_an_echo_of_my_clock)
{
    OpenSession();
    StoredData data = Data(2, {"2"});
    data.Fields.Echo.Clock += 1;
    data.Items[0].TtlLeft = LinkTime(1h).count();
    a.Hear(data);
    EXPECT_THAT(Texts(), IsEmpty());
    EXPECT_EQ(Acknowledgement().Cumulative, 1U);
    EXPECT_EQ(a.ReceiverCounters().HeldBackLate, 1U);
    data.Items[0].TtlLeft = LinkNoExpiry;
    a.Hear(data);
    EXPECT_THAT(Texts(), ElementsAre("2")) << "one without an expiry does not";
}

// Rule R6

TEST_F(LinkReceiverRules, R6_a_message_that_may_have_expired_on_the_way_is_not_delivered)
{
    OpenSession();
    StoredData data = Data(2, {"2"});
    data.Fields.Echo.HeldFor = LinkTime(30ms).count();
    data.Items[0].TtlLeft = LinkTime(70ms).count();
    a.Now += 100ms;  // 70 ms of them in transit
    a.Hear(data);
    EXPECT_THAT(Texts(), IsEmpty());
    const LinkAck ack = Acknowledgement();
    EXPECT_EQ(ack.Cumulative, 1U) << "the sender says when it has expired";
    EXPECT_EQ(ack.Time, a.Now.count()) << "a fresh token";
}

TEST_F(LinkReceiverRules, R6_a_message_with_time_left_is_delivered)
{
    OpenSession();
    StoredData data = Data(2, {"2"});
    data.Fields.Echo.HeldFor = LinkTime(30ms).count();
    data.Items[0].TtlLeft = LinkTime(71ms).count();
    a.Now += 100ms;
    a.Hear(data);
    EXPECT_THAT(Texts(), ElementsAre("2"));
}

TEST_F(LinkReceiverRules, R6_allows_for_the_drift_of_the_two_clocks)
{
    OpenSession();
    StoredData data = Data(2, {"2"});
    data.Fields.Echo.HeldFor = LinkTime(100s).count();
    data.Items[0].TtlLeft = LinkTime(100ms).count();
    a.Now += 100s;  // none of it in transit, as it seems; but 100 s held may have been 100.1 s
    a.Hear(data);
    EXPECT_THAT(Texts(), IsEmpty());
}

TEST_F(LinkReceiverRules, R6_a_skip_is_consumed_and_not_delivered)
{
    OpenSession();
    StoredData data = Data(2, {"2", "3"});
    data.Items[0] = {LinkFlagSkip, 0, "", {}};
    a.Hear(data);
    EXPECT_THAT(Texts(), ElementsAre("3"));
    a.Pass(2ms);
    const auto acks = a.TakeAcks();
    ASSERT_THAT(acks, SizeIs(1));
    EXPECT_EQ(acks[0].Fields.Cumulative, 3U);
    EXPECT_EQ(acks[0].Fields.Delivered[0], 0b101U);
    EXPECT_EQ(acks[0].Fields.Refused[0], 0U);
}

// Rule R7

TEST_F(LinkReceiverRules, R7_a_full_queue_holds_the_stream_back_and_gives_no_credit)
{
    OpenSession();
    a.Answer = LocalQueueResult::Full;
    a.RoomLeft = 0;
    a.Hear(Data(2, {"2", "3"}));
    const LinkAck ack = Acknowledgement();
    EXPECT_EQ(ack.Cumulative, 1U);
    EXPECT_EQ(ack.Credit, 0U);
    EXPECT_TRUE(a.ReceiverCounters().HeldBack);
    EXPECT_EQ(a.ReceiverCounters().HeldBackFull, 1U) << "what comes behind is not even tried";
}

TEST_F(LinkReceiverRules, R7_room_is_made_known)
{
    OpenSession();
    a.Answer = LocalQueueResult::Full;
    a.RoomLeft = 0;
    a.Hear(Data(2, {"2"}));
    Acknowledgement();
    a.RoomLeft = 4;
    a.Node->OnRoom("other", a.Now);
    a.Pass(100ms);
    EXPECT_THAT(a.TakeAcks(), IsEmpty());
    a.Node->OnRoom("q", a.Now);
    a.Pass(2ms);
    const auto acks = a.TakeAcks();
    ASSERT_THAT(acks, SizeIs(1));
    EXPECT_EQ(acks[0].Fields.Credit, 4U);
    a.Node->OnRoom("q", a.Now);
    a.Pass(100ms);
    EXPECT_THAT(a.TakeAcks(), IsEmpty()) << "once is enough";
}

// Rule R8

TEST_F(LinkReceiverRules, R8_delivers_in_order_with_source_queue_and_type)
{
    a.Hear(Data(1, {"1", "2"}));
    a.Hear(Data(3, {"3"}));
    EXPECT_THAT(a.TakeDelivered(),
                ElementsAre(DeliveredMessage{"b", "q", "T", "1"}, DeliveredMessage{"b", "q", "T", "2"},
                            DeliveredMessage{"b", "q", "T", "3"}));
}

TEST_F(LinkReceiverRules, R8_passes_on_the_redelivered_mark)
{
    StoredData data = Data(1, {"1"});
    data.Items[0].Flags = LinkFlagRedelivered;
    a.Hear(data);
    EXPECT_THAT(a.TakeDelivered(), ElementsAre(DeliveredMessage{"b", "q", "T", "1", true}));
}

TEST_F(LinkReceiverRules, R8_combines_acknowledgements_for_two_milliseconds)
{
    OpenSession();
    a.Hear(Data(2, {"2"}));
    a.Pass(1ms);
    a.Hear(Data(3, {"3"}));
    EXPECT_THAT(a.TakeAcks(), IsEmpty());
    a.Pass(1ms);
    const auto acks = a.TakeAcks();
    ASSERT_THAT(acks, SizeIs(1));
    EXPECT_EQ(acks[0].Fields.Cumulative, 3U);
    EXPECT_EQ(acks[0].Fields.Delivered[0], 0b111U);
    EXPECT_EQ(acks[0].Fields.Credit, 256U) << "room for 1000, told up to the largest window";
}

TEST_F(LinkReceiverRules, R8_acknowledges_at_once_after_sixteen_messages)
{
    OpenSession();
    a.Hear(Data(2, std::vector<std::string>(16, "m")));
    EXPECT_EQ(Acknowledgement().Cumulative, 17U);
}

TEST_F(LinkReceiverRules, R8_acknowledges_at_once_after_half_of_a_window_in_bytes)
{
    OpenSession();
    a.Hear(Data(2, std::vector<std::string>(3, std::string(32 * 1024, 'm'))));
    EXPECT_THAT(a.TakeAcks(), IsEmpty());
    a.Hear(Data(5, {std::string(32 * 1024, 'm')}));
    EXPECT_EQ(Acknowledgement().Cumulative, 5U);
}

TEST_F(LinkReceiverRules, undeliverable_messages_are_consumed_and_the_sender_learns_of_it)
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
    EXPECT_EQ(acks[0].Fields.Cumulative, 5U);
    EXPECT_EQ(acks[0].Fields.Delivered[0], 0b10001U);
    EXPECT_EQ(acks[0].Fields.Refused[0], 0b01110U);
    EXPECT_EQ(a.ReceiverCounters().RefusedUnknown, 1U);
    EXPECT_EQ(a.ReceiverCounters().RefusedWrongType, 1U);
    EXPECT_EQ(a.ReceiverCounters().RefusedUndecodable, 1U);
}

}  // namespace
}  // namespace Rabit::Test
