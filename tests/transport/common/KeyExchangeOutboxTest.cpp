// When `KeyExchangeOutbox` sends the messages that two participants need to exchange their keys.
#include "common/KeyExchangeOutbox.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <set>
#include <vector>

namespace
{

using namespace std::chrono_literals;
using Rabit::KeyExchange;
using Rabit::KeyExchangeOutbox;
using Rabit::KeyExchangeStamp;
using Milliseconds = std::chrono::milliseconds;
using Step = KeyExchange::Step;
using Routes = std::vector<std::uint64_t>;

class KeyExchangeOutboxTest : public testing::Test
{
protected:
    static constexpr std::size_t Large = 4200;
    // Bytes that a datagram that is not protected as a whole takes beside its own.
    static constexpr std::size_t Around = KeyExchangeOutbox::Headers + KeyExchangeStamp::Size;

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
    static std::uint32_t Ticks(KeyExchangeOutbox::TimePoint time)
    {
        return static_cast<std::uint32_t>(
            std::chrono::duration_cast<Milliseconds>(time.time_since_epoch()).count());
    }
    // Begins an exchange with a peer.
    void Begin(std::uint8_t peer, Milliseconds at)
    {
        Put(peer, Step::Ask, 0, at, 100);
        Take(at);
        Hear(peer, Step::Request, at);
    }
    // An answer comes so long after the datagram that it answers.
    void Answer(std::uint8_t peer, Milliseconds took, Milliseconds at)
    {
        Outbox.Stamped(Prefix(peer), {.SentAt = 1, .Echo = Ticks(Start + at - took)}, Start + at);
    }
    KeyExchangeOutbox::Duration AnswerTime(Milliseconds at) const { return Outbox.AnswerTime(Start + at); }
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
            const auto at = std::chrono::ceil<Milliseconds>(*due - Start);
            if (!Take(at).empty())
            {
                return at;
            }
        }
        return Milliseconds::max();
    }

    const KeyExchangeOutbox::TimePoint Start{1000s};
    KeyExchangeOutbox Outbox;
};

TEST_F(KeyExchangeOutboxTest, TheFirstGoesAtOnce)
{
    EXPECT_TRUE(Put(1, Step::Request, 10, 0ms));
    EXPECT_EQ(Take(0ms), (Routes{10}));
    EXPECT_EQ(Outbox.Unanswered(), Large + Around);
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
    EXPECT_EQ(Take(90ms), Routes{});
}

TEST_F(KeyExchangeOutboxTest, AnAnswerMakesRoomForTheNext)
{
    for (std::uint8_t peer = 1; peer <= 3; ++peer)
    {
        Put(peer, Step::Reply, peer, 0ms);
    }
    Take(0ms);
    Hear(2, Step::Final, 50ms);
    EXPECT_EQ(Take(50ms), (Routes{3}));
}

TEST_F(KeyExchangeOutboxTest, QuickAnswersOpenTheWindowAndLateOnesCloseIt)
{
    Begin(1, 0ms);
    Begin(2, 0ms);
    Answer(1, 100ms, 1s);
    EXPECT_GT(Outbox.Window(), KeyExchangeOutbox::FirstWindow);
    const std::size_t open = Outbox.Window();
    Answer(2, 1500ms, 3s);
    EXPECT_EQ(Outbox.Window(), open / 2);
}

TEST_F(KeyExchangeOutboxTest, ADatagramOfAHandshakeEchoesTheNewestThatCame)
{
    Outbox.Stamped(Prefix(1), {.SentAt = 5000}, Start);
    Put(1, Step::Reply, 1, 30ms);
    const auto taken = Outbox.TakeDue(Start + 30ms);
    ASSERT_EQ(taken.size(), 1U);
    const auto stamp = KeyExchangeStamp::Of(taken.front().Bytes);
    ASSERT_TRUE(stamp);
    EXPECT_EQ(stamp->SentAt, Ticks(Start + 30ms));
    EXPECT_EQ(stamp->Echo, 5030U);
}

TEST_F(KeyExchangeOutboxTest, AnEchoTellsTheAnswerTimeAlsoOfARepetition)
{
    Put(1, Step::Request, 1, 0ms);
    Take(0ms);
    EXPECT_EQ(Take(100ms), (Routes{1}));
    Answer(1, 10ms, 110ms);
    EXPECT_EQ(AnswerTime(110ms), 10ms);
}

TEST_F(KeyExchangeOutboxTest, AnEchoThatCannotBeTrueTellsNothing)
{
    Begin(1, 0ms);
    Answer(1, -1ms, 100ms);
    EXPECT_EQ(AnswerTime(100ms), 0ms);
    for (auto at = 0ms; at < 2 * KeyExchangeOutbox::LongestAnswer; at += 1000ms)
    {
        Hear(1, Step::Request, at);
    }
    Answer(1, KeyExchangeOutbox::LongestAnswer + 1ms, 2 * KeyExchangeOutbox::LongestAnswer);
    EXPECT_EQ(AnswerTime(2 * KeyExchangeOutbox::LongestAnswer), 0ms);
}

