// When a node sends cards, and when it requests them.
#include "rtps/CardExchange.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>
#include <utility>
#include <vector>

#include "guard/RtpsBytes.h"
#include "rtps/PackedCard.h"

namespace
{

using namespace std::chrono_literals;
using namespace Rabit::Rtps;
using Bytes = RtpsBytes::Bytes;
using TimePoint = CardExchange::TimePoint;

GuidPrefix Name(std::uint8_t number)
{
    GuidPrefix name = RtpsBytes::Sender;
    name.back() = number;
    return name;
}

// A node with a card, without a network.
class Exchanging : public testing::Test
{
protected:
    explicit Exchanging(bool isMulticast = true) : Exchange({.Period = 10s, .IsMulticast = isMulticast})
    {
        Exchange.SetSelf(Name(1));
        Exchange.SetOwn(Bytes(100, 1), Now);
        Run(25s);
    }
    // Runs for `time`. Returns the messages that were sent.
    std::vector<CardExchange::Outgoing> Run(std::chrono::milliseconds time)
    {
        std::vector<CardExchange::Outgoing> all;
        for (const auto end = Now + time; Now < end; Now += 1ms)
        {
            while (auto outgoing = Exchange.TakeDue(Now))
            {
                all.push_back(std::move(*outgoing));
            }
        }
        return all;
    }
    // Returns the messages that have a part of the card.
    static std::vector<CardExchange::Outgoing> Parts(std::vector<CardExchange::Outgoing> messages)
    {
        std::erase_if(messages,
                      [](const auto &outgoing) { return !ReadCardMessage(outgoing.Bytes)->HasPart; });
        return messages;
    }
    static bool HasPart(const std::vector<CardExchange::Outgoing> &messages)
    {
        return !Parts(messages).empty();
    }
    static std::vector<GuidPrefix> Asked(const std::vector<CardExchange::Outgoing> &messages)
    {
        std::vector<GuidPrefix> asked;
        for (const auto &outgoing : messages)
        {
            const auto message = ReadCardMessage(outgoing.Bytes);
            for (const CardRequest &request : message->Requests)
            {
                asked.push_back(request.Of);
            }
        }
        return asked;
    }
    // Receives a message that was `late` on its way.
    void Receive(CardMessage message, std::chrono::milliseconds late = 0ms)
    {
        message.SentAt = QueueingDelay::Stamp(Now - late);
        Exchange.Received(message, Now);
    }

    // Receives a part that answers a request which this node sent `took` ago. It completes no card.
    void Answer(const GuidPrefix &from, std::chrono::milliseconds took)
    {
        Receive({.From = from,
                 .HasPart = true,
                 .Answers = {.From = Name(1), .SentAt = QueueingDelay::Stamp(Now - took)}});
    }
    void RunUntilAsked(const GuidPrefix &peer)
    {
        for (bool isAsked = false; !isAsked;)
        {
            const auto asked = Asked(Run(1ms));
            isAsked = std::count(asked.begin(), asked.end(), peer) > 0;
        }
    }

