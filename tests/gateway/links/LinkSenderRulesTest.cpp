// The sender's rules, one by one, against a peer that is played by hand.
#include "NodeUnderTest.h"

#include <rabit/gateway/links/LinkFrameCodec.h>

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

// Returns a message that fills a datagram.
std::string Large(int i)
{
    return Numbered(i) + std::string(1250, '.');
}

class LinkSenderRules : public testing::Test
{
protected:
    // Both nodes have heard of each other, and the first message has brought the credit.
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
        for (const StoredFrame &data : a.TakeDatas())
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

TEST_F(LinkSenderRules, S1_RefusesWhenFullByCountAndChangesNothingElse)
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

TEST_F(LinkSenderRules, S1_RefusesWhenFullByBytesAndSaysWhenItCouldNeverFit)
{
    a.Configure({.CapacityBytes = 10});
    EXPECT_NE(a.Enqueue("12345678"), 0U);
    EXPECT_EQ(a.Node->Enqueue("b", "q", "T", PayloadOf("123"), a.Now).Refusal, LinkRefusal::FullByBytes);
    EXPECT_EQ(a.Node->Enqueue("b", "q", "T", PayloadOf("12345678901"), a.Now).Refusal, LinkRefusal::TooLarge);
    EXPECT_NE(a.Enqueue("12"), 0U) << "exactly full is not too full";
    EXPECT_EQ(a.SenderCounters().RefusedFullByBytes, 1U);
    EXPECT_EQ(a.SenderCounters().RefusedTooLarge, 1U);
}

TEST_F(LinkSenderRules, S1_SaysHowFullItIsByWhatIsFuller)
{
    a.Configure({.Capacity = 4, .CapacityBytes = 10});
    EXPECT_NE(a.Enqueue("1"), 0U);
    EXPECT_EQ(a.SenderCounters().Fill, 0.25);
    EXPECT_NE(a.Enqueue("1234567"), 0U);
    EXPECT_EQ(a.SenderCounters().Fill, 0.8);
}

TEST_F(LinkSenderRules, S1_AcceptsAgainWhenOutcomesHaveMadeRoom)
{
    a.Configure({.Capacity = 1});
    Contact();
    EXPECT_NE(a.Enqueue("2"), 0U);
    EXPECT_EQ(a.Enqueue("3"), 0U);
    a.Pass(0ms);
    a.Hear(b.Ack(2));
    EXPECT_NE(a.Enqueue("3"), 0U);
}

TEST_F(LinkSenderRules, S1_RefusesImpossibleNames)
{
    EXPECT_EQ(a.Node->Enqueue("a", "q", "T", {}, a.Now).Refusal, LinkRefusal::BadName);
    EXPECT_EQ(a.Node->Enqueue("", "q", "T", {}, a.Now).Refusal, LinkRefusal::BadName);
    EXPECT_EQ(a.Node->Enqueue("b", "", "T", {}, a.Now).Refusal, LinkRefusal::BadName);
    EXPECT_EQ(a.Node->Enqueue("b", "q", "", {}, a.Now).Refusal, LinkRefusal::BadName);
    EXPECT_EQ(a.Node->Enqueue("b", std::string(256, 'q'), "T", {}, a.Now).Refusal, LinkRefusal::BadName);
    EXPECT_EQ(a.Node->Counters().RefusedBadName, 5U);
}

// Rule S2

TEST_F(LinkSenderRules, S2_SendsNoMessageWithoutATokenButAHelloThatAsksForOne)
{
    a.Enqueue("1");
    a.Live(1400ms);
    EXPECT_THAT(a.TakeDatas(), IsEmpty());
    EXPECT_THAT(a.TakeHellos(), SizeIs(8)) << "at 0, 40, 120 and 280 ms, then every quarter of a second";
}

TEST_F(LinkSenderRules, S2_SaysNothingWhileNothingWaits)
{
    a.Configure({.Expire = 100ms});
    a.Enqueue("1");
    a.Live(1s);
    a.TakeHellos();
    EXPECT_EQ(a.Node->NextDue(), LinkNever);
    a.Live(1h);
    EXPECT_THAT(a.TakeHellos(), IsEmpty());
}

TEST_F(LinkSenderRules, S2_AsksQuicklyForTheTokenOfAPeerThatHasRestarted)
{
    Contact();
    a.Live(3s);
    a.Node->HeardOf("b", b.Life + 1, a.Now);
    a.Enqueue("2");
    a.TakeHellos();
    a.Live(300ms);
    EXPECT_THAT(a.TakeHellos(), SizeIs(testing::Ge(4U)));
}

TEST_F(LinkSenderRules, S2_SendsTheFirstMessageAsSoonAsAHelloBringsTheToken)
{
    a.Enqueue("1");
    a.Pass(0ms);
    a.Hear(b.Hello());
    EXPECT_LE(a.Node->NextDue(), a.Now);
    a.Pass(0ms);
    const auto sent = a.TakeDatas();
    ASSERT_THAT(sent, SizeIs(1));
    EXPECT_EQ(sent[0].Fields.SenderLife, NodeUnderTest::FirstLife);
    EXPECT_EQ(sent[0].Fields.ReceiverLife, b.Life);
    EXPECT_EQ(sent[0].Fields.Data.Oldest, 1U);
    EXPECT_EQ(sent[0].Items.at(0).Fields.Sequence, 1U);
    EXPECT_EQ(sent[0].Source, "a");
    EXPECT_EQ(sent[0].Destination, "b");
    EXPECT_EQ(sent[0].Queue, "q");
}

TEST_F(LinkSenderRules, S2_SendsOnlyTheFirstMessageAsAProbeWhileThereIsNoCredit)
{
    a.Hear(b.Hello());
    a.Enqueue("1");
    a.Enqueue("2");
    a.Pass(0ms);
    EXPECT_THAT(SentTexts(), ElementsAre("1"));
}

TEST_F(LinkSenderRules, S2_RepeatsAnUnansweredFirstMessageAsAnyLostOneAndNotAsOneTurnedAway)
{
    StoredFrame hello = b.Hello();
    hello.Fields.Echo = {PlayedPeer::ClockOfA, a.Now.count(), 0};
    a.Hear(hello);
    a.Enqueue("1");
    a.Live(500ms);
    EXPECT_GE(SentTexts().size(), 20U) << "each 20 ms: the timer of a quick path doubles twice";
}

TEST_F(LinkSenderRules, S2_SendsUpToTheCredit)
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

TEST_F(LinkSenderRules, S2_ProbesWithTheFirstMessageWhenTheCreditIsUsedUp)
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

TEST_F(LinkSenderRules, S2_TellsThatTheReceiverHoldsTheStreamBack)
{
    Contact();
    a.Enqueue("2");
    a.Enqueue("3");
    a.Pass(0ms);
    EXPECT_FALSE(a.SenderCounters().HeldBack) << "it may be on its way";
    a.Hear(b.AckWith(1, {3}));
    EXPECT_FALSE(a.SenderCounters().HeldBack) << "it was lost";
    a.Hear(b.AckWith(1, {2, 3}));
    EXPECT_TRUE(a.SenderCounters().HeldBack);
    a.Hear(b.Ack(3));
    EXPECT_FALSE(a.SenderCounters().HeldBack);
}

TEST_F(LinkSenderRules, S2_ResendsWhatWasTurnedAwayOnlyWhenCreditComes)
{
    Contact(3);
    for (const char *text : {"2", "3", "4"})
    {
        a.Enqueue(text);
    }
    a.Pass(0ms);
    EXPECT_THAT(SentTexts(), ElementsAre("2", "3", "4"));
    const LinkTime sentAt = a.Now;
    a.Now += 1ms;
    StoredFrame full = b.Ack(2, 0);
    full.Fields.Echo = {PlayedPeer::ClockOfA, sentAt.count(), 0};
    a.Hear(full);
    a.Live(4ms);
    EXPECT_THAT(SentTexts(), IsEmpty());
    a.Hear(b.Ack(2, 2));
    a.Pass(0ms);
    EXPECT_THAT(SentTexts(), ElementsAre("3", "4"));
}

TEST_F(LinkSenderRules, S2_DoesNotResendWhatTheReceiverHolds)
{
    Contact();
    for (int i = 2; i <= 5; ++i)
    {
        a.Enqueue(Large(i));
    }
    a.Pass(0ms);
    ASSERT_THAT(SentTexts(), SizeIs(4));
    const LinkTime sentAt = a.Now;
    a.Now += 10ms;
    StoredFrame ack = b.AckWith(1, {3, 4});
    ack.Fields.Echo = {PlayedPeer::ClockOfA, sentAt.count(), 0};
    a.Hear(ack);
    a.Live(20ms);
    EXPECT_THAT(SentTexts(), ElementsAre(Large(2), Large(5)))
        << "each in its own datagram, after the time for reordering";
    EXPECT_THAT(a.TakeOutcomes(), IsEmpty()) << "what is held is not delivered yet";
}

TEST_F(LinkSenderRules, S2_ResendsWhatTheReceiverHoldsNoMore)
{
    Contact();
    for (int i = 2; i <= 4; ++i)
    {
        a.Enqueue(Large(i));
    }
    a.Pass(0ms);
    a.TakeDatas();
    a.Now += 10ms;
    a.Hear(b.AckWith(1, {4}));
    a.Hear(b.Ack(2));
    a.Pass(0ms);
    EXPECT_THAT(SentTexts(), ElementsAre(Large(4)));
}

TEST_F(LinkSenderRules, S2_WhatWasOvertakenIsLostAfterTheTimeForReorderingAndNotBefore)
{
    Contact();
    a.Enqueue("2");
    a.Pass(0ms);
    const LinkTime first = a.Now;
    a.Now += 1ms;
    a.Enqueue("3");
    a.Pass(0ms);
    a.TakeDatas();
    a.Now += 20ms;
    StoredFrame ack = b.AckWith(1, {3});
    ack.Fields.Echo = {PlayedPeer::ClockOfA, (first + 1ms).count(), 0};
    a.Hear(ack);
    a.Live(18ms);
    EXPECT_THAT(SentTexts(), IsEmpty()) << "a round trip of 20 ms varies by as much, so far as is known";
    a.Live(2ms);
    EXPECT_THAT(SentTexts(), ElementsAre("2"));
    a.Now += 45ms;
    ack.Fields.Time = b.Time += 1000;
    ack.Fields.Echo.HeldFor = (a.Now - first - 1ms - 20ms).count();
    a.Hear(ack);
    a.Pass(0ms);
    EXPECT_THAT(SentTexts(), IsEmpty()) << "nothing sent after it is known to have arrived";
}

TEST_F(LinkSenderRules, S2_WhatAPeerIsUsedToAnswerLateIsNotSentAgainMeanwhile)
{
    constexpr LinkTime held = 300ms;
    Contact();
    // The path takes next to nothing, and the peer has little budget.
    const auto answer = [&](std::uint64_t cumulative, LinkTime sentAt)
    {
        a.Live(held);
        StoredFrame ack = b.Ack(cumulative);
        ack.Fields.Echo = {PlayedPeer::ClockOfA, sentAt.count(), held.count()};
        a.Hear(ack);
    };
    for (std::uint64_t number = 2; number < 12; ++number)
    {
        a.Live(1s);
        a.Enqueue(Numbered(static_cast<int>(number)));
        a.Pass(0ms);
        const LinkTime sentAt = a.Now;
        answer(number, sentAt);
        const std::vector<std::string> sent = SentTexts();
        if (number > 6)  // five answers show what is usual
        {
            EXPECT_THAT(sent, SizeIs(1)) << number;
        }
    }
}

TEST_F(LinkSenderRules, S2_AnswersThatEachTakeLongerThanTheLongestBackoffAreWaitedFor)
{
    Contact();
    a.Pass(5s);
    std::size_t sent = 0;
    for (std::uint64_t number = 2; number < 12; ++number)
    {
        a.Live(1s);
        a.Enqueue(Numbered(static_cast<int>(number)));
        a.Pass(0ms);
        const LinkTime first = a.Now;
        a.Live(1400ms);  // The peer heard the repetitions, too, the last of them 400 ms ago.
        StoredFrame ack = b.Ack(number);
        ack.Fields.Echo = {PlayedPeer::ClockOfA, (first + 1s).count(), LinkTime(400ms).count()};
        a.Hear(ack);
        sent = SentTexts().size();
    }
    EXPECT_LE(sent, 2u) << "the last one, and once more after the longest backoff";
}

TEST_F(LinkSenderRules, S2_AnAnswerThatEchoesALaterFrameIsAnAnswerAndNoReasonToWaitForLong)
{
    Contact();
    a.Enqueue("2");
    a.Pass(0ms);
    const LinkTime asked = a.Now;
    // The peer echoes what came after the question, and much later another frame of it.
    a.Live(10ms);
    StoredFrame ack = b.Ack(2);
    ack.Fields.Echo = {PlayedPeer::ClockOfA, (asked + 7ms).count(), LinkTime(3ms).count()};
    a.Hear(ack);
    a.Live(60s);
    a.Enqueue("3");
    a.Pass(0ms);
    StoredFrame crossing = b.Hello();
    crossing.Fields.Echo = {PlayedPeer::ClockOfA, (asked + 8ms).count(), LinkTime(60s).count()};
    a.Hear(crossing);
    a.TakeDatas();
    a.Live(300ms);
    EXPECT_THAT(SentTexts(), testing::Contains("3")) << "nobody answers: it is sent again in time";
}

TEST_F(LinkSenderRules, S2_KeepsNoMoreThanTheWindowInPartsUnacknowledged)
{
    LinkSettings settings;
    settings.MaxDatagram = 300;
    NodeUnderTest sender(settings);
    sender.Hear(b.Hello());
    sender.Enqueue("1");
    sender.Pass(0ms);
    sender.Hear(b.Ack(1));
    sender.Enqueue(std::string(1000000, 'x'));
    std::size_t most = 0;
    for (int i = 0; i < 500; ++i)
    {
        sender.Pass(1ms);
        most = std::max(most, sender.SenderCounters().UnacknowledgedParts);
        std::vector<std::uint64_t> held;
        for (std::uint64_t part = 3; part < 2 + sender.SenderCounters().UnacknowledgedParts; ++part)
        {
            held.push_back(part);
        }
        sender.Hear(b.AckWith(1, held));
    }
    EXPECT_EQ(most, LinkWindowParts - 1);
}

TEST_F(LinkSenderRules, S2_WhatGoesAlongOnceMoreLeavesRoomForWhatIsNew)
{
    LinkSettings settings;
    settings.MaxDatagram = 200;
    NodeUnderTest sender(settings);
    const auto echo = [&](StoredFrame ack)
    {
        ack.Fields.Echo = {PlayedPeer::ClockOfA, sender.Now.count() - 20'000'000, 0};
        sender.Hear(ack);
    };
    sender.Hear(b.Hello());
    sender.Enqueue("1");
    sender.Pass(0ms);
    sender.Now += 20ms;
    echo(b.Ack(1));
    // Two of three datagrams are lost, and then retransmitted.
    for (int i = 2; i <= 4; ++i)
    {
        sender.Enqueue(std::string(150, '0'));
        sender.Live(3ms);
    }
    sender.Now += 40ms;
    echo(b.AckWith(1, {4}));
    sender.Live(60ms);
    echo(b.Ack(4));
    for (int i = 5; i <= 14; ++i)
    {
        sender.Enqueue(std::string(20, '1'));
    }
    sender.Live(5ms);
    sender.TakeDatas();
    sender.Enqueue(std::string(300, '2'));
    sender.Now += 15ms;  // more than half of the round trip, and less than a timer takes
    sender.Live(10ms);
    std::size_t fresh = 0;
    const std::vector<StoredFrame> sent = sender.TakeDatas();
    EXPECT_LE(sent.size(), 4u);
    for (const StoredFrame &data : sent)
    {
        fresh += static_cast<std::size_t>(std::count_if(data.Items.begin(), data.Items.end(),
                                                        [](const StoredItem &item)
                                                        { return item.Text().front() == '2'; }));
    }
    EXPECT_GE(fresh, 2u);
}

TEST_F(LinkSenderRules, S2_KeepsNoMoreThanTheWindowUnacknowledged)
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

TEST_F(LinkSenderRules, S2_BeginsWithFourDatagramsUnderWay)
{
    Contact();
    for (int i = 2; i <= 20; ++i)
    {
        a.Enqueue(std::string(1250, 'x'));
    }
    a.Pass(0ms);
    EXPECT_THAT(a.TakeDatas(), SizeIs(4));
    a.Hear(b.Ack(2));
    a.Pass(0ms);
    EXPECT_THAT(a.TakeDatas(), SizeIs(1));
}

TEST_F(LinkSenderRules, S2_EachLinkMayHaveOneDatagramUnderWayWhateverTheOthersHave)
{
    Contact();
    for (int i = 2; i <= 20; ++i)
    {
        a.Enqueue(std::string(1250, 'x'));
    }
    a.Pass(0ms);
    a.TakeDatas();
    a.Enqueue("command", "b", "commands");
    a.Pass(0ms);
    EXPECT_THAT(SentTexts(), ElementsAre("command"));
}

TEST_F(LinkSenderRules, S2_CutsALargeMessageIntoPartsThatFitADatagram)
{
    Contact();
    std::string text;
    for (int i = 0; i < 3000; ++i)
    {
        text += static_cast<char>('a' + i % 26);
    }
    const std::uint64_t id = a.Enqueue(text);
    a.Pass(0ms);
    const auto sent = a.TakeDatas();
    ASSERT_THAT(sent, SizeIs(3));
    std::string together;
    for (std::size_t i = 0; i < 3; ++i)
    {
        ASSERT_THAT(sent[i].Items, SizeIs(1));
        const StoredItem &part = sent[i].Items[0];
        EXPECT_EQ(part.Fields.Sequence, 2 + i);
        EXPECT_EQ(part.Fields.Flags, i == 0 ? LinkFlagFirst : i == 2 ? LinkFlagLast : 0);
        LinkFrame view = sent[i].View();
        EXPECT_LE(LinkFrameCodec::EncodedSize(view), LinkSettings().MaxDatagram);
        EXPECT_TRUE(i == 2 || LinkFrameCodec::EncodedSize(view) > LinkSettings().MaxDatagram - 10);
        together += part.Text();
    }
    EXPECT_EQ(sent[0].Items[0].Fields.Size, 3000U);
    EXPECT_EQ(together, text);
    a.Hear(b.Ack(3));
    EXPECT_THAT(a.TakeOutcomes(), IsEmpty()) << "the message has the outcome of its last part";
    a.Hear(b.Ack(4));
    EXPECT_THAT(a.TakeOutcomes(), ElementsAre(Pair(id, LinkOutcome::Delivered)));
}

TEST_F(LinkSenderRules, S2_SaysTheQueuesNameUntilTheReceiverHasOpenedASession)
{
    a.Hear(b.Hello());
    a.Enqueue("1");
    a.Pass(0ms);
    EXPECT_EQ(a.TakeDatas().at(0).Queue, "q");
    a.Hear(b.Ack(1));
    a.Enqueue("2");
    a.Pass(0ms);
    EXPECT_EQ(a.TakeDatas().at(0).Queue, "");
    StoredFrame unknown = b.Hello();
    unknown.Fields.Acks.push_back({.Link = 1});
    a.Hear(unknown);
    a.Enqueue("3");
    a.Pass(0ms);
    EXPECT_EQ(a.TakeDatas().at(0).Queue, "q");
}

TEST_F(LinkSenderRules, S2_SaysATypesNameUntilTheReceiverHasAMessageWithIt)
{
    Contact();
    a.Node->Enqueue("b", "q", "Other", PayloadOf("2"), a.Now);
    a.Pass(0ms);
    EXPECT_EQ(a.TakeDatas().at(0).Items.at(0).Type, "Other");
    a.Node->Enqueue("b", "q", "Other", PayloadOf("3"), a.Now);
    a.Pass(0ms);
    EXPECT_EQ(a.TakeDatas().at(0).Items.at(0).Type, "Other") << "2 may have got lost";
    a.Hear(b.AckWith(1, {3}));
    a.Node->Enqueue("b", "q", "Other", PayloadOf("4"), a.Now);
    a.Pass(0ms);
    const auto sent = a.TakeDatas();
    EXPECT_EQ(sent.at(0).Items.at(0).Type, "");
    EXPECT_EQ(sent.at(0).Items.at(0).Fields.TypeNumber, 1U);
}

TEST_F(LinkSenderRules, S2_AShortFrameGoesToWhoKnowsThisLifeAndClock)
{
    Contact();
    a.Enqueue("2");
    a.Pass(0ms);
    EXPECT_FALSE(a.TakeDatas().at(0).Fields.Short) << "b has echoed nothing";
    StoredFrame ack = b.Ack(2);
    ack.Fields.Echo = {PlayedPeer::ClockOfA, a.Now.count(), 0};
    a.Hear(ack);
    a.Enqueue("3");
    a.Pass(0ms);
    EXPECT_TRUE(a.TakeDatas().at(0).Fields.Short);
    a.Hear(b.Ack(3));
    a.Now += 61s;
    a.Enqueue("4");
    a.Pass(0ms);
    EXPECT_FALSE(a.TakeDatas().at(0).Fields.Short) << "32 bits do not tell times of long ago";
}

TEST_F(LinkSenderRules, S2_PacksWaitingMessagesUpToTheDatagramSize)
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
    sender.Pass(0ms);
    const auto sent = sender.TakeDatas();
    ASSERT_THAT(sent, SizeIs(3)) << "9, 9 and 2";
    std::size_t messages = 0;
    for (const StoredFrame &data : sent)
    {
        EXPECT_EQ(data.Items.at(0).Fields.Sequence, 2 + messages) << "they are numbered through";
        LinkFrame view = data.View();
        EXPECT_LE(LinkFrameCodec::EncodedSize(view), 1000U);
        messages += data.Items.size();
    }
    EXPECT_EQ(messages, 20U);
}