TEST_F(KeyExchangeOutboxTest, AnEchoThatIsOlderThanTheFirstStampToThePeerTellsNothing)
{
    Begin(1, 1000ms);
    Answer(1, 19s, 1500ms);
    EXPECT_EQ(AnswerTime(1500ms), 0ms);
    Answer(1, 500ms, 1500ms);
    EXPECT_EQ(AnswerTime(1500ms), 500ms);
}

TEST_F(KeyExchangeOutboxTest, AnEchoThatIsOlderThanTheFirstStampOfANewExchangeTellsNothing)
{
    Begin(1, 0ms);
    Begin(1, 30s);
    Answer(1, 19s, 31s);
    EXPECT_EQ(AnswerTime(31s), 0ms);
}

TEST_F(KeyExchangeOutboxTest, AnEchoFromAPeerWithoutAnExchangeTellsNothing)
{
    Begin(1, 0ms);
    Answer(2, 400ms, 500ms);
    EXPECT_EQ(AnswerTime(500ms), 0ms);
}

TEST_F(KeyExchangeOutboxTest, AnEchoFromAPeerWithASettledExchangeTellsNothing)
{
    Begin(1, 0ms);
    Begin(2, 6s);
    Answer(1, 400ms, 7s);
    EXPECT_EQ(AnswerTime(7s), 0ms);
}

TEST_F(KeyExchangeOutboxTest, AnswerTimeAndWindowAreForgottenWhenAllExchangesHaveSettled)
{
    Begin(1, 0ms);
    Answer(1, 3s, 3s);
    EXPECT_LT(Outbox.Window(), KeyExchangeOutbox::FirstWindow);
    EXPECT_EQ(AnswerTime(5990ms), 3s);
    EXPECT_EQ(AnswerTime(6s), 0ms);
    Put(2, Step::Reply, 2, 7s);
    EXPECT_EQ(Outbox.Window(), KeyExchangeOutbox::FirstWindow);
    EXPECT_EQ(Take(7s), (Routes{2}));
    EXPECT_EQ(Next(), 7s + KeyExchangeOutbox::FirstGap);
}

TEST_F(KeyExchangeOutboxTest, ADatagramThatIsProtectedAsAWholeHasNoStamp)
{
    Put(1, Step::Keys, 1, 0ms, 600);
    Put({.To = Prefix(1), .What = Step::Keys, .IsWhole = true}, 2, 0ms, 600);
    Put({.To = Prefix(1), .What = Step::Control, .IsWhole = true}, 3, 0ms, 600);
    const auto taken = Outbox.TakeDue(Start);
    ASSERT_EQ(taken.size(), 3U);
    EXPECT_EQ(taken[0].Bytes.size(), 600U + KeyExchangeStamp::Size);
    EXPECT_EQ(taken[1].Bytes.size(), 600U);
    EXPECT_EQ(taken[2].Bytes.size(), 600U);
}

TEST_F(KeyExchangeOutboxTest, LossMakesRoomAndDoesNotCloseTheWindow)
{
    Put(1, Step::Reply, 1, 0ms);
    Put(2, Step::Reply, 2, 0ms);
    Put(3, Step::Reply, 3, 0ms);
    EXPECT_EQ(Take(0ms), (Routes{1, 2}));
    EXPECT_EQ(Take(KeyExchangeOutbox::FirstGap), (Routes{3, 1}));
    EXPECT_EQ(Outbox.Window(), KeyExchangeOutbox::FirstWindow);
}

TEST_F(KeyExchangeOutboxTest, AnUnansweredMessageIsRepeatedUntilTheVendorHasBeenSilent)
{
    Put(1, Step::Request, 1, 0ms);
    std::vector<Milliseconds::rep> times;
    for (auto at = Next(); at != Milliseconds::max(); at = Next())
    {
        times.push_back(at.count());
    }
    EXPECT_EQ(times, (std::vector<Milliseconds::rep>{0, 100, 250, 475, 813, 1320, 2080}));
}

TEST_F(KeyExchangeOutboxTest, ARepetitionHasAllFragments)
{
    Put({.To = Prefix(1), .What = Step::Request, .Number = 7}, 1, 0ms, 1000);
    Take(0ms);
    Put({.To = Prefix(1), .What = Step::Rest, .Number = 7}, 2, 1ms, 1000);
    EXPECT_EQ(Take(1ms), (Routes{2}));
    EXPECT_EQ(Take(KeyExchangeOutbox::FirstGap), (Routes{1, 2}));
}

