// When `KeyExchangeOutbox` sends the messages that two participants need to exchange their keys.
#include "common/KeyExchangeOutbox.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <utility>
#include <vector>

namespace
{

using namespace std::chrono_literals;
using Rabit::KeyExchange;
using Rabit::KeyExchangeOutbox;
using Milliseconds = std::chrono::milliseconds;
using Step = KeyExchange::Step;
using Routes = std::vector<std::uint64_t>;

class KeyExchangeOutboxTest : public testing::Test
{
protected:
    static constexpr std::size_t Large = 4200;

    static KeyExchange::Prefix Prefix(std::uint8_t peer)
    {
        KeyExchange::Prefix prefix;
        prefix.fill(peer);
        return prefix;
    }
    // Puts a datagram for `peer` into the outbox. `route` identifies the datagram in `Take`.
    bool Put(std::uint8_t peer, Step what, std::uint64_t route, Milliseconds at, std::size_t size = Large,
             std::uint32_t source = 1)
    {
        return Put({.To = Prefix(peer), .What = what, .Source = source, .Number = route}, route, at, size);
    }
    bool Put(const KeyExchange &what, std::uint64_t route, Milliseconds at, std::size_t size)
    {
        return Outbox.Put(std::vector<std::uint8_t>(size), what, route, Start + at);
    }
    bool Hear(std::uint8_t peer, Step what, Milliseconds at, bool isWhole = false)
    {
        return Outbox.Received({.From = Prefix(peer), .What = what, .IsWhole = isWhole}, Start + at);
    }
    Routes Take(Milliseconds at)
    {
        Routes routes;
        for (const auto &datagram : Outbox.TakeDue(Start + at))
        {
            routes.push_back(datagram.Route);
        }
        return routes;
    }
    // Returns the time at which the next datagrams go, and takes them.
    Milliseconds Next()
    {
        while (const auto due = Outbox.Due())
        {
            const auto at = std::chrono::duration_cast<Milliseconds>(*due - Start);
            if (!Take(at).empty())
            {
                return at;
            }
        }
        return Milliseconds::max();
    }

    explicit KeyExchangeOutboxTest(KeyExchangeOutbox outbox = KeyExchangeOutbox()) : Outbox(std::move(outbox))
    {
    }

