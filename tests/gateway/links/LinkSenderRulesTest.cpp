// The sender's rules, one by one, against a peer that is played by hand.
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

std::string Numbered(int i)
{
    std::string text("m");
    text += std::to_string(i);
    return text;
}

// One of these fills a datagram.
std::string Large(int i)
{
    return Numbered(i) + std::string(1000, '.');
}

class LinkSenderRules : public testing::Test
{
protected:
    // Both have heard of each other, and the first message has brought the credit.
    void Contact(std::uint32_t credit = 100)
    {
        a.Hear(b.Hello());
        a.Enqueue("first");
        a.Pass(0ms);
        a.Hear(b.Ack(1, credit));
        a.TakeDatas();
        a.TakeOutcomes();
        a.TakeHellos();
    }
    std::vector<std::string> SentTexts()
    {
        std::vector<std::string> texts;
        for (const StoredData &data : a.TakeDatas())
        {
            for (const StoredItem &item : data.Items)
            {
                texts.emplace_back(item.Payload.begin(), item.Payload.end());
            }
        }
        return texts;
    }

    NodeUnderTest a;
    PlayedPeer b;
};

// Rule S1

TEST_F(LinkSenderRules, S1_refuses_when_full_by_count_and_changes_nothing_else)
{
    a.Configure({.Capacity = 2});
    EXPECT_EQ(a.Enqueue("1"), 1U);
    EXPECT_EQ(a.Enqueue("2"), 2U);
    const std::string before = a.Node->Describe();
    const LinkEnqueued third = a.Node->Enqueue("b", "q", "T", PayloadOf("3"), a.Now);
    EXPECT_FALSE(third.Accepted());
    EXPECT_EQ(third.Refusal, LinkRefusal::FullByCount);
    EXPECT_EQ(third.Id, 0U);
    EXPECT_EQ(a.SenderCounters().RefusedFullByCount, 1U);
    EXPECT_EQ(a.Node->Describe(), before);
}

TEST_F(LinkSenderRules, S1_refuses_when_full_by_bytes_and_says_when_it_could_never_fit)
{
    a.Configure({.CapacityBytes = 10});
    EXPECT_NE(a.Enqueue("12345678"), 0U);
    EXPECT_EQ(a.Node->Enqueue("b", "q", "T", PayloadOf("123"), a.Now).Refusal, LinkRefusal::FullByBytes);
    EXPECT_EQ(a.Node->Enqueue("b", "q", "T", PayloadOf("12345678901"), a.Now).Refusal, LinkRefusal::TooLarge);
    EXPECT_NE(a.Enqueue("12"), 0U) << "exactly full is not too full";
    EXPECT_EQ(a.SenderCounters().RefusedFullByBytes, 1U);
    EXPECT_EQ(a.SenderCounters().RefusedTooLarge, 1U);
}

TEST_F(LinkSenderRules, S1_accepts_again_when_outcomes_have_made_room)
{
    a.Configure({.Capacity = 1});
    Contact();
    EXPECT_NE(a.Enqueue("2"), 0U);
    EXPECT_EQ(a.Enqueue("3"), 0U);
    a.Pass(0ms);
    a.Hear(b.Ack(2));
    EXPECT_NE(a.Enqueue("3"), 0U);
}

TEST_F(LinkSenderRules, S1_refuses_impossible_names)
{
    EXPECT_EQ(a.Node->Enqueue("a", "q", "T", {}, a.Now).Refusal, LinkRefusal::BadName);
    EXPECT_EQ(a.Node->Enqueue("", "q", "T", {}, a.Now).Refusal, LinkRefusal::BadName);
    EXPECT_EQ(a.Node->Enqueue("b", "", "T", {}, a.Now).Refusal, LinkRefusal::BadName);
    EXPECT_EQ(a.Node->Enqueue("b", "q", "", {}, a.Now).Refusal, LinkRefusal::BadName);
    EXPECT_EQ(a.Node->Enqueue("b", std::string(256, 'q'), "T", {}, a.Now).Refusal, LinkRefusal::BadName);
    EXPECT_EQ(a.Node->Counters().RefusedBadName, 5U);
}

// Rule S2