TEST_F(KeyExchangeOutboxTest, TheNewestOfTheVendorsRepetitionsIsRepeated)
{
    Put(1, Step::Request, 1, 0ms);
    Take(0ms);
    Put(1, Step::Request, 2, 20ms);
    EXPECT_EQ(Take(20ms), Routes{});
    EXPECT_EQ(Take(KeyExchangeOutbox::FirstGap), (Routes{2}));
}

TEST_F(KeyExchangeOutboxTest, RepetitionsFollowEachOtherWithinASecondHoweverMany)
{
    std::vector<int> times;
    for (int at = 0; at < 20000; at += 10)
    {
        if (at % 1000 == 0)
        {
            Put(1, Step::Request, static_cast<std::uint64_t>(at), Milliseconds(at));
        }
        if (!Take(Milliseconds(at)).empty())
        {
            times.push_back(at);
        }
    }
    EXPECT_GT(times.back(), 18000);
    for (std::size_t i = 1; i < times.size(); ++i)
    {
        EXPECT_LE(times[i] - times[i - 1], 1010);
    }
}

TEST_F(KeyExchangeOutboxTest, ARepetitionWaitsForTwoAnswerTimes)
{
    Begin(1, 0ms);
    Answer(1, 1s, 1s);
    Put(2, Step::Reply, 2, 2s);
    EXPECT_EQ(Take(2s), (Routes{2}));
    EXPECT_EQ(Take(3990ms), Routes{});
    EXPECT_EQ(Take(4s), (Routes{2}));
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
    EXPECT_EQ(Take(100ms), (Routes{1}));
    EXPECT_EQ(Take(250ms), (Routes{1}));
    Hear(1, Step::Request, 390ms);
    EXPECT_EQ(Take(400ms), (Routes{2}))
        << "four times the answer time at first, since the first request to 1";
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
    std::set<std::uint64_t> gone;
    for (auto at = 0ms; at <= KeyExchangeOutbox::LongestWait; at += 1000ms)
    {
        for (const auto route : Take(at))
        {
            gone.insert(route);
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
    Put(1, Step::Request, 2, 50ms);
    Hear(1, Step::Reply, 60ms);
    EXPECT_EQ(Take(10s), Routes{});
}

TEST_F(KeyExchangeOutboxTest, AReplyIsKeptUntilTheFinalMessageComes)
{
    Put(1, Step::Reply, 1, 0ms);
    Take(0ms);
    Put(1, Step::Reply, 2, 50ms);
    Hear(1, Step::Keys, 60ms);
    EXPECT_EQ(Take(100ms), (Routes{2}));
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
            Put(1, Step::Control, 1, at, 100 - Around, source);
        }
        return Take(at).size();
    };
    EXPECT_EQ(controls(100, 0ms), 20U) << "2000 bytes at first";
    Put(1, Step::Keys, 2, 1ms, 2000 - Around);
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
    Answer(9, 80ms, 80ms);
    Hear(9, Step::Final, 80ms);
    EXPECT_EQ(Take(80ms), (Routes{1}));
    EXPECT_FALSE(Hear(1, Step::Control, 150ms));
    EXPECT_TRUE(Hear(1, Step::Control, 160ms));
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
    Put(1, Step::Keys, 1, 0ms, 500 - Around);
    Put(1, Step::Keys, 2, 0ms, 500 - Around);
    EXPECT_EQ(Take(0ms), (Routes{1}));
    EXPECT_EQ(Next(), 500ms);
}

class RepeatedFinalTest : public KeyExchangeOutboxTest
{
protected:
    static constexpr Milliseconds Delay = KeyExchangeOutbox::FinalDelay;

    RepeatedFinalTest()
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

TEST_F(RepeatedFinalTest, FurtherCertificatesDoNotPutTheAnswerOff)
{
    Hear(1, Step::Reply, 1000ms);
    Hear(1, Step::Reply, 1000ms + Delay / 2);
    EXPECT_EQ(Take(1000ms + Delay), (Routes{1}));
    EXPECT_EQ(Take(60s), Routes{});
}

TEST_F(RepeatedFinalTest, TheVendorsOwnAnswerTakesThePlaceOfTheRepetition)
{
    Hear(1, Step::Reply, 1000ms);
    Put(1, Step::Final, 2, 1001ms);
    EXPECT_EQ(Take(1000ms + Delay), (Routes{2}));
    EXPECT_EQ(Take(60s), Routes{});
}

TEST_F(RepeatedFinalTest, ManyCertificatesAreAnsweredOnceASecond)
{
    int answers = 0;
    for (auto at = 1000ms; at < 21s; at += 10ms)
    {
        Hear(1, Step::Reply, at);
        Hear(1, Step::Control, at);
        answers += static_cast<int>(Take(at).size());
    }
    EXPECT_LE(answers, 27);
    EXPECT_GE(answers, 20);
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
    Hear(1, Step::Reply, 50s);
    EXPECT_EQ(Take(60s), (Routes{2}));
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