    const KeyExchangeOutbox::TimePoint Start{1000s};
    KeyExchangeOutbox Outbox;
};

TEST_F(KeyExchangeOutboxTest, TheFirstGoesAtOnce)
{
    EXPECT_TRUE(Put(1, Step::Request, 10, 0ms));
    EXPECT_EQ(Take(0ms), (Routes{10}));
    EXPECT_EQ(Outbox.Unanswered(), Large + KeyExchangeOutbox::Headers);
}

TEST_F(KeyExchangeOutboxTest, WhatNamesNobodyGoesAsItIs)
{
    EXPECT_FALSE(Outbox.Put(std::vector<std::uint8_t>(100), {.What = Step::Request}, 1, Start));
}

TEST_F(KeyExchangeOutboxTest, WhatIsForAnotherDoesNotGo)
{
    EXPECT_TRUE(Put({.To = Prefix(1), .What = Step::Request, .IsForOther = true}, 1, 0ms, Large));
    EXPECT_EQ(Take(10s), Routes{});
}

TEST_F(KeyExchangeOutboxTest, TheWindowBoundsWhatIsNotAnswered)
{
    for (std::uint8_t peer = 1; peer <= 5; ++peer)
    {
        Put(peer, Step::Reply, peer, 0ms);
    }
    EXPECT_EQ(Take(0ms), (Routes{1, 2}));
    EXPECT_EQ(Take(100ms), Routes{});
}

TEST_F(KeyExchangeOutboxTest, AnAnswerMakesRoomForTheNext)
{
    for (std::uint8_t peer = 1; peer <= 3; ++peer)
    {
        Put(peer, Step::Reply, peer, 0ms);
    }
    Take(0ms);
    Hear(2, Step::Final, 500ms);
    EXPECT_EQ(Take(500ms), (Routes{3}));
}

TEST_F(KeyExchangeOutboxTest, QuickAnswersOpenTheWindowAndLateOnesCloseIt)
{
    Put(1, Step::Request, 1, 0ms);
    Take(0ms);
    Hear(1, Step::Reply, 100ms);
    EXPECT_GT(Outbox.Window(), KeyExchangeOutbox::FirstWindow);
    const std::size_t open = Outbox.Window();
    Put(2, Step::Request, 2, 500ms);
    Take(500ms);
    Hear(2, Step::Reply, 2s);
    EXPECT_EQ(Outbox.Window(), open / 2);
}

TEST_F(KeyExchangeOutboxTest, WhatIsNeverAnsweredCountsAsLostAndClosesTheWindow)
{
    Put(1, Step::Reply, 1, 0ms);
    Put(2, Step::Reply, 2, 0ms);
    Put(3, Step::Reply, 3, 0ms);
    Take(0ms);
    EXPECT_EQ(Next(), 500ms);
    EXPECT_EQ(Outbox.Window(), KeyExchangeOutbox::SmallestWindow);
}

TEST_F(KeyExchangeOutboxTest, AnAnswerToARepetitionTellsNoTime)
{
    Put(1, Step::Request, 1, 0ms);
    Take(0ms);
    Put(1, Step::Request, 2, 500ms);
    EXPECT_EQ(Take(1000ms), (Routes{2}));
    const std::size_t before = Outbox.Window();
    Hear(1, Step::Reply, 1001ms);
    EXPECT_EQ(Outbox.Window(), before);
}

TEST_F(KeyExchangeOutboxTest, RepetitionsGoAtDoublingDistancesAndTheNewestAlone)
{
    std::vector<Milliseconds::rep> times;
    Routes routes;
    for (int at = 0; at < 20000; at += 500)
    {
        Put(1, Step::Request, static_cast<std::uint64_t>(at), Milliseconds(at));
        for (const auto route : Take(Milliseconds(at)))
        {
            times.push_back(at);
            routes.push_back(route);
        }
    }
    EXPECT_EQ(times, (std::vector<Milliseconds::rep>{0, 500, 1500, 3500, 7500, 15500}));
    EXPECT_EQ(routes, (Routes{0, 500, 1500, 3500, 7500, 15500}));
}

TEST_F(KeyExchangeOutboxTest, ARequestWaitsUntilNoOtherHandshakeMakesProgress)
{
    Put(1, Step::Request, 1, 0ms, 100);
    Put(2, Step::Request, 2, 0ms, 100);
    EXPECT_EQ(Take(0ms), (Routes{1}));
    Hear(1, Step::Reply, 100ms);
    Put(1, Step::Final, 3, 110ms, 100);
    EXPECT_EQ(Take(110ms), (Routes{3}));
    EXPECT_EQ(Next(), 510ms) << "after four times the answer time of 100 ms";
}

TEST_F(KeyExchangeOutboxTest, WhatIsOnlyRepeatedIsNoProgress)
{
    Put(1, Step::Request, 1, 0ms, 100);
    Take(0ms);
    Put(2, Step::Request, 2, 0ms, 100);
    Put(1, Step::Request, 3, 500ms, 100);
    EXPECT_EQ(Take(500ms), (Routes{3}));
    Hear(1, Step::Request, 1900ms);
    EXPECT_EQ(Next(), 2000ms) << "four times the answer time at first, since the first request to 1";
}

TEST_F(KeyExchangeOutboxTest, APeerThatGoesOnAnsweringHoldsUpRequestsToOthersForAShortTimeAlone)
{
    Put(2, Step::Request, 2, 0ms, 100);
    Put(1, Step::Request, 1, 0ms, 100);
    Put(3, Step::Request, 3, 0ms, 100);
    EXPECT_EQ(Take(0ms), (Routes{2}));
    Routes gone;
    std::vector<Milliseconds> times;
    for (auto at = 1000ms; at < 20s; at += 1000ms)
    {
        Hear(2, Step::Reply, at);
        for (const auto route : Take(at))
        {
            gone.push_back(route);
            times.push_back(at);
        }
    }
    EXPECT_EQ(gone, (Routes{1, 3}));
    EXPECT_EQ(times, (std::vector{KeyExchangeOutbox::LongestCalm, 2 * KeyExchangeOutbox::LongestCalm}));
}

TEST_F(KeyExchangeOutboxTest, NoRequestWaitsLongerThanTheLongestWait)
{
    for (std::uint8_t peer = 1; peer <= 50; ++peer)
    {
        Put(peer, Step::Request, peer, 0ms, 100);
    }
    Routes gone;
    for (auto at = 0ms; at <= KeyExchangeOutbox::LongestWait; at += 1000ms)
    {
        for (const auto route : Take(at))
        {
            gone.push_back(route);
        }
        Hear(1, Step::Reply, at);
    }
    EXPECT_EQ(gone.size(), 50U);
}

TEST_F(KeyExchangeOutboxTest, AReplyDoesNotWaitForOtherHandshakes)
{
    Put(1, Step::Request, 1, 0ms, 100);
    Take(0ms);
    Put(2, Step::Reply, 2, 1ms, 100);
    EXPECT_EQ(Take(1ms), (Routes{2}));
}

TEST_F(KeyExchangeOutboxTest, ARepetitionIsForgottenWhenTheAnswerComes)
{
    Put(1, Step::Request, 1, 0ms);
    Take(0ms);
    Put(1, Step::Request, 2, 500ms);
    Hear(1, Step::Reply, 600ms);
    EXPECT_EQ(Take(10s), Routes{});
}

TEST_F(KeyExchangeOutboxTest, AReplyIsKeptUntilTheFinalMessageComes)
{
    Put(1, Step::Reply, 1, 0ms);
    Take(0ms);
    Put(1, Step::Reply, 2, 500ms);
    Hear(1, Step::Keys, 600ms);
    EXPECT_EQ(Take(1000ms), (Routes{2}));
}

TEST_F(KeyExchangeOutboxTest, WhatEndsAnExchangeGoesBeforeWhatBeginsOne)
{
    Put(1, Step::Request, 1, 1ms, 100);
    Put(2, Step::Ask, 2, 1ms, 100);
    Put(3, Step::Reply, 3, 1ms, 100);
    Put(4, Step::Control, 4, 1ms, 100);
    Put(5, Step::Keys, 5, 1ms, 100);
    Put(6, Step::Final, 6, 1ms, 100);
    EXPECT_EQ(Take(1ms), (Routes{6, 5, 4, 3, 2, 1}));
}

TEST_F(KeyExchangeOutboxTest, TheLastMessageDoesNotWaitForTheWindow)
{
    Put(1, Step::Request, 1, 0ms);
    Put(2, Step::Request, 2, 0ms);
    Take(0ms);
    Put(3, Step::Final, 3, 0ms);
    EXPECT_EQ(Take(0ms), (Routes{3}));
}

TEST_F(KeyExchangeOutboxTest, FragmentsGoTogether)
{
    for (std::uint64_t route = 1; route <= 3; ++route)
    {
        Put({.To = Prefix(1), .What = route == 1 ? Step::Request : Step::Rest, .Number = 7}, route, 0ms,
            1000);
    }
    EXPECT_EQ(Take(0ms), (Routes{1, 2, 3}));
}

TEST_F(KeyExchangeOutboxTest, FragmentsOfWhatHasBegunToGoFollowAtOnce)
{
    Put({.To = Prefix(1), .What = Step::Request, .Number = 7}, 1, 0ms, 1000);
    Take(0ms);
    Put({.To = Prefix(1), .What = Step::Rest, .Number = 7}, 2, 1ms, 1000);
    EXPECT_EQ(Take(1ms), (Routes{2}));
}

TEST_F(KeyExchangeOutboxTest, FragmentsOfWhatHasGivenWayDoNotGo)
{
    Put({.To = Prefix(1), .What = Step::Rest, .Number = 7}, 1, 0ms, 1000);
    EXPECT_EQ(Take(10s), Routes{});
}

TEST_F(KeyExchangeOutboxTest, KeysStayInTheirOrderAndNoneIsLeftOut)
{
    Routes all;
    for (std::uint64_t route = 0; route < 100; ++route)
    {
        Put(1, Step::Keys, route, 0ms, 600);
        all.push_back(route);
    }
    Routes gone;
    for (auto at = 0ms; gone.size() < all.size() && at < 60s; at += 10ms)
    {
        for (const auto route : Take(at))
        {
            gone.push_back(route);
        }
        Hear(1, Step::Control, at);
    }
    EXPECT_EQ(gone, all);
}

TEST_F(KeyExchangeOutboxTest, ControlGoesAtDoublingDistancesAndTheNewestAlone)
{
    std::vector<int> times;
    for (int at = 0; at < 2000; at += 10)
    {
        Put(1, Step::Control, 1, Milliseconds(at), 100);
        if (!Take(Milliseconds(at)).empty())
        {
            times.push_back(at);
        }
    }
    EXPECT_EQ(times, (std::vector<int>{0, 50, 150, 350, 750, 1550}));
}

TEST_F(KeyExchangeOutboxTest, ControlMayTakeAQuarterOfWhatGoesBesides)
{
    const auto controls = [this](std::uint32_t first, Milliseconds at)
    {
        for (std::uint32_t source = first; source < first + 30; ++source)
        {
            Put(1, Step::Control, 1, at, 100 - KeyExchangeOutbox::Headers, source);
        }
        return Take(at).size();
    };
    EXPECT_EQ(controls(100, 0ms), 20U) << "2000 bytes at first";
    Put(1, Step::Keys, 2, 1ms, 2000 - KeyExchangeOutbox::Headers);
    EXPECT_EQ(controls(200, 1ms), 1U + 5U) << "a quarter of the keys' 2000 bytes";
    EXPECT_EQ(controls(300, 60ms), 1U) << "one in each interval";
}

TEST_F(KeyExchangeOutboxTest, ControlAboutKeysGoesBeforeOtherControl)
{
    Put(1, Step::Keys, 1, 0ms, 600);
    Take(0ms);
    Put({.To = Prefix(1), .What = Step::Control, .Source = 3, .IsWhole = true}, 2, 1ms, 100);
    Put(1, Step::Control, 3, 1ms, 100);
    EXPECT_EQ(Take(1ms), (Routes{3, 2}));
}

TEST_F(KeyExchangeOutboxTest, BeyondTheShareControlGoesInTheOrderInWhichItCame)
{
    Put(1, Step::Keys, 1, 0ms, 600);
    for (std::uint32_t source = 100; source < 125; ++source)
    {
        Put(1, Step::Control, 1, 0ms, 100, source);
    }
    Take(0ms);
    Put({.To = Prefix(1), .What = Step::Control, .Source = 3, .IsWhole = true}, 2, 1ms, 100);
    Routes gone;
    for (std::uint32_t i = 0; i < 6000; ++i)
    {
        const auto at = 1ms + i * 10ms;
        Put(1, Step::Control, 4, at, 100, 100 + i % 25);
        for (const auto route : Take(at))
        {
            gone.push_back(route);
        }
    }
    EXPECT_EQ(std::count(gone.begin(), gone.end(), 2U), 1) << "is not passed by ever new control about keys";
}

TEST_F(KeyExchangeOutboxTest, ControlBeginsAnewWhenKeysCome)
{
    for (int at = 0; at < 1000; at += 10)
    {
        Put(1, Step::Control, 1, Milliseconds(at), 100);
        Take(Milliseconds(at));
    }
    Put(1, Step::Control, 1, 1000ms, 100);
    EXPECT_EQ(Take(1000ms), Routes{});
    Hear(1, Step::Keys, 1001ms);
    EXPECT_EQ(Take(1001ms), (Routes{1}));
}

TEST_F(KeyExchangeOutboxTest, WhatAWriterSaysOfItsKeysStaysBehindThem)
{
    Put(9, Step::Reply, 9, 0ms);
    Put(8, Step::Reply, 8, 0ms);
    Take(0ms);
    Put(1, Step::Keys, 1, 1ms, 1000, 5);
    Put(1, Step::Control, 2, 1ms, 100, 5);
    Put(1, Step::Control, 3, 1ms, 100, 6);
    EXPECT_EQ(Take(1ms), (Routes{3}));
    Hear(9, Step::Final, 2ms);
    EXPECT_EQ(Take(2ms), (Routes{1, 2}));
}

TEST_F(KeyExchangeOutboxTest, WhoAsksForKeysThatAreOnTheirWayIsNotHeard)
{
    Put(9, Step::Reply, 9, 0ms);
    Put(8, Step::Reply, 8, 0ms);
    Take(0ms);
    EXPECT_TRUE(Hear(1, Step::Control, 1ms));
    Put(1, Step::Keys, 1, 1ms, 1000);
    EXPECT_FALSE(Hear(1, Step::Control, 2ms));
    Hear(9, Step::Final, 400ms);
    EXPECT_EQ(Take(400ms), (Routes{1}));
    EXPECT_FALSE(Hear(1, Step::Control, 700ms));
    EXPECT_TRUE(Hear(1, Step::Control, 800ms));
}

TEST_F(KeyExchangeOutboxTest, WhatIsProtectedAsAWholeIsHeldAMomentAfterKeysAlone)
{
    const KeyExchange control{.To = Prefix(1), .What = Step::Control, .Source = 3, .IsWhole = true};
    EXPECT_FALSE(Put(control, 1, 0ms, 100));
    Put(1, Step::Keys, 2, 0ms, 600);
    Take(0ms);
    EXPECT_TRUE(Put(control, 1, 10ms, 100));
    EXPECT_TRUE(Put(control, 1, 5990ms, 100));
    EXPECT_FALSE(Put(control, 1, 6010ms, 100));
}

TEST_F(KeyExchangeOutboxTest, DatagramsOfIdleEndpointsAreDropped)
{
    Put(1, Step::Keys, 1, 0ms, 600);
    Take(0ms);
    EXPECT_TRUE(Put({.To = Prefix(1), .What = Step::Control, .IsIdle = true}, 2, 1ms, 100));
    EXPECT_TRUE(Put({.What = Step::Keys, .IsIdle = true}, 3, 1ms, 100)) << "to all as well";
    EXPECT_EQ(Take(10s), Routes{});
}

TEST_F(KeyExchangeOutboxTest, ASetRateBoundsAll)
{
    Outbox.SetRate(1000.0);
    Put(1, Step::Keys, 1, 0ms, 500 - KeyExchangeOutbox::Headers);
    Put(1, Step::Keys, 2, 0ms, 500 - KeyExchangeOutbox::Headers);
    EXPECT_EQ(Take(0ms), (Routes{1}));
    EXPECT_EQ(Next(), 500ms);
}

class RepeatedFinalTest : public KeyExchangeOutboxTest
{
protected:
    static constexpr Milliseconds Delay = KeyExchangeOutbox::FinalDelay;