TEST_F(LinkSenderRules, S2_sends_no_message_without_a_token_but_a_hello_that_asks_for_one)
{
    a.Enqueue("1");
    a.Live(1400ms);
    EXPECT_THAT(a.TakeDatas(), IsEmpty());
    EXPECT_THAT(a.TakeHellos(), SizeIs(6)) << "at 0, 40, 120, 280 and 600 ms, then every half second";
}

TEST_F(LinkSenderRules, S2_asks_for_a_token_every_half_second_while_nothing_pends)
{
    a.Configure({.Expire = 100ms});
    a.Enqueue("1");
    a.Live(1s);
    a.TakeHellos();
    a.Live(5s);
    EXPECT_THAT(a.TakeHellos(), SizeIs(10));
}

TEST_F(LinkSenderRules, S2_asks_quickly_for_the_token_of_a_peer_that_has_restarted)
{
    Contact();
    a.Live(3s);
    a.Node->HeardOf("b", b.Life + 1, a.Now);
    a.Enqueue("2");
    a.TakeHellos();
    a.Live(300ms);
    EXPECT_THAT(a.TakeHellos(), SizeIs(testing::Ge(4U)));
}

TEST_F(LinkSenderRules, S2_sends_the_first_message_as_soon_as_a_hello_brings_the_token)
{
    a.Enqueue("1");
    a.Pass(0ms);
    a.Hear(b.Hello());
    EXPECT_LE(a.Node->NextDue(), a.Now);
    a.Pass(0ms);
    const auto sent = a.TakeDatas();
    ASSERT_THAT(sent, SizeIs(1));
    EXPECT_EQ(sent[0].Fields.SenderIncarnation, NodeUnderTest::FirstLife);
    EXPECT_EQ(sent[0].Fields.ReceiverIncarnation, b.Life);
    EXPECT_EQ(sent[0].Fields.Base, 1U);
    EXPECT_EQ(sent[0].Fields.First, 1U);
    EXPECT_EQ(sent[0].Source, "a");
    EXPECT_EQ(sent[0].Destination, "b");
    EXPECT_EQ(sent[0].Queue, "q");
}

TEST_F(LinkSenderRules, S2_sends_only_the_first_message_as_a_probe_while_there_is_no_credit)
{
    a.Hear(b.Hello());
    a.Enqueue("1");
    a.Enqueue("2");
    a.Pass(0ms);
    EXPECT_THAT(SentTexts(), ElementsAre("1"));
}

TEST_F(LinkSenderRules, S2_sends_up_to_the_credit)
{
    Contact(2);
    for (const char *text : {"2", "3", "4", "5"})
    {
        a.Enqueue(text);
    }
    a.Pass(0ms);
    EXPECT_THAT(SentTexts(), ElementsAre("2", "3"));
    a.Hear(b.Ack(3, 1));
    a.Pass(0ms);
    EXPECT_THAT(SentTexts(), ElementsAre("4"));
}

TEST_F(LinkSenderRules, S2_probes_with_the_first_message_when_the_credit_is_used_up)
{
    Contact(0);
    a.Enqueue("2");
    a.Enqueue("3");
    a.Live(10s);
    const std::vector<std::string> sent = SentTexts();
    EXPECT_THAT(sent, testing::Each(std::string("2")));
    EXPECT_GE(sent.size(), 8U) << "at least one a second";
    EXPECT_LE(sent.size(), 20U);
}

TEST_F(LinkSenderRules, S2_resends_at_once_what_was_turned_away_when_credit_comes)
{
    Contact(3);
    for (const char *text : {"2", "3", "4"})
    {
        a.Enqueue(text);
    }
    a.Pass(0ms);
    EXPECT_THAT(SentTexts(), ElementsAre("2", "3", "4"));
    a.Hear(b.Ack(2, 0));
    a.Pass(0ms);
    EXPECT_THAT(SentTexts(), IsEmpty());
    a.Hear(b.Ack(2, 2));
    a.Pass(0ms);
    EXPECT_THAT(SentTexts(), ElementsAre("3", "4"));
}

TEST_F(LinkSenderRules, S2_keeps_no_more_than_the_window_unacknowledged)
{
    a.Configure({.Window = 3});
    Contact();
    for (int i = 2; i < 10; ++i)
    {
        a.Enqueue(std::to_string(i));
    }
    a.Pass(0ms);
    EXPECT_THAT(SentTexts(), ElementsAre("2", "3", "4"));
    a.Hear(b.Ack(3));
    a.Pass(0ms);
    EXPECT_THAT(SentTexts(), ElementsAre("5", "6"));
}