TEST_F(LinkSenderRules, S2_EchoesTheNewestTokenAndHowLongItWasHeld)
{
    Contact();
    a.Pass(30ms);
    const StoredFrame newest = b.Ack(1);
    StoredFrame older = newest;
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

TEST_F(LinkSenderRules, S2_ResendsOnlyTheFirstDatagramsWorthAndTwice)
{
    Contact();
    for (int i = 0; i < 10; ++i)
    {
        a.Enqueue(Large(i));
    }
    a.Pass(0ms);
    EXPECT_THAT(SentTexts(), SizeIs(4)) << "four datagrams";
    a.Live(9s);
    const std::vector<std::string> resent = SentTexts();
    EXPECT_THAT(resent, testing::Each(Large(0)));
    EXPECT_THAT(resent, SizeIs(2)) << "after 0.2 and 0.4 s, 2 kB in all";
}

TEST_F(LinkSenderRules, S2_AfterTwoKilobytesInVainOnlyAsksWhetherAnybodyHears)
{
    Contact();
    a.Enqueue(Large(0));
    a.Pass(0ms);
    a.Live(7s);
    a.TakeDatas();
    a.TakeHellos();
    a.Live(2s);
    EXPECT_THAT(a.TakeDatas(), IsEmpty());
    const std::vector<StoredFrame> questions = a.TakeHellos();
    ASSERT_THAT(questions, SizeIs(2)) << "as often as before";
    EXPECT_TRUE(questions.back().Fields.Ask);
}

TEST_F(LinkSenderRules, S2_AnAnswerToSuchAQuestionBringsTheDatagramAtOnce)
{
    Contact();
    a.Enqueue(Large(0));
    a.Pass(0ms);
    a.Live(9s);
    a.TakeDatas();
    StoredFrame answer = b.Hello();
    answer.Fields.Echo = {PlayedPeer::ClockOfA, a.TakeHellos().back().Fields.Time, 0};
    a.Hear(answer);
    a.Pass(0ms);
    EXPECT_THAT(SentTexts(), ElementsAre(Large(0)));
}

TEST_F(LinkSenderRules, S2_WhatThePeerHadBeforeIsNoAnswerToSuchAQuestion)
{
    Contact();
    const LinkTime before = a.Now;
    a.Enqueue(Large(0));
    a.Pass(0ms);
    a.Live(9s);
    a.TakeDatas();
    StoredFrame frame = b.Hello();
    frame.Fields.Echo = {PlayedPeer::ClockOfA, before.count(), 0};
    a.Hear(frame);
    a.Pass(0ms);
    EXPECT_THAT(a.TakeDatas(), IsEmpty());
}

TEST_F(LinkSenderRules, S2_AfterTwoKilobytesInVainSmallMessagesStillGoAFewAtATime)
{
    Contact();
    for (int i = 0; i < 100; ++i)
    {
        a.Enqueue(Numbered(i) + std::string(30, '.'));
    }
    a.Pass(0ms);
    a.Live(9s);
    a.TakeDatas();
    a.Live(900ms);
    const std::vector<StoredFrame> datas = a.TakeDatas();
    ASSERT_THAT(datas, SizeIs(1));
    EXPECT_THAT(datas.front().Items, SizeIs(3)) << "128 bytes";
}

TEST_F(LinkSenderRules, S2_AfterTheResendTimerNewMessagesShareTheDatagramWithOldOnes)
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

TEST_F(LinkSenderRules, S2_AHelloEndsTheWaitOfABackedOffTimer)
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

TEST_F(LinkSenderRules, S2_ASilentPeerGetsASlowHelloAndNothingElse)
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

TEST_F(LinkSenderRules, S2_APeerWithNothingPendingCostsNothingUntilSomethingIsEnqueued)
{
    Contact();
    a.Live(15s);
    EXPECT_THAT(a.TakeHellos(), IsEmpty());
    EXPECT_EQ(a.Node->NextDue(), LinkNever);
    a.Enqueue("2");
    a.Pass(0ms);
    EXPECT_THAT(SentTexts(), ElementsAre("2")) << "nothing was asked of it, so it is not silent";
}

// Rule S3

TEST_F(LinkSenderRules, S3_AMessageThatExpiresAfterItWasSentIsSentAsSkipWithItsNumber)
{
    a.Configure({.Expire = 1s});
    Contact();
    const std::uint64_t id = a.Enqueue("2");
    a.Pass(400ms);
    const auto before = a.TakeDatas();
    ASSERT_THAT(before, SizeIs(1));
    EXPECT_EQ(before[0].Items[0].Fields.TtlLeft, LinkTime(600ms).count());
    a.Pass(600ms);
    const auto after = a.TakeDatas();
    ASSERT_THAT(after, SizeIs(1));
    EXPECT_EQ(after[0].Items.at(0).Fields.Sequence, 2U);
    EXPECT_EQ(after[0].Items[0].Fields.Flags, LinkFlagSkip);
    EXPECT_THAT(after[0].Items[0].Payload, IsEmpty());
    EXPECT_THAT(a.TakeOutcomes(), IsEmpty()) << "it may have been delivered";
    a.Hear(b.Ack(2, 100, {2}));
    EXPECT_THAT(a.TakeOutcomes(), ElementsAre(Pair(id, LinkOutcome::Expired)));
}

TEST_F(LinkSenderRules, S3_AMessageThatExpiresBeforeItWasSentEndsAtOnce)
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

TEST_F(LinkSenderRules, S3_OfAMessageThatExpiresHalfSentOnlyOneSkipIsSentForAllItsParts)
{
    a.Configure({.Expire = 1s});
    Contact();
    const std::uint64_t id = a.Enqueue(std::string(20000, 'x'));
    a.Pass(0ms);
    const std::size_t parts = a.TakeDatas().size();
    a.Now += 1s;
    a.Pass(0ms);
    const auto skips = a.TakeDatas();
    ASSERT_THAT(skips, SizeIs(1));
    ASSERT_THAT(skips[0].Items, SizeIs(1));
    EXPECT_EQ(skips[0].Items[0].Fields.Flags, LinkFlagSkip);
    EXPECT_EQ(skips[0].Items[0].Fields.Sequence, 2U);
    EXPECT_EQ(skips[0].Items[0].Fields.Through, 2 + parts) << "and one number that ends it";
    EXPECT_THAT(a.TakeOutcomes(), IsEmpty()) << "the receiver may still hold its beginning";
    a.Hear(b.Ack(2 + parts, 100, {2 + parts}));
    EXPECT_THAT(a.TakeOutcomes(), ElementsAre(Pair(id, LinkOutcome::Expired)));
}

// Rule S4

TEST_F(LinkSenderRules, S4_EachAcknowledgedMessageGetsTheOutcomeOfItsBit)
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

TEST_F(LinkSenderRules, S4_ARepeatedOrOvertakenAcknowledgementChangesNoOutcome)
{
    Contact();
    a.Enqueue("2");
    a.Enqueue("3");
    a.Pass(0ms);
    const StoredFrame old = b.Ack(2);
    const StoredFrame newer = b.Ack(3);
    a.Hear(newer);
    EXPECT_THAT(a.TakeOutcomes(), SizeIs(2));
    a.Hear(old);
    a.Hear(newer);
    EXPECT_THAT(a.TakeOutcomes(), IsEmpty());
}

TEST_F(LinkSenderRules, S4_AnOvertakenAcknowledgementGivesNoCredit)
{
    Contact(100);
    const StoredFrame old = b.Ack(1, 100);
    a.Hear(b.Ack(1, 0));
    a.Hear(old);
    a.Enqueue("2");
    a.Enqueue("3");
    a.Pass(0ms);
    EXPECT_THAT(SentTexts().size(), testing::Le(1U)) << "a probe at most";
}

TEST_F(LinkSenderRules, S4_AnAcknowledgementOfAnotherStreamOnlyBringsAToken)
{
    a.Hear(b.Hello());
    a.Enqueue("1");
    a.Pass(0ms);
    StoredFrame ack = b.Ack(1);
    ack.Fields.ReceiverLife = NodeUnderTest::FirstLife - 1;
    a.Hear(ack);
    EXPECT_THAT(a.TakeOutcomes(), IsEmpty());
    EXPECT_EQ(a.SenderCounters().Pending, 1U);
}

TEST_F(LinkSenderRules, S4_MeasuresTheRoundTripByTheEchoedTimeLessWhatItWasHeld)
{
    Contact();
    for (int i = 2; i < 40; ++i)
    {
        a.Enqueue("m");
        a.Pass(0ms);
        StoredFrame ack = b.Ack(static_cast<std::uint64_t>(i));
        ack.Fields.Echo = {PlayedPeer::ClockOfA, a.Now.count(), LinkTime(30ms).count()};
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

TEST_F(LinkSenderRules, S4_AnEchoThatCannotBeMeasuresNothing)
{
    Contact();
    a.Enqueue("m");
    a.Pass(0ms);
    StoredFrame ack = b.Ack(2);
    ack.Fields.Echo = {PlayedPeer::ClockOfA, (a.Now + 1s).count(), 0};
    a.Hear(ack);
    EXPECT_EQ(a.SenderCounters().RoundTrip, 0ns);
}

TEST_F(LinkSenderRules, S4_LearnsARoundTripLongerThanTheTimer)
{
    Contact();
    std::uint64_t acknowledged = 1;
    for (int i = 0; i < 10; ++i)
    {
        a.Enqueue("m");
        a.Pass(0ms);
        const LinkTime sentAt = a.Now;
        a.Live(300ms);
        StoredFrame ack = b.Ack(++acknowledged);
        ack.Fields.Echo = {PlayedPeer::ClockOfA, sentAt.count(), 0};
        a.Hear(ack);
    }
    a.TakeDatas();
    a.Enqueue("m");
    a.Live(299ms);
    EXPECT_THAT(SentTexts(), ElementsAre("m")) << "no longer sent twice";
}

// Rule S5

TEST_F(LinkSenderRules, S5_AReceiverInANewLifePutsWhatWasSentInDoubtAndContinuesWithTheRest)
{
    Contact(1);
    a.Enqueue("2");
    a.Enqueue("3");
    a.Pass(0ms);
    EXPECT_THAT(SentTexts(), ElementsAre("2"));
    b.Life += 1ULL << 32;
    StoredFrame ack = b.Ack(0, 50);
    ack.Ack() = {.Link = 1};
    a.Hear(ack);
    EXPECT_THAT(a.TakeOutcomes(), ElementsAre(Pair(2, LinkOutcome::InDoubt)));
    a.Pass(0ms);
    const auto sent = a.TakeDatas();
    ASSERT_THAT(sent, SizeIs(1));
    EXPECT_EQ(sent[0].Fields.ReceiverLife, b.Life);
    EXPECT_EQ(sent[0].Fields.Data.Oldest, 3U);
    EXPECT_EQ(sent[0].Items.at(0).Fields.Sequence, 3U);
    EXPECT_EQ(a.SenderCounters().Restarts, 1U);
    EXPECT_EQ(a.Node->Counters().PeerRestarts, 1U);
}

TEST_F(LinkSenderRules, S5_AHelloTellsOfTheNewLifeAsWell)
{
    Contact();
    a.Enqueue("2");
    a.Pass(0ms);
    b.Life += 1;
    a.Hear(b.Hello());
    EXPECT_THAT(a.TakeOutcomes(), ElementsAre(Pair(2, LinkOutcome::InDoubt)));
}

// A second path would be used for ever, since nobody answers what the former life was asked.
TEST_F(LinkSenderRules, S5_ANewLifeEndsTheDoubtOfWhatTheFormerOneWasAsked)
{
    const auto isInDoubt = [this]
    {
        bool is = false;
        a.Node->VisitUnanswered(a.Now, [&is](std::string_view) { is = true; });
        return is;
    };
    Contact();
    a.Enqueue("2");
    a.Pass(0ms);
    a.Pass(10s);
    EXPECT_TRUE(isInDoubt());
    b.Life += 1;
    a.Hear(b.Hello());
    a.Pass(10s);
    EXPECT_FALSE(isInDoubt());
}

TEST_F(LinkSenderRules, S5_ANewLifeThatSomethingElseHeardOfGetsNothingBeforeTheLinksKnowIt)
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

TEST_F(LinkSenderRules, S5_WhatSomethingElseHeardOfAnOlderLifeChangesNothing)
{
    Contact();
    a.Enqueue("2");
    a.Pass(0ms);
    a.Node->HeardOf("b", b.Life - 1, a.Now);
    EXPECT_EQ(a.SenderCounters().InDoubt, 0U);
}

TEST_F(LinkSenderRules, S5_AMessageThatWasSentInPartIsSentAgainFromItsBeginning)
{
    Contact();
    const std::string text(20000, 'x');
    const std::uint64_t id = a.Enqueue(text);
    a.Pass(0ms);
    ASSERT_THAT(a.TakeDatas(), SizeIs(testing::AllOf(testing::Ge(3U), testing::Le(5U))));
    b.Life += 1;
    a.Hear(b.Hello());
    EXPECT_THAT(a.TakeOutcomes(), IsEmpty()) << "it cannot have been delivered";
    a.Pass(0ms);
    const auto sent = a.TakeDatas();
    ASSERT_THAT(sent, SizeIs(1));
    EXPECT_EQ(sent[0].Items.at(0).Fields.Flags, LinkFlagFirst);
    EXPECT_EQ(sent[0].Fields.Data.Oldest, sent[0].Items[0].Fields.Sequence);
    EXPECT_EQ(sent[0].Items[0].Type, "T") << "the new life knows no types";
    EXPECT_EQ(sent[0].Queue, "q");
    EXPECT_NE(id, 0U);
}

TEST_F(LinkSenderRules, S5_TheCreditOfTheOldLifeIsForgotten)
{
    Contact(100);
    b.Life += 1;
    a.Hear(b.Hello());
    a.Enqueue("2");
    a.Enqueue("3");
    a.Pass(0ms);
    EXPECT_THAT(SentTexts(), ElementsAre("2"));
}

TEST_F(LinkSenderRules, S5_TheClockOfTheNewLifeMayReadLessThanThatOfTheOldOne)
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

TEST_F(LinkSenderRules, S5_AQueueThatOptedInGetsWhatWasInDoubtAgainMarkedAndInOrder)
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
    EXPECT_EQ(sent[0].Items.at(0).Fields.Sequence, 4U) << "new numbers";
    a.Hear(b.Ack(4));
    a.Pass(0ms);
    sent = a.TakeDatas();
    ASSERT_THAT(sent, SizeIs(1));
    ASSERT_THAT(sent[0].Items, SizeIs(2));
    EXPECT_EQ(sent[0].Items[0].Fields.Flags & LinkFlagRedelivered, LinkFlagRedelivered);
    EXPECT_EQ(sent[0].Items[1].Fields.Flags & LinkFlagRedelivered, 0) << "that one was never sent before";
    a.Hear(b.Ack(6, 100, {5}));
    EXPECT_THAT(a.TakeOutcomes(), ElementsAre(Pair(2, LinkOutcome::Delivered), Pair(3, LinkOutcome::InDoubt),
                                              Pair(4, LinkOutcome::Delivered)));
}

TEST_F(LinkSenderRules, S5_AnAcknowledgementOfAnOlderLifeIsIgnoredAndAnsweredWithAHello)
{
    Contact();
    a.Enqueue("2");
    a.Pass(1s);
    a.TakeHellos();
    a.Pass(30ms);
    StoredFrame old = b.Ack(2);
    old.Fields.SenderLife -= 1;
    a.Hear(old);
    EXPECT_THAT(a.TakeOutcomes(), IsEmpty());
    a.Pass(0ms);
    const auto hellos = a.TakeHellos();
    ASSERT_THAT(hellos, SizeIs(1));
    EXPECT_EQ(hellos[0].Fields.ReceiverLife, b.Life);
}

// Rule S6

TEST_F(LinkSenderRules, S6_APeerThatKnowsAHigherLifeOfMineMakesMeTakeAYetHigherOne)
{
    Contact(1);
    a.Enqueue("2");
    a.Enqueue("3");
    a.Pass(0ms);
    a.TakeDatas();
    const std::uint64_t known = NodeUnderTest::FirstLife + (9ULL << 32);
    StoredFrame ack = b.Ack(0);
    ack.Ack().Cumulative = 77;
    ack.Fields.ReceiverLife = known;
    a.Hear(ack);
    EXPECT_GT(a.Node->Incarnation(), known);
    EXPECT_THAT(a.TakeOutcomes(), ElementsAre(Pair(2, LinkOutcome::InDoubt)));
    a.Pass(0ms);
    const auto sent = a.TakeDatas();
    ASSERT_THAT(sent, SizeIs(1));
    EXPECT_EQ(sent[0].Fields.SenderLife, a.Node->Incarnation());
    EXPECT_EQ(sent[0].Fields.Data.Oldest, 3U);
}

TEST_F(LinkSenderRules, S6_RaisesTheAlarmWhenItRepeats)
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

TEST_F(LinkSenderRules, S6_AFoolishPeerCannotHaveAllSessionsDroppedAgainAndAgain)
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

TEST_F(LinkSenderRules, S6_OneFalseHelloDoesNotUseUpTheNumbersOfLaterLives)
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

TEST_F(LinkSenderRules, S6_AnIncarnationOfAPeerThatNoNodeCanHaveIsNotBelieved)
{
    Contact();
    PlayedPeer forger;
    forger.Life = (static_cast<std::uint64_t>(LinkLargestClaim) + 1) << 32;
    a.Hear(forger.Hello());
    EXPECT_EQ(a.Node->Counters().FalseClaims, 1U);
    const std::uint64_t id = a.Enqueue("2");
    a.Pass(0ms);
    a.Hear(b.Ack(2));
    EXPECT_THAT(a.TakeOutcomes(), ElementsAre(Pair(id, LinkOutcome::Delivered)));
}

TEST_F(LinkSenderRules, S6_AnIncarnationOfAPeerAboveAllClocksIsBelievedIfThePeerHearsThisNode)
{
    PlayedPeer late;
    late.Life = (static_cast<std::uint64_t>(LinkLargestClaim) + 1) << 32;
    a.Hear(late.Hello());
    a.Enqueue("1");
    a.Pass(0ms);
    EXPECT_THAT(SentTexts(), IsEmpty());
    EXPECT_THAT(a.TakeHellos(), SizeIs(1U)) << "which the peer can echo";
    StoredFrame proof = late.Hello();
    proof.Fields.Echo = {PlayedPeer::ClockOfA, a.Now.count(), 0};
    a.Hear(proof);
    a.Pass(0ms);
    EXPECT_THAT(SentTexts(), ElementsAre("1"));
}

TEST_F(LinkSenderRules, S6_HellosToAPeerThatDoesNotMakeSenseOfThisNodeBecomeSeldom)
{
    Contact();
    b.KnownLife -= 1;
    for (int i = 0; i < 1000; ++i)
    {
        a.Hear(b.Hello());
        a.Live(10ms);
    }
    EXPECT_THAT(a.TakeHellos(), SizeIs(testing::Le(45U))) << "four times a second, and some at the beginning";
    b.KnownLife += 1;
    a.Hear(b.Ack(1));
    b.KnownLife -= 1;
    a.Hear(b.Hello());
    a.Live(LinkSettings().HelloPeriod);
    a.TakeHellos();
    a.Hear(b.Hello());
    a.Pass(LinkSettings().HelloGap);
    a.Hear(b.Hello());
    a.Pass(LinkSettings().HelloGap);
    EXPECT_THAT(a.TakeHellos(), SizeIs(1U)) << "quickly again after sense was made";
}

// Rule S7

TEST_F(LinkSenderRules, S7_AMessageThatExpiresWhileThePeerIsSilentIsInDoubtAndGivesUpItsPlace)
{
    a.Configure({.Capacity = 1, .Expire = 1s});
    Contact();
    const std::uint64_t id = a.Enqueue("2");
    a.Live(LinkSettings().SilentAfter - 1ms);
    EXPECT_THAT(a.TakeOutcomes(), IsEmpty()) << "an answer may still come";
    EXPECT_EQ(a.Enqueue("3"), 0U);
    a.Live(LinkTime(1s) + 1ms);
    EXPECT_THAT(a.TakeOutcomes(), ElementsAre(Pair(id, LinkOutcome::InDoubt)));
    EXPECT_EQ(a.SenderCounters().Pending, 0U);
    EXPECT_EQ(a.SenderCounters().PendingBytes, 0U);
    EXPECT_FALSE(a.Node->HasPending("b"));
    EXPECT_NE(a.Enqueue("3"), 0U);
}

TEST_F(LinkSenderRules, S7_AMessageThatExpiresHalfSentWhileThePeerIsSilentHasExpired)
{
    a.Configure({.Expire = 15s});
    Contact();
    const std::uint64_t id = a.Enqueue(std::string(100'000, '.'));
    a.Live(16s);
    EXPECT_THAT(a.TakeOutcomes(), ElementsAre(Pair(id, LinkOutcome::Expired)));
}

TEST_F(LinkSenderRules, S7_TheNumbersOfAMessageThatWasGivenUpAreSkippedWhenThePeerReturns)
{
    a.Configure({.Expire = 1s});
    Contact();
    a.Enqueue("2");
    a.Live(12s);
    a.TakeOutcomes();
    a.TakeDatas();
    a.Hear(b.Hello());
    const std::uint64_t next = a.Enqueue("3");
    a.Live(20ms);
    const auto datas = a.TakeDatas();
    ASSERT_FALSE(datas.empty());
    EXPECT_EQ(datas[0].Items.at(0).Fields.Sequence, 2U);
    EXPECT_EQ(datas[0].Items[0].Fields.Flags, LinkFlagSkip);
    a.Hear(b.Ack(3, 100, {2}));
    EXPECT_THAT(a.TakeOutcomes(), ElementsAre(Pair(next, LinkOutcome::Delivered))) << "one outcome each";
}

TEST_F(LinkSenderRules, S7_AMessageThatWasGivenUpHasNoSecondOutcomeWhenThePeerRestarts)
{
    for (const bool redeliver : {false, true})
    {
        NodeUnderTest node;
        PlayedPeer peer;
        node.Configure({.Expire = 1s, .RedeliverInDoubt = redeliver});
        node.Hear(peer.Hello());
        node.Enqueue("1");
        node.Live(12s);
        EXPECT_THAT(node.TakeOutcomes(), SizeIs(1U));
        peer.Life += 1ULL << 32;
        node.Hear(peer.Hello());
        node.Live(100ms);
        node.Node->Close();
        EXPECT_THAT(node.TakeOutcomes(), IsEmpty());
    }
}

TEST_F(LinkSenderRules, CloseGivesEveryPendingMessageAnOutcome)
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