    TimePoint Now{1h};
    CardExchange Exchange;
};

class ExchangingWithoutMulticast : public Exchanging
{
protected:
    ExchangingWithoutMulticast() : Exchanging(false) {}
};

// Where the holder gives few turns, some request is always due.
TEST_F(Exchanging, APartGoesAfterTheRequestsThatWereDueBeforeIt)
{
    for (std::uint8_t number = 3; number < 8; ++number)
    {
        Exchange.Announced(Name(number), Now);
    }
    Now += 1s;  // without a turn
    Receive({.From = Name(2), .Requests = {{.Of = Name(1), .Parts = 1}}});
    Now += 1s;
    const auto first = Exchange.TakeDue(Now);
    ASSERT_TRUE(first);
    EXPECT_FALSE(ReadCardMessage(first->Bytes)->HasPart);
    Now += 1s;  // the requests are due again
    const auto second = Exchange.TakeDue(Now);
    ASSERT_TRUE(second);
    EXPECT_TRUE(ReadCardMessage(second->Bytes)->HasPart);
}

TEST_F(Exchanging, SaysAboutHowManyBytesAreDue)
{
    EXPECT_EQ(Exchange.DueBytes(Now), 0u);
    Receive({.From = Name(2), .Requests = {{.Of = Name(1), .Parts = 1}}});
    Now += 100ms;
    const std::size_t due = Exchange.DueBytes(Now);
    const auto taken = Exchange.TakeDue(Now);
    ASSERT_TRUE(taken);
    EXPECT_GE(due, taken->Bytes.size());
    EXPECT_LE(due, taken->Bytes.size() + 2 * CardExchange::IpAndUdp);
}

TEST_F(ExchangingWithoutMulticast, AMessageToOneNodeTakesNoSummaryFromTheOthers)
{
    const auto due = Exchange.Due();  // of the summary
    ASSERT_TRUE(due);
    Now = *due;
    Receive({.From = Name(2), .Requests = {{.Of = Name(1), .Parts = 1}}});
    const auto messages = Run(100ms);
    ASSERT_TRUE(HasPart(messages));
    EXPECT_TRUE(std::any_of(messages.begin(), messages.end(), [](const auto &one) { return !one.To; }));
}

TEST_F(Exchanging, APartThatWasLostIsSentAgainAlthoughQueuesWereFullThen)
{
    const std::vector<CardRequest> forPart{{.Of = Name(1), .Parts = 1}};
    Receive({.From = Name(2)});
    Receive({.From = Name(2), .Requests = forPart}, 8s);
    ASSERT_TRUE(HasPart(Run(100ms)));
    Run(1s);
    Receive({.From = Name(2), .Requests = forPart});
    EXPECT_TRUE(HasPart(Run(1s)));
}

TEST_F(Exchanging, ARequestThatHasCrossedWithThePartBringsNoOther)
{
    const std::vector<CardRequest> forPart{{.Of = Name(1), .Parts = 1}};
    Receive({.From = Name(2)});
    Receive({.From = Name(2), .Requests = forPart}, 2s);
    ASSERT_TRUE(HasPart(Run(100ms)));
    Run(1s);
    Receive({.From = Name(2), .Requests = forPart}, 2s);
    EXPECT_FALSE(HasPart(Run(1s)));
}

TEST_F(Exchanging, TheTimeForWhichAnAnswerIsHeldBackIsNoPartOfTheRoundTrip)
{
    const std::vector<CardRequest> forPart{{.Of = Name(1), .Parts = 1}};
    Receive({.From = Name(2), .Requests = forPart});
    ASSERT_TRUE(HasPart(Run(1ms)));
    Run(10ms);
    const TimePoint asked = Now;
    Receive({.From = Name(3), .Requests = forPart});
    const auto answers = Parts(Run(100ms));
    ASSERT_EQ(answers.size(), 1u);
    const auto answer = ReadCardMessage(answers[0].Bytes);
    ASSERT_GE(answer->SentAt - QueueingDelay::Stamp(asked), 30u);  // it was held back
    EXPECT_EQ(answer->Answers.From, Name(3));
    EXPECT_EQ(answer->Answers.SentAt, answer->SentAt);
}

TEST_F(Exchanging, AnAnswerToOneGoesToAllByMulticast)
{
    Receive({.From = Name(2), .Requests = {{.Of = Name(1), .Parts = 1}}});
    const auto answers = Parts(Run(1ms));
    ASSERT_EQ(answers.size(), 1u);
    EXPECT_FALSE(answers[0].To.has_value());
}

TEST_F(ExchangingWithoutMulticast, APartThatWentToOneNodeLeavesTheRequestOfAnotherToBeAnswered)
{
    const std::vector<CardRequest> forPart{{.Of = Name(1), .Parts = 1}};
    Receive({.From = Name(2)});
    Receive({.From = Name(3)});
    Receive({.From = Name(2), .Requests = forPart});
    ASSERT_TRUE(HasPart(Run(1ms)));
    Receive({.From = Name(3), .Requests = forPart}, 500ms);  // sent before the part went to the other
    const auto answers = Parts(Run(100ms));
    ASSERT_EQ(answers.size(), 1u);
    EXPECT_EQ(answers[0].To, Name(3));
}

TEST_F(Exchanging, ARoundTripThatBecomesKnownPostponesTheRequestsThatAreOut)
{
    Exchange.Announced(Name(2), Now);
    Exchange.Announced(Name(3), Now);
    const TimePoint first = Now + CardExchange::Patience;
    Run(1s);
    RunUntilAsked(Name(3));
    const Bytes card(100, 2);
    Receive({.From = Name(2),
             .Summary = SummaryOf(card),
             .HasPart = true,
             .Part = 0,
             .Answers = {.From = Name(1), .SentAt = QueueingDelay::Stamp(first)},
             .Bytes = card});
    EXPECT_TRUE(Asked(Run(950ms)).empty());
    EXPECT_FALSE(Asked(Run(250ms)).empty());
}

TEST_F(Exchanging, AnAnswerOfANodeThatWasNotAskedTellsNothing)
{
    Exchange.Announced(Name(3), Now);
    Run(200ms);
    Answer(Name(2), 4s);
    EXPECT_FALSE(Asked(Run(500ms)).empty());
}

TEST_F(Exchanging, AnAnswerThatClaimsToBeOlderThanTheFirstRequestTellsNothing)
{
    Exchange.Announced(Name(2), Now);
    Exchange.Announced(Name(3), Now);
    Run(200ms);
    Answer(Name(2), 4s);
    EXPECT_FALSE(Asked(Run(500ms)).empty());
}

TEST_F(Exchanging, OfTwoDelaysThatAnswersTellTheLowerOneCounts)
{
    for (std::uint8_t number = 10; number < 20; ++number)  // each heard once: nothing tells of a queue
    {
        Receive({.From = Name(number)});
    }
    Exchange.Announced(Name(2), Now);
    Exchange.Announced(Name(3), Now);
    Run(1s);
    RunUntilAsked(Name(3));
    Answer(Name(2), 100ms);
    Answer(Name(3), 900ms);
    const auto asked = Asked(Run(700ms));
    EXPECT_NE(std::count(asked.begin(), asked.end(), Name(3)), 0);
}

TEST_F(Exchanging, ARequestHeardDuringARestDoesNotUseUpTheOnePostponement)
{
    const Bytes card(100, 2);
    const auto request = [&]
    {
        Receive({.From = Name(2),
                 .Requests = {{.Of = Name(3), .Parts = ~std::uint64_t{0}},
                              {.Of = Name(4), .Parts = ~std::uint64_t{0}}}});
    };
    Exchange.Announced(Name(3), Now);
    Run(CardExchange::Patience + 10ms);
    const auto silent = Run(5s);  // until the requests rest
    ASSERT_FALSE(Asked(silent).empty());
    ASSERT_TRUE(Asked(Run(2s)).empty());
    request();
    Exchange.Heard(Name(3), Now);
    request();
    const auto asked = Asked(Run(CardExchange::FirstRetry - 10ms));
    EXPECT_EQ(std::count(asked.begin(), asked.end(), Name(3)), 0);
}

TEST_F(Exchanging, RequestsOfOthersDoNotSpareANodeItsOwnForEver)
{
    Exchange.Announced(Name(3), Now);
    std::ptrdiff_t requests = 0;
    for (int i = 0; i < 100; ++i)
    {
        Receive({.From = Name(2),
                 .Requests = {{.Of = Name(3), .Parts = ~std::uint64_t{0}},
                              {.Of = Name(4), .Parts = ~std::uint64_t{0}}}});
        const auto asked = Asked(Run(40ms));
        requests += std::count(asked.begin(), asked.end(), Name(3));
    }
    EXPECT_GE(requests, 4);
}

TEST_F(Exchanging, OfMoreThanAMessageTakesAllAreAskedInTurn)
{
    for (std::uint8_t number = 2; number < 122; ++number)
    {
        Exchange.Announced(Name(number), Now);
    }
    const auto asked = Asked(Run(250ms));
    EXPECT_EQ(std::set<GuidPrefix>(asked.begin(), asked.end()).size(), 120u);
}

TEST_F(Exchanging, AnInventedAnnouncementIsAnsweredWithFewRequests)
{
    Exchange.Announced(Name(9), Now);
    EXPECT_LE(Run(60s).size(), std::size_t{CardExchange::MostVainRequests} + 7u);  // a summary in each period
}

TEST_F(Exchanging, AnAnnouncedNodeThatIsHeardIsAskedAgainSoon)
{
    Exchange.Announced(Name(9), Now);
    ASSERT_EQ(Asked(Run(3s)).size(), std::size_t{CardExchange::MostVainRequests});
    Exchange.Heard(Name(9), Now);
    ASSERT_EQ(Asked(Run(3s)).size(), std::size_t{CardExchange::MostVainRequests});
    Exchange.Heard(Name(9), Now);
    EXPECT_TRUE(Asked(Run(10ms)).empty()) << "one short rest for each announcement";
}

TEST_F(Exchanging, AProgramThatNeverAnswersIsLeftAloneForAWhile)
{
    Exchange.Heard(Name(9), Now);
    ASSERT_EQ(Asked(Run(3s)).size(), std::size_t{CardExchange::MostVainRequests});
    Exchange.Heard(Name(9), Now);
    EXPECT_TRUE(Asked(Run(10ms)).empty());
}

TEST_F(Exchanging, ANewcomerWhoseCardIsCompleteHearsOfANodeThatWasSilent)
{
    const Bytes card(100, 2);
    ASSERT_TRUE(Exchange.Received(
        {.From = Name(2), .Summary = SummaryOf(card), .HasPart = true, .Part = 0, .Bytes = card}, Now));
    ASSERT_LE(Exchange.Due(), Now + CardExchange::FirstSummary);
    const auto greeting = Exchange.TakeDue(Now + CardExchange::FirstSummary);
    ASSERT_TRUE(greeting);
    EXPECT_FALSE(greeting->To.has_value());
}

// Somebody repeats what was heard before, again and again.
TEST_F(Exchanging, AnOlderSummaryDoesNotReplaceTheOneThatIsWanted)
{
    const std::vector<std::uint8_t> older(100, 1);
    const std::vector<std::uint8_t> newer(200, 2);
    Receive({.From = Name(2), .Summary = SummaryOf(newer)});
    for (int i = 0; i < 100; ++i)
    {
        Receive({.From = Name(2), .Summary = SummaryOf(older)}, 10s);
        Now += 10ms;
    }
    CardMessage part{.From = Name(2), .Summary = SummaryOf(newer), .HasPart = true};
    part.SentAt = QueueingDelay::Stamp(Now);
    part.Bytes = newer;
    const auto card = Exchange.Received(part, Now);
    ASSERT_TRUE(card.has_value());
    EXPECT_EQ(card->Packed, newer);
}

// An invented summary of tomorrow must not keep the true one away for good.
TEST_F(Exchanging, ASummaryWhoseCardDoesNotComeIsReplacedByAnOlderOne)
{
    const std::vector<std::uint8_t> card(100, 1);
    Receive({.From = Name(2), .Summary = {.Digest = 7, .Size = 100}}, -24h);
    CardMessage part{.From = Name(2), .Summary = SummaryOf(card), .HasPart = true};
    part.Bytes = card;
    for (const auto wait : {0ms, 1000ms})
    {
        Now += wait;
        part.SentAt = QueueingDelay::Stamp(Now);
        EXPECT_FALSE(Exchange.Received(part, Now).has_value());
    }
    Now += 1s;
    part.SentAt = QueueingDelay::Stamp(Now);
    EXPECT_TRUE(Exchange.Received(part, Now).has_value());
}

}  // namespace