TEST_F(LinkSenderRules, S2_keeps_no_more_than_the_window_in_bytes_unacknowledged)
{
    a.Configure({.WindowBytes = 10, .LargestWindowBytes = 10});
    Contact();
    a.Enqueue("1234");
    a.Enqueue("123456");
    a.Enqueue("1");
    a.Enqueue("a single larger message");
    a.Pass(0ms);
    EXPECT_THAT(SentTexts(), ElementsAre("1234", "123456"));
    a.Hear(b.Ack(3));
    a.Pass(0ms);
    EXPECT_THAT(SentTexts(), ElementsAre("1"));
    a.Hear(b.Ack(4));
    a.Pass(0ms);
    EXPECT_THAT(SentTexts(), ElementsAre("a single larger message"));
}

TEST_F(LinkSenderRules, S2_keeps_more_bytes_unacknowledged_while_the_round_trip_is_short)
{
    a.Configure({.WindowBytes = 10, .LargestWindowBytes = 40});
    Contact();
    for (int i = 0; i < 8; ++i)
    {
        a.Enqueue("12345");
    }
    a.Pass(0ms);
    EXPECT_THAT(SentTexts(), SizeIs(2));
    StoredAck ack = b.Ack(3);
    ack.Fields.EchoSentAt = a.Now.count();
    a.Pass(5ms);
    a.Hear(ack);
    a.Pass(0ms);
    EXPECT_THAT(SentTexts(), SizeIs(4));
}

TEST_F(LinkSenderRules, S2_keeps_the_smallest_window_after_a_long_round_trip_and_after_a_pause)
{
    a.Configure({.WindowBytes = 10, .LargestWindowBytes = 40});
    Contact();
    const auto fill = [this]
    {
        for (int i = 0; i < 4; ++i)
        {
            a.Enqueue("12345");
        }
        a.Pass(0ms);
        return SentTexts().size();
    };
    const auto acknowledge = [this](std::uint64_t cumulative, LinkTime after)
    {
        StoredAck ack = b.Ack(cumulative);
        ack.Fields.EchoSentAt = a.Now.count();
        a.Pass(after);
        a.TakeDatas();
        a.Hear(ack);
    };
    EXPECT_EQ(fill(), 2U);
    acknowledge(3, 5ms);
    a.Pass(0ms);
    EXPECT_THAT(SentTexts(), SizeIs(2)) << "the rest";
    acknowledge(5, 5ms);
    EXPECT_EQ(fill(), 4U) << "the window has grown";
    acknowledge(9, 11ms);
    EXPECT_EQ(fill(), 2U) << "a long round trip";
    acknowledge(11, 5ms);
    a.Pass(0ms);
    acknowledge(13, 5ms);
    a.Hear(b.Hello());
    a.Pass(3s);
    EXPECT_EQ(fill(), 2U) << "a pause";
}

TEST_F(LinkSenderRules, S2_resends_out_of_a_grown_window_as_soon_as_out_of_the_smallest)
{
    LinkSettings settings;
    settings.SlowPath = 10;  // bytes a second
    NodeUnderTest sender(settings);
    sender.Configure({.WindowBytes = 10, .LargestWindowBytes = 40});
    sender.Hear(b.Hello());
    sender.Enqueue("1");
    sender.Pass(0ms);
    sender.Hear(b.Ack(1));
    sender.Enqueue("12345");
    sender.Enqueue("12345");
    sender.Pass(0ms);
    StoredAck ack = b.Ack(3);
    ack.Fields.EchoSentAt = sender.Now.count();
    sender.Pass(5ms);
    sender.Hear(ack);
    for (int i = 0; i < 4; ++i)
    {
        sender.Enqueue("12345");
    }
    sender.Pass(0ms);
    ASSERT_EQ(sender.SenderCounters().Unacknowledged, 4U);
    sender.Live(900ms);
    EXPECT_EQ(sender.SenderCounters().MessagesResent, 0U);
    sender.Live(300ms);
    EXPECT_EQ(sender.SenderCounters().MessagesResent, 2U) << "10 bytes need a second, 20 would need two";
}

