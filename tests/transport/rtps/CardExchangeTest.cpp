// When a node says and asks for what, by its card messages.
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
    Exchanging()
    {
        Exchange.SetSelf(Name(1));
        Exchange.SetOwn(Bytes(100, 1), Now);
        Run(25s);
    }
    // Returns the messages of that time.
    std::vector<CardExchange::Outgoing> Run(std::chrono::milliseconds time)
    {
        std::vector<CardExchange::Outgoing> all;
        for (const auto end = Now + time; Now < end; Now += 1ms)
        {
            for (CardExchange::Outgoing &outgoing : Exchange.TakeDue(Now))
            {
                all.push_back(std::move(outgoing));
            }
        }
        return all;
    }
    static bool HasPart(const std::vector<CardExchange::Outgoing> &messages)
    {
        return std::any_of(messages.begin(), messages.end(),
                           [](const auto &outgoing) { return ReadCardMessage(outgoing.Bytes)->HasPart; });
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
    // A message of that node which was so long under way.
    void Receive(CardMessage message, std::chrono::milliseconds late = 0ms)
    {
        message.SentAt = QueueingDelay::Stamp(Now - late);
        Exchange.Received(message, Now);
    }

    TimePoint Now{1h};
    CardExchange Exchange{10s};
};

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

TEST_F(Exchanging, ANewcomerWhoseCardIsCompleteHearsOfANodeThatWasSilent)
{
    const Bytes card(100, 2);
    ASSERT_TRUE(Exchange.Received(
        {.From = Name(2), .Summary = SummaryOf(card), .HasPart = true, .Part = 0, .Bytes = card}, Now));
    ASSERT_LE(Exchange.Due(), Now + CardExchange::FirstSummary);
    const auto greeting = Exchange.TakeDue(Now + CardExchange::FirstSummary);
    ASSERT_EQ(greeting.size(), 1u);
    EXPECT_FALSE(greeting[0].To.has_value());
}

}  // namespace