    RepeatedFinalTest() : KeyExchangeOutboxTest(KeyExchangeOutbox(true))
    {
        Put(1, Step::Final, 1, 0ms);
        Take(0ms);
    }
};

TEST_F(RepeatedFinalTest, APeerThatShowsItsCertificateAgainIsAnsweredAgainAfterADelay)
{
    Hear(1, Step::Reply, 1000ms);
    EXPECT_EQ(Take(1000ms + Delay / 2), Routes{});
    EXPECT_EQ(Take(1000ms + Delay), (Routes{1}));
    EXPECT_EQ(Take(60s), Routes{});
}

TEST_F(RepeatedFinalTest, ItIsNotAnsweredWhileItShowsTheCertificate)
{
    Hear(1, Step::Reply, 1000ms);
    Hear(1, Step::Reply, 1000ms + Delay / 2);
    EXPECT_EQ(Take(1000ms + Delay), Routes{});
    EXPECT_EQ(Take(1000ms + 2 * Delay), (Routes{1}));
}

TEST_F(RepeatedFinalTest, APeerThatWasNotAnsweredYetIsNotAnsweredHere)
{
    Hear(2, Step::Reply, 1000ms);
    Hear(1, Step::Request, 1000ms);
    EXPECT_EQ(Take(60s), Routes{});
}

TEST_F(RepeatedFinalTest, OfAHandshakeThatBeganAnewTheNewestIsRepeated)
{
    Put(1, Step::Final, 2, 20s);
    EXPECT_EQ(Take(20s), (Routes{2}));
    Put(1, Step::Final, 3, 40s);
    Hear(1, Step::Reply, 40s);
    EXPECT_EQ(Take(40s), (Routes{3}));
    Hear(1, Step::Reply, 50s);
    EXPECT_EQ(Take(60s), (Routes{3}));
}

TEST_F(RepeatedFinalTest, OtherMessagesAreNotRepeated)
{
    Put(1, Step::Request, 2, 20s);
    EXPECT_EQ(Take(20s), (Routes{2}));
    Hear(1, Step::Reply, 30s);
    EXPECT_EQ(Take(60s), Routes{});
}

TEST_F(KeyExchangeOutboxTest, AVendorThatAnswersAgainByItselfIsNotHelped)
{
    Put(1, Step::Final, 1, 0ms);
    Take(0ms);
    Hear(1, Step::Reply, 1000ms);
    EXPECT_EQ(Take(60s), Routes{});
}

TEST_F(KeyExchangeOutboxTest, MemoryIsBoundedWhateverIsSaid)
{
    for (std::uint32_t peer = 0; peer < 2 * KeyExchangeOutbox::MostPeers; ++peer)
    {
        KeyExchange what{.What = Step::Keys, .Source = peer};
        what.To.fill(1);
        what.To[0] = static_cast<std::uint8_t>(peer & 0xff);
        what.To[1] = static_cast<std::uint8_t>(peer >> 8);
        EXPECT_TRUE(Put(what, peer, 0ms, 60000));
    }
    EXPECT_LE(Outbox.Peers(), KeyExchangeOutbox::MostPeers);
    std::size_t bytes = 0;
    for (auto at = 0s; at < 4000s; at += 10s)
    {
        for (const auto &datagram : Outbox.TakeDue(Start + at))
        {
            bytes += datagram.Bytes.size();
        }
    }
    EXPECT_GT(bytes, 0U);
    EXPECT_LE(bytes, KeyExchangeOutbox::MostWaiting);
}

TEST_F(KeyExchangeOutboxTest, OnlyAMessageThatIsNoRepetitionIsWaiting)
{
    EXPECT_FALSE(Outbox.IsWaiting(Prefix(1)));
    Put(1, Step::Request, 1, 0ms);
    EXPECT_TRUE(Outbox.IsWaiting(Prefix(1)));
    EXPECT_EQ(Take(0ms), Routes{1});
    EXPECT_FALSE(Outbox.IsWaiting(Prefix(1)));
    Put(1, Step::Request, 2, 1ms);
    EXPECT_FALSE(Outbox.IsWaiting(Prefix(1)));
    Put(1, Step::Final, 3, 2ms);
    EXPECT_TRUE(Outbox.IsWaiting(Prefix(1)));
}

TEST_F(KeyExchangeOutboxTest, NothingIsSentToAForgottenPeerAndItsBytesAreAnswered)
{
    Put(1, Step::Request, 1, 0ms);
    EXPECT_EQ(Take(0ms), Routes{1});
    Put(1, Step::Keys, 2, 1ms);
    Put(2, Step::Keys, 3, 2ms);
    Outbox.Forget(Prefix(1));
    Outbox.Forget(Prefix(9));
    EXPECT_EQ(Outbox.Unanswered(), 0);
    EXPECT_EQ(Outbox.Peers(), 1);
    EXPECT_EQ(Take(2ms), Routes{3});
}

}  // namespace