TEST_F(LinkSenderRules, S2_packs_waiting_messages_up_to_the_datagram_size)
{
    LinkSettings settings;
    settings.MaxDatagram = 1000;
    NodeUnderTest sender(settings);
    sender.Hear(b.Hello());
    sender.Enqueue("first");
    sender.Pass(0ms);
    sender.Hear(b.Ack(1));
    sender.TakeDatas();
    for (int i = 0; i < 20; ++i)
    {
        sender.Enqueue(std::string(100, 'x'));
    }
    sender.Enqueue(std::string(5000, 'y'));
    sender.Enqueue("z");
    sender.Pass(0ms);
    const auto sent = sender.TakeDatas();
    ASSERT_THAT(sent, SizeIs(6)) << "6, 6, 6, 2 of the small ones, the large one, the last";
    std::size_t messages = 0;
    for (const StoredData &data : sent)
    {
        EXPECT_EQ(data.Fields.First, 2 + messages) << "the messages are numbered through";
        messages += data.Items.size();
    }
    EXPECT_EQ(messages, 22U);
    EXPECT_GE(sent[0].Items.size(), 6U);
    EXPECT_LE(sent[0].Items.size(), 9U);
    EXPECT_THAT(sent[4].Items, SizeIs(1)) << "the large one goes alone";
}

TEST_F(LinkSenderRules, S2_echoes_the_newest_token_and_how_long_it_was_held)
{
    Contact();
    a.Pass(30ms);
    const StoredAck newest = b.Ack(1);
    StoredAck older = newest;
    older.Fields.Time -= 1;
    a.Hear(newest);
    a.Pass(10ms);
    a.Hear(older);
    a.Enqueue("2");
    a.Pass(5ms);
    const auto sent = a.TakeDatas();
    ASSERT_THAT(sent, SizeIs(1));
    EXPECT_EQ(sent[0].Fields.Echo.Clock, PlayedPeer::Clock);
    EXPECT_EQ(sent[0].Fields.Echo.Time, newest.Fields.Time);
    EXPECT_EQ(sent[0].Fields.Echo.HeldFor, LinkTime(15ms).count());
}

TEST_F(LinkSenderRules, S2_resends_only_the_first_datagrams_worth_and_ever_more_slowly)
{
    Contact();
    for (int i = 0; i < 10; ++i)
    {
        a.Enqueue(Large(i));
    }
    a.Pass(0ms);
    EXPECT_THAT(SentTexts(), SizeIs(10));
    a.Live(9s);
    const std::vector<std::string> resent = SentTexts();
    EXPECT_THAT(resent, testing::Each(Large(0)));
    EXPECT_THAT(resent, SizeIs(10)) << "after 0.2 s, then 0.4 s, then each second";
}

TEST_F(LinkSenderRules, S2_opens_the_window_again_as_acknowledgements_come)
{
    Contact();
    for (int i = 2; i <= 20; ++i)
    {
        a.Enqueue(Large(i));
    }
    a.Pass(0ms);
    a.TakeDatas();
    a.Live(500ms);
    a.TakeDatas();
    a.Hear(b.Ack(2));
    a.Pass(0ms);
    EXPECT_THAT(SentTexts(), ElementsAre(Large(3), Large(4)));
    a.Hear(b.Ack(4));
    a.Pass(0ms);
    EXPECT_THAT(SentTexts(), ElementsAre(Large(5), Large(6), Large(7), Large(8)));
}

TEST_F(LinkSenderRules, S2_after_the_resend_timer_new_messages_share_the_datagram_with_old_ones)
{
    Contact();
    a.Enqueue(Numbered(2));
    a.Pass(0ms);
    a.TakeDatas();
    a.Live(300ms);
    a.TakeDatas();
    a.Enqueue(Numbered(3));
    a.Pass(0ms);
    EXPECT_THAT(SentTexts(), ElementsAre("m3")) << "at once, although m2 is not acknowledged";
    a.Live(400ms);
    EXPECT_THAT(SentTexts(), ElementsAre("m2", "m3"));
}

TEST_F(LinkSenderRules, S2_a_hello_ends_the_wait_of_a_backed_off_timer)
{
    Contact();
    a.Enqueue("2");
    a.Live(8s);
    a.TakeDatas();
    while (SentTexts().empty())
    {
        a.Live(1ms);
    }
    a.Live(300ms);
    EXPECT_THAT(SentTexts(), IsEmpty());
    a.Hear(b.Hello());
    a.Pass(0ms);
    EXPECT_THAT(SentTexts(), ElementsAre("2"));
}

TEST_F(LinkSenderRules, S2_a_silent_peer_gets_a_slow_hello_and_nothing_else)
{
    Contact();
    a.Enqueue("2");
    a.Live(11s);
    a.TakeDatas();
    a.TakeHellos();
    a.Live(100s);
    EXPECT_THAT(a.TakeDatas(), IsEmpty());
    EXPECT_THAT(a.TakeHellos(), SizeIs(testing::AllOf(testing::Ge(49U), testing::Le(51U))));
    a.Hear(b.Hello());
    a.Pass(0ms);
    EXPECT_THAT(SentTexts(), ElementsAre("2"));
}

TEST_F(LinkSenderRules, S2_a_silent_peer_with_nothing_pending_costs_nothing_until_something_is_enqueued)
{
    Contact();
    a.Live(15s);
    EXPECT_EQ(a.Node->NextDue(), LinkNever);
    a.TakeHellos();
    a.Enqueue("2");
    a.Pass(0ms);
    EXPECT_THAT(a.TakeHellos(), SizeIs(1));
}

// Rule S3

TEST_F(LinkSenderRules, S3_a_message_that_expires_after_it_was_sent_is_sent_as_skip_with_its_number)
{
    a.Configure({.Expire = 1s});
    Contact();
    const std::uint64_t id = a.Enqueue("2");
    a.Pass(400ms);
    const auto before = a.TakeDatas();
    ASSERT_THAT(before, SizeIs(1));
    EXPECT_EQ(before[0].Items[0].TtlLeft, LinkTime(600ms).count());
    a.Pass(600ms);
    const auto after = a.TakeDatas();
    ASSERT_THAT(after, SizeIs(1));
    EXPECT_EQ(after[0].Fields.First, 2U);
    EXPECT_EQ(after[0].Items[0].Flags, LinkFlagSkip);
    EXPECT_THAT(after[0].Items[0].Payload, IsEmpty());
    EXPECT_THAT(a.TakeOutcomes(), IsEmpty()) << "it may have been delivered";
    a.Hear(b.Ack(2, 100, {2}));
    EXPECT_THAT(a.TakeOutcomes(), ElementsAre(Pair(id, LinkOutcome::Expired)));
}

TEST_F(LinkSenderRules, S3_a_message_that_expires_before_it_was_sent_ends_at_once)
{
    a.Configure({.Expire = 1s});
    const std::uint64_t id = a.Enqueue("1");
    EXPECT_EQ(a.Node->NextDue(), a.Now) << "the hello";
    a.Pass(999999us);
    EXPECT_THAT(a.TakeOutcomes(), IsEmpty());
    EXPECT_LE(a.Node->NextDue(), a.Now + 1us);
    a.Pass(1us);
    EXPECT_THAT(a.TakeOutcomes(), ElementsAre(Pair(id, LinkOutcome::Expired)));
}

// Rule S4

TEST_F(LinkSenderRules, S4_each_acknowledged_message_gets_the_outcome_of_its_bit)
{
    Contact();
    for (const char *text : {"2", "3", "4", "5"})
    {
        a.Enqueue(text);
    }
    a.Pass(0ms);
    a.Hear(b.Ack(4, 100, {3}, {4}));
    EXPECT_THAT(a.TakeOutcomes(), ElementsAre(Pair(2, LinkOutcome::Delivered), Pair(3, LinkOutcome::Expired),
                                              Pair(4, LinkOutcome::RefusedThere)));
    EXPECT_EQ(a.SenderCounters().Pending, 1U);
}

TEST_F(LinkSenderRules, S4_a_repeated_or_overtaken_acknowledgement_changes_no_outcome)
{
    Contact();
    a.Enqueue("2");
    a.Enqueue("3");
    a.Pass(0ms);
    const StoredAck old = b.Ack(2);
    const StoredAck newer = b.Ack(3);
    a.Hear(newer);
    EXPECT_THAT(a.TakeOutcomes(), SizeIs(2));
    a.Hear(old);
    a.Hear(newer);
    EXPECT_THAT(a.TakeOutcomes(), IsEmpty());
}

TEST_F(LinkSenderRules, S4_an_overtaken_acknowledgement_gives_no_credit)
{
    Contact(100);
    const StoredAck old = b.Ack(1, 100);
    a.Hear(b.Ack(1, 0));
    a.Hear(old);
    a.Enqueue("2");
    a.Enqueue("3");
    a.Pass(0ms);
    EXPECT_THAT(SentTexts().size(), testing::Le(1U)) << "a probe at most";
}

TEST_F(LinkSenderRules, S4_an_acknowledgement_of_another_stream_only_brings_a_token)
{
    a.Hear(b.Hello());
    a.Enqueue("1");
    a.Pass(0ms);
    StoredAck ack = b.Ack(1);
    ack.Fields.SenderIncarnation = NodeUnderTest::FirstLife - 1;
    a.Hear(ack);
    EXPECT_THAT(a.TakeOutcomes(), IsEmpty());
    EXPECT_EQ(a.SenderCounters().Pending, 1U);
}

TEST_F(LinkSenderRules, S4_measures_the_round_trip_by_the_echoed_time_less_what_it_was_held)
{
    Contact();
    for (int i = 2; i < 40; ++i)
    {
        a.Enqueue("m");
        a.Pass(0ms);
        StoredAck ack = b.Ack(static_cast<std::uint64_t>(i));
        ack.Fields.EchoSentAt = a.Now.count();
        ack.Fields.EchoHeldFor = LinkTime(30ms).count();
        a.Now += 110ms;
        a.Hear(ack);
    }
    EXPECT_GE(a.SenderCounters().RoundTrip, 75ms);
    EXPECT_LE(a.SenderCounters().RoundTrip, 81ms);
    a.TakeDatas();
    a.Enqueue("m");
    a.Pass(0ms);
    a.TakeDatas();
    a.Pass(79ms);
    EXPECT_THAT(a.TakeDatas(), IsEmpty()) << "not resent before the round trip is over";
}

TEST_F(LinkSenderRules, S4_an_echo_that_cannot_be_measures_nothing)
{
    Contact();
    a.Enqueue("m");
    a.Pass(0ms);
    StoredAck ack = b.Ack(2);
    ack.Fields.EchoSentAt = (a.Now + 1s).count();
    a.Hear(ack);
    EXPECT_EQ(a.SenderCounters().RoundTrip, 0ns);
}

TEST_F(LinkSenderRules, S4_learns_a_round_trip_longer_than_the_timer)
{
    Contact();
    std::uint64_t acknowledged = 1;
    for (int i = 0; i < 10; ++i)
    {
        a.Enqueue("m");
        a.Pass(0ms);
        a.Live(300ms);
        a.Hear(b.Ack(++acknowledged));
    }
    a.TakeDatas();
    a.Enqueue("m");
    a.Live(299ms);
    EXPECT_THAT(SentTexts(), ElementsAre("m")) << "no longer sent twice";
}

// Rule S5

TEST_F(LinkSenderRules, S5_a_receiver_in_a_new_life_puts_what_was_sent_in_doubt_and_continues_with_the_rest)
{
    Contact(1);
    a.Enqueue("2");
    a.Enqueue("3");
    a.Pass(0ms);
    EXPECT_THAT(SentTexts(), ElementsAre("2"));
    b.Life += 1ULL << 32;
    StoredAck ack = b.Ack(0, 50);
    ack.Fields.SenderIncarnation = 0;
    a.Hear(ack);
    EXPECT_THAT(a.TakeOutcomes(), ElementsAre(Pair(2, LinkOutcome::InDoubt)));
    a.Pass(0ms);
    const auto sent = a.TakeDatas();
    ASSERT_THAT(sent, SizeIs(1));
    EXPECT_EQ(sent[0].Fields.ReceiverIncarnation, b.Life);
    EXPECT_EQ(sent[0].Fields.Base, 3U);
    EXPECT_EQ(sent[0].Fields.First, 3U);
    EXPECT_EQ(a.SenderCounters().Restarts, 1U);
    EXPECT_EQ(a.Node->Counters().PeerRestarts, 1U);
}

TEST_F(LinkSenderRules, S5_a_hello_tells_of_the_new_life_as_well)
{
    Contact();
    a.Enqueue("2");
    a.Pass(0ms);
    b.Life += 1;
    a.Hear(b.Hello());
    EXPECT_THAT(a.TakeOutcomes(), ElementsAre(Pair(2, LinkOutcome::InDoubt)));
}

TEST_F(LinkSenderRules, S5_a_new_life_that_something_else_heard_of_gets_nothing_before_the_links_know_it)
{
    Contact();
    a.Enqueue("2");
    a.Pass(0ms);
    a.TakeDatas();
    a.Node->HeardOf("b", b.Life + 1, a.Now);
    a.Enqueue("3");
    a.Pass(0ms);
    EXPECT_THAT(a.TakeDatas(), IsEmpty());
    EXPECT_EQ(a.SenderCounters().InDoubt, 1U) << "what was sent to the life before";
    EXPECT_EQ(a.SenderCounters().Pending, 1U) << "what was not";
}

TEST_F(LinkSenderRules, S5_what_something_else_heard_of_an_older_life_changes_nothing)
{
    Contact();
    a.Enqueue("2");
    a.Pass(0ms);
    a.Node->HeardOf("b", b.Life - 1, a.Now);
    EXPECT_EQ(a.SenderCounters().InDoubt, 0U);
}

TEST_F(LinkSenderRules, S5_the_token_of_the_old_life_is_forgotten)
{
    Contact();
    b.Life += 1;
    a.Hear(b.Data(1, {"x"}, a.Now));  // tells of the new life, and brings no token
    a.TakeDelivered();
    a.Enqueue("2");
    a.Pass(0ms);
    EXPECT_THAT(SentTexts(), IsEmpty());
    a.Hear(b.Hello());
    a.Pass(0ms);
    EXPECT_THAT(SentTexts(), ElementsAre("2"));
}

TEST_F(LinkSenderRules, S5_the_credit_of_the_old_life_is_forgotten)
{
    Contact(100);
    b.Life += 1;
    a.Hear(b.Hello());
    a.Enqueue("2");
    a.Enqueue("3");
    a.Pass(0ms);
    EXPECT_THAT(SentTexts(), ElementsAre("2"));
}

TEST_F(LinkSenderRules, S5_the_clock_of_the_new_life_may_read_less_than_that_of_the_old_one)
{
    Contact(100);
    b.Life += 1;
    b.Time = 5;
    a.Hear(b.Hello());
    for (const char *text : {"2", "3", "4"})
    {
        a.Enqueue(text);
    }
    a.Pass(0ms);
    EXPECT_THAT(SentTexts(), ElementsAre("2"));
    a.Hear(b.Ack(2, 10));
    a.Pass(0ms);
    EXPECT_THAT(SentTexts(), ElementsAre("3", "4"));
}

TEST_F(LinkSenderRules, S5_a_queue_that_opted_in_gets_what_was_in_doubt_again_marked_and_in_order)
{
    a.Configure({.RedeliverInDoubt = true});
    Contact(2);
    for (const char *text : {"2", "3", "4"})
    {
        a.Enqueue(text);
    }
    a.Pass(0ms);
    a.TakeDatas();
    b.Life += 1;
    a.Hear(b.Hello());
    EXPECT_THAT(a.TakeOutcomes(), IsEmpty());
    a.Pass(0ms);
    auto sent = a.TakeDatas();
    ASSERT_THAT(sent, SizeIs(1));
    EXPECT_EQ(sent[0].Fields.First, 4U) << "new numbers";
    a.Hear(b.Ack(4));
    a.Pass(0ms);
    sent = a.TakeDatas();
    ASSERT_THAT(sent, SizeIs(1));
    ASSERT_THAT(sent[0].Items, SizeIs(2));
    EXPECT_EQ(sent[0].Items[0].Flags, LinkFlagRedelivered);
    EXPECT_EQ(sent[0].Items[1].Flags, 0) << "that one was never sent before";
    a.Hear(b.Ack(6, 100, {5}));
    EXPECT_THAT(a.TakeOutcomes(), ElementsAre(Pair(2, LinkOutcome::Delivered), Pair(3, LinkOutcome::InDoubt),
                                              Pair(4, LinkOutcome::Delivered)));
}

TEST_F(LinkSenderRules, S5_an_acknowledgement_of_an_older_life_is_ignored_and_answered_with_a_hello)
{
    Contact();
    a.Enqueue("2");
    a.Pass(1s);
    a.TakeHellos();
    a.Pass(30ms);
    StoredAck old = b.Ack(2);
    old.Fields.ReceiverIncarnation -= 1;
    a.Hear(old);
    EXPECT_THAT(a.TakeOutcomes(), IsEmpty());
    a.Pass(0ms);
    const auto hellos = a.TakeHellos();
    ASSERT_THAT(hellos, SizeIs(1));
    EXPECT_EQ(hellos[0].Fields.YourIncarnation, b.Life);
}

// Rule S6

TEST_F(LinkSenderRules, S6_a_peer_that_knows_a_higher_life_of_mine_makes_me_take_a_yet_higher_one)
{
    Contact(1);
    a.Enqueue("2");
    a.Enqueue("3");
    a.Pass(0ms);
    a.TakeDatas();
    const std::uint64_t known = NodeUnderTest::FirstLife + (9ULL << 32);
    StoredAck ack = b.Ack(0);
    ack.Fields.SenderIncarnation = known;
    ack.Fields.Cumulative = 77;
    ack.Fields.YourIncarnation = known;
    a.Hear(ack);
    EXPECT_GT(a.Node->Incarnation(), known);
    EXPECT_THAT(a.TakeOutcomes(), ElementsAre(Pair(2, LinkOutcome::InDoubt)));
    a.Pass(0ms);
    const auto sent = a.TakeDatas();
    ASSERT_THAT(sent, SizeIs(1));
    EXPECT_EQ(sent[0].Fields.SenderIncarnation, a.Node->Incarnation());
    EXPECT_EQ(sent[0].Fields.Base, 3U);
}

TEST_F(LinkSenderRules, S6_raises_the_alarm_when_it_repeats)
{
    for (int i = 0; i < 3; ++i)
    {
        EXPECT_FALSE(a.Node->NameInUseElsewhere());
        b.KnownLife = a.Node->Incarnation() + 1;
        a.Hear(b.Hello());
        a.Pass(LinkSettings().RaiseGap);
    }
    EXPECT_TRUE(a.Node->NameInUseElsewhere());
    EXPECT_EQ(a.Node->Counters().Raises, 3U);
}

TEST_F(LinkSenderRules, S6_a_foolish_peer_cannot_have_all_sessions_dropped_again_and_again)
{
    Contact(1);
    const LinkTime start = a.Now;
    for (int i = 0; i < 100; ++i)
    {
        b.KnownLife = a.Node->Incarnation() + 1;
        a.Hear(b.Hello());
        a.Pass(50ms);
    }
    ASSERT_EQ(a.Now - start, LinkSettings().RaiseGap);
    EXPECT_EQ(a.Node->Counters().Raises, 1U);
    EXPECT_EQ(a.Node->Counters().RaisesPutOff, 99U);
    a.Hear(b.Hello());
    EXPECT_EQ(a.Node->Counters().Raises, 2U) << "what is still so after the gap is heeded";
}

TEST_F(LinkSenderRules, S6_one_false_hello_does_not_use_up_the_numbers_of_later_lives)
{
    Contact(1);
    const std::uint64_t before = a.Node->Incarnation();
    b.KnownLife = 0xfffffffdULL << 32;
    a.Hear(b.Hello());
    EXPECT_EQ(a.Node->Incarnation(), before);
    EXPECT_EQ(a.Node->Counters().FalseClaims, 1U);
    b.KnownLife = static_cast<std::uint64_t>(LinkLargestClaim) << 32;
    a.Hear(b.Hello());
    EXPECT_GT(a.Node->Incarnation(), b.KnownLife) << "a number that a life could have had";
}

TEST_F(LinkSenderRules, close_gives_every_pending_message_an_outcome)
{
    Contact(1);
    a.Enqueue("2");
    a.Enqueue("3");
    a.Pass(0ms);
    a.Node->Close();
    EXPECT_THAT(a.TakeOutcomes(), ElementsAre(Pair(2, LinkOutcome::InDoubt), Pair(3, LinkOutcome::Expired)));
    EXPECT_EQ(a.SenderCounters().Pending, 0U);
}

}  // namespace
}  // namespace Rabit::Test
