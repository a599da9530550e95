// Nodes that meet by their cards over a network that loses datagrams: models of DDS implementations behind
// Meeting.
#include "rtps/Meeting.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <deque>
#include <memory>
#include <queue>
#include <random>
#include <utility>

#include "rtps/Implementation.h"
#include "rtps/PackedCard.h"

namespace
{

using namespace std::chrono_literals;
using namespace Rabit::Rtps;
using Bytes = RtpsBytes::Bytes;
using TimePoint = Meeting::TimePoint;

constexpr HostAddress Host{10, 0, 0, 1};

GuidPrefix Name(std::uint8_t number)
{
    GuidPrefix name = RtpsBytes::Sender;
    name.back() = number;
    return name;
}

// A network of nodes; time passes in steps of a millisecond.
class Air
{
public:
    struct Node
    {
        GuidPrefix Self{};
        std::unique_ptr<Meeting> Meet;  // null: a program without a card
        std::unique_ptr<Implementation> Dds;
        bool Hears = true;
        std::deque<Bytes> Queue{};  // in front of its radio
        std::size_t Queued = 0;     // bytes
        std::size_t Said = 0;       // datagrams
    };

    explicit Air(unsigned seed) : _random(seed) {}

    Node &Add(std::uint8_t number, int endpoints, bool hasCard = true)
    {
        Node &node = *_nodes.emplace_back(std::make_unique<Node>());
        node.Self = Name(number);
        if (hasCard)
        {
            node.Meet = std::make_unique<Meeting>(Meeting::Settings{.Period = 10s, .Memory = 4h});
        }
        node.Dds = std::make_unique<Implementation>(node.Self,
                                                    [this, &node](const Bytes &message)
                                                    {
                                                        if (!node.Meet || !node.Meet->Sending(message, Now))
                                                        {
                                                            Send(node, message);
                                                        }
                                                    });
        for (int i = 0; i < endpoints; ++i)
        {
            node.Dds->AddWriter(RtpsBytes::UserWriter + 0x100u * static_cast<unsigned>(i));
        }
        return node;
    }
    void Send(Node &from, const Bytes &datagram)
    {
        constexpr std::size_t radioQueue = 16'000;
        Offered += datagram.size() + CardExchange::IpAndUdp;
        ++from.Said;
        if (BytesPerSecond == 0.0)
        {
            Carry(from, datagram);
        }
        else if (from.Queued + datagram.size() <= radioQueue)
        {
            from.Queued += datagram.size();
            from.Queue.push_back(datagram);
        }
    }
    void Carry(const Node &from, const Bytes &datagram)
    {
        std::uniform_real_distribution<double> chance(0.0, 100.0);
        for (const auto &node : _nodes)
        {
            if (node.get() != &from && node->Hears && from.Hears && chance(_random) >= Loss)
            {
                _underWay.push_back({Now + 1ms, node.get(), datagram});
            }
        }
    }
    void Run(std::chrono::milliseconds time)
    {
        for (const auto end = Now + time; Now < end; Now += 1ms)
        {
            Step();
        }
    }
    // Runs until the condition holds, or `limit` has passed. Returns whether it holds.
    template <typename Holds>
    bool Until(const Holds &holds, std::chrono::milliseconds limit = 20s)
    {
        const auto end = Now + limit;
        while (!holds() && Now < end)
        {
            Step();
            Now += 1ms;
        }
        return holds();
    }
    bool AllKnowAll(std::size_t endpoints) const
    {
        for (const auto &node : _nodes)
        {
            for (const auto &other : _nodes)
            {
                if (node != other && node->Dds->EndpointsOf(other->Self).size() != endpoints)
                {
                    return false;
                }
            }
        }
        return true;
    }

    TimePoint Now{1h};
    double Loss = 0.0;            // percent
    bool Beats = false;           // nodes that know somebody send a sample twice a second
    double BytesPerSecond = 0.0;  // of a channel that all share, one datagram after the other; 0: it is wide
    std::size_t Offered = 0;

private:
    struct UnderWay
    {
        TimePoint At;
        Node *To;
        Bytes Datagram;
    };

    // The radios take turns.
    void Transmit()
    {
        while (_free <= Now && std::any_of(_nodes.begin(), _nodes.end(),
                                           [](const auto &node) { return !node->Queue.empty(); }))
        {
            Node &node = *_nodes[_turn++ % _nodes.size()];
            if (!node.Queue.empty())
            {
                const Bytes datagram = std::move(node.Queue.front());
                node.Queue.pop_front();
                node.Queued -= datagram.size();
                const auto size = static_cast<double>(datagram.size() + CardExchange::IpAndUdp);
                _free = std::max(_free, Now) + std::chrono::ceil<TimePoint::duration>(
                                                   std::chrono::duration<double>(size / BytesPerSecond));
                Carry(node, datagram);
            }
        }
    }
    void Step()
    {
        Transmit();
        std::vector<UnderWay> arrived;
        std::erase_if(_underWay,
                      [&](UnderWay &each)
                      {
                          const bool is = each.At <= Now;
                          if (is)
                          {
                              arrived.push_back(std::move(each));
                          }
                          return is;
                      });
        for (const UnderWay &each : arrived)
        {
            Arrive(*each.To, each.Datagram);
        }
        for (const auto &node : _nodes)
        {
            if ((Now - TimePoint(1h)) % 1s == 0s)
            {
                node->Dds->Tick();
            }
            if (Beats && (Now - TimePoint(1h)) % 500ms == 0s && node->Dds->KnowsAny())
            {
                Send(*node, RtpsBytes::Header(node->Self));
            }
            while (node->Meet && IsDue(node->Meet->LocalDue()))
            {
                for (const auto &local : node->Meet->TakeLocal(Now))
                {
                    node->Dds->Receive(local.Bytes);
                }
            }
            while (node->Meet && IsDue(node->Meet->NetworkDue()))
            {
                if (const auto outgoing = node->Meet->TakeForNetwork(Now))
                {
                    Send(*node, outgoing->Bytes);
                }
            }
        }
    }
    bool IsDue(const std::optional<TimePoint> &time) const { return time && *time <= Now; }
    static void Arrive(Node &node, const Bytes &datagram, const HostAddress &from, TimePoint now)
    {
        if (!node.Meet)
        {
            node.Dds->Receive(datagram);
            return;
        }
        const GuidPrefix sender = SenderOf(datagram);
        if (IsCardMessage(datagram))
        {
            EXPECT_TRUE(node.Meet->Received(datagram, from, false, now));
        }
        else if (!node.Meet->IsReplayed(sender))
        {
            const bool announces = datagram == RtpsBytes::ParticipantMessage(sender);
            const bool isProgram = sender.back() >= 200;
            if (announces)
            {
                node.Meet->Announced(sender, !isProgram, now);
            }
            if (isProgram)
            {
                node.Dds->Receive(datagram);
            }
            else if (!announces)
            {
                node.Meet->HeardUnknown(sender, now);
            }
        }
    }
    void Arrive(Node &node, const Bytes &datagram) { Arrive(node, datagram, Host, Now); }

    std::mt19937 _random;
    std::vector<std::unique_ptr<Node>> _nodes;
    std::vector<UnderWay> _underWay;
    TimePoint _free{};
    std::size_t _turn = 0;
};

class MeetingOfTwo : public testing::Test
{
protected:
    MeetingOfTwo()
    {
        One.Dds->Announce();
        Two.Dds->Announce();
    }

    Air Channel{1};
    Air::Node &One = Channel.Add(1, 8);
    Air::Node &Two = Channel.Add(2, 8);
};

TEST_F(MeetingOfTwo, TwoNodesKnowEachOthersEndpointsAfterTwoCards)
{
    EXPECT_TRUE(Channel.Until([&] { return Channel.AllKnowAll(8); }, 100ms));
}

TEST_F(MeetingOfTwo, TheImplementationIsToldThatAllWasAcknowledged)
{
    EXPECT_TRUE(Channel.Until(
        [&] { return One.Dds->IsAcknowledgedBy(Two.Self) && Two.Dds->IsAcknowledgedBy(One.Self); }));
}

TEST_F(MeetingOfTwo, NothingButSummariesGoesOnceAllIsKnown)
{
    Channel.Run(20s);
    ASSERT_TRUE(Channel.AllKnowAll(8));
    Channel.Offered = 0;
    Channel.Run(60s);
    EXPECT_LE(Channel.Offered, 2u * 7u * 80u);
}

TEST_F(MeetingOfTwo, AnEndpointThatComesLaterIsKnownSoon)
{
    Channel.Run(20s);
    One.Dds->AddWriter(0x00007703);
    EXPECT_TRUE(Channel.Until([&] { return Two.Dds->EndpointsOf(One.Self).contains(0x00007703); }, 100ms));
}

// A goodbye may be forged.
TEST_F(MeetingOfTwo, ANodeThatGoesOnAfterItsGoodbyeIsMetAgain)
{
    Channel.Run(20s);
    Channel.Beats = true;
    Two.Meet->SaidGoodbye(One.Self, Channel.Now);
    One.Dds->Announce();
    Channel.Run(RecentGoodbyes::Overtaken + RecentGoodbyes::GoesOn);
    EXPECT_FALSE(Two.Meet->IsReplayed(One.Self));
    EXPECT_TRUE(Channel.Until([&] { return Two.Meet->IsReplayed(One.Self); }, 1s));
}

// A node with many endpoints, and one that learns of them.
class MeetingOfMany : public testing::Test
{
protected:
    // Each announcement has so many bytes of its own, at random, and so many that are the same in all.
    void Add(std::uint32_t count, std::size_t random, std::size_t same)
    {
        std::mt19937 numbers(1);
        for (std::uint32_t i = 1; i <= count; ++i)
        {
            Bytes data(random + same);
            std::generate_n(data.begin(), random, [&] { return static_cast<std::uint8_t>(numbers()); });
            One.Dds->AddWriter(
                i << 8 | 3,
                RtpsBytes::Parameter(
                    0x002c,
                    RtpsBytes::Join({RtpsBytes::U32(static_cast<std::uint32_t>(data.size())), data})));
        }
        One.Dds->Announce();
        Two.Dds->Announce();
    }
    std::set<EntityId> Known() const { return Two.Dds->EndpointsOf(One.Self); }

    Air Channel{1};
    Air::Node &One = Channel.Add(1, 0);
    Air::Node &Two = Channel.Add(2, 1);
};

TEST_F(MeetingOfMany, AsManyEndpointsAsTheGuardAcceptsGoInOneCard)
{
    Add(OwnCard::MostEndpoints, 20, 260);
    EXPECT_TRUE(Channel.Until([&] { return Known().size() == OwnCard::MostEndpoints; }));
    EXPECT_FALSE(One.Meet->CardIsFull());
}

TEST_F(MeetingOfMany, OfMoreEndpointsTheFirstOnesGoInTheCard)
{
    Add(OwnCard::MostEndpoints + 100, 0, 40);
    EXPECT_TRUE(Channel.Until([&] { return Known().size() == OwnCard::MostEndpoints; }));
    EXPECT_EQ(*Known().rbegin(), OwnCard::MostEndpoints << 8 | 3);
    const auto full = One.Meet->CardIsFull();
    ASSERT_TRUE(full.has_value());
    EXPECT_EQ(full->Endpoints, OwnCard::MostEndpoints + 100);
    EXPECT_EQ(full->InCard, OwnCard::MostEndpoints);
}

TEST_F(MeetingOfMany, ANodeWhoseEndpointsPackToTooMuchIsMetAllTheSame)
{
    Add(500, 200, 0);
    EXPECT_TRUE(Channel.Until([&] { return Known().size() >= 250; }));
    Channel.Run(1s);
    const auto full = One.Meet->CardIsFull();
    ASSERT_TRUE(full.has_value());
    EXPECT_EQ(full->Endpoints, 500u);
    EXPECT_EQ(full->InCard, Known().size());
}

TEST_F(MeetingOfMany, WhatIsInACardStaysInTheNextOne)
{
    Add(500, 200, 0);
    EXPECT_TRUE(Channel.Until([&] { return Known().size() >= 250; }));
    Channel.Run(1s);
    const auto before = Known();
    One.Dds->AddWriter(1u << 8 | 3, RtpsBytes::Parameter(0x002c, RtpsBytes::U32(0)));  // it has changed
    Channel.Run(5s);
    EXPECT_EQ(Known(), before);
}

TEST(Meeting, ALostCardIsAskedFor)
{
    Air air(1);
    Air::Node &one = air.Add(1, 8);
    one.Dds->Announce();
    air.Run(30s);
    Air::Node &two = air.Add(2, 8);
    two.Dds->Announce();
    EXPECT_TRUE(air.Until([&] { return air.AllKnowAll(8); }, 200ms));
}

TEST(Meeting, ADatagramOfAnUnknownParticipantIsAReasonToMeet)
{
    Air air(1);
    Air::Node &one = air.Add(1, 3);
    Air::Node &two = air.Add(2, 3);
    one.Hears = false;
    one.Dds->Announce();
    air.Run(9500ms);
    two.Dds->Announce();
    air.Run(9500ms);
    one.Hears = true;
    air.Send(one, RtpsBytes::Join({RtpsBytes::Header(one.Self)}));
    EXPECT_TRUE(air.Until([&] { return air.AllKnowAll(3); }, 150ms));
}

TEST(Meeting, UnderLossAllMeetSoon)
{
    for (const auto &[loss, limit] : {std::pair(20.0, 800ms), std::pair(40.0, 2500ms)})
    {
        std::vector<std::chrono::milliseconds> times;
        for (unsigned seed = 1; seed <= 500; ++seed)
        {
            Air air(seed);
            air.Loss = loss;
            air.Beats = true;
            Air::Node &one = air.Add(1, 8);
            Air::Node &two = air.Add(2, 8);
            one.Dds->Announce();
            two.Dds->Announce();
            const auto began = air.Now;
            ASSERT_TRUE(air.Until([&] { return air.AllKnowAll(8); })) << "seed " << seed;
            times.push_back(std::chrono::duration_cast<std::chrono::milliseconds>(air.Now - began));
        }
        std::sort(times.begin(), times.end());
        std::printf("%.0f %%: p50 %lld p99 %lld worst %lld ms\n", loss,
                    static_cast<long long>(times[250].count()), static_cast<long long>(times[495].count()),
                    static_cast<long long>(times.back().count()));
        EXPECT_LE(times[495].count(), limit.count()) << loss << " % lost, worst " << times.back().count();
    }
}

TEST(Meeting, TenNodesThatStartAtOnceSayLittle)
{
    Air air(1);
    for (std::uint8_t number = 1; number <= 10; ++number)
    {
        air.Add(number, 8).Dds->Announce();
    }
    ASSERT_TRUE(air.Until([&] { return air.AllKnowAll(8); }, 300ms));
    EXPECT_LE(air.Offered, 40'000u);
}

TEST(Meeting, ACrowdOnAThinChannelSaysEachCardFewTimes)
{
    Air air(1);
    air.BytesPerSecond = 5000.0;  // what other traffic leaves of 250 kbit/s
    for (std::uint8_t number = 1; number <= 11; ++number)
    {
        air.Add(number, 12).Dds->Announce();
    }
    const auto began = air.Now;
    EXPECT_TRUE(air.Until([&] { return air.AllKnowAll(12); }, 30s));
    const double took = std::chrono::duration<double>(air.Now - began).count();
    std::printf("%.2f s, %zu bytes\n", took, air.Offered);
    EXPECT_LE(took, 7.0);  // 23 kB, if each card went once: 4.7 s
    EXPECT_LE(air.Offered, 60'000u);
}

TEST(Meeting, FiveNodesAtOnceUnderLossAllMeetSoon)
{
    std::vector<std::chrono::milliseconds> times;
    for (unsigned seed = 1; seed <= 200; ++seed)
    {
        Air air(seed);
        air.Loss = 40.0;
        air.Beats = true;
        for (std::uint8_t number = 1; number <= 5; ++number)
        {
            air.Add(number, 8).Dds->Announce();
        }
        const auto began = air.Now;
        ASSERT_TRUE(air.Until([&] { return air.AllKnowAll(8); })) << "seed " << seed;
        times.push_back(std::chrono::duration_cast<std::chrono::milliseconds>(air.Now - began));
    }
    std::sort(times.begin(), times.end());
    std::printf("p50 %lld p99 %lld worst %lld ms\n", static_cast<long long>(times[100].count()),
                static_cast<long long>(times[198].count()), static_cast<long long>(times.back().count()));
    EXPECT_LE(times[198].count(), 4000) << "worst " << times.back().count();
}

TEST(Meeting, ANodeThatJoinsAFullChannelSaysLittle)
{
    Air air(1);
    air.BytesPerSecond = 5000.0;
    Air::Node &one = air.Add(1, 8);
    Air::Node &two = air.Add(2, 8);
    one.Dds->Announce();
    two.Dds->Announce();
    ASSERT_TRUE(air.Until([&] { return air.AllKnowAll(8); }));
    air.Run(20s);
    // In each queue, two seconds of other traffic always wait.
    const Bytes sample = RtpsBytes::Join({RtpsBytes::Header(one.Self), Bytes(472, 0x80)});
    const auto fill = [&]
    {
        while (one.Queued < 5000)
            air.Send(one, sample);
        while (two.Queued < 5000)
            air.Send(two, sample);
    };
    fill();
    Air::Node &late = air.Add(3, 8);
    late.Dds->Announce();
    const auto began = air.Now;
    while (!air.AllKnowAll(8) && air.Now - began < 60s)
    {
        fill();
        air.Run(1ms);
    }
    std::printf("%.2f s, %zu messages\n", std::chrono::duration<double>(air.Now - began).count(), late.Said);
    EXPECT_TRUE(air.AllKnowAll(8));
    EXPECT_LE(late.Said, 40u);
}

TEST(Meeting, AProgramWithoutACardGetsTheImplementationsOwnDatagrams)
{
    Air air(1);
    Air::Node &node = air.Add(1, 3);
    Air::Node &program = air.Add(200, 3, false);
    node.Dds->Announce();
    program.Dds->Announce();
    EXPECT_TRUE(air.Until([&] { return air.AllKnowAll(3); }, 3s));
}

TEST_F(MeetingOfTwo, AParticipantThatWasForgottenOnTheWayIsToldOfAgain)
{
    ASSERT_TRUE(Channel.Until([&] { return Channel.AllKnowAll(8); }));
    Two.Dds = std::make_unique<Implementation>(
        Two.Self, [&](const Bytes &message) { Two.Meet->Sending(message, Channel.Now); });
    ASSERT_FALSE(Two.Dds->Knows(One.Self));
    Two.Meet->HeardUnknown(One.Self, Channel.Now);
    EXPECT_TRUE(Channel.Until([&] { return Two.Dds->EndpointsOf(One.Self).size() == 8; }, 500ms));
}

// A card of a participant, with writers of these numbers.
Bytes CardOf(const GuidPrefix &name, std::initializer_list<std::uint32_t> writers)
{
    using namespace RtpsBytes;
    Bytes card =
        Join({Header(name), RtpsBytes::Submessage(Data, DataBody(1, ParticipantData(name), 0x000100c2), 5)});
    std::int64_t number = 0;
    for (const std::uint32_t writer : writers)
    {
        const Bytes body = DataBody(++number, WriterData(writer << 8 | 3, name), 0x000003c2);
        card = Join({card, RtpsBytes::Submessage(Data, body, 5)});
    }
    return card;
}

// The message that brings that card whole.
Bytes CardMessageOf(const GuidPrefix &name, std::initializer_list<std::uint32_t> writers)
{
    const Bytes packed = PackCard(CardOf(name, writers));
    CardMessage message{.From = name, .Summary = SummaryOf(packed)};
    message.HasPart = true;
    message.Bytes = packed;
    return WriteCardMessage(message);
}

TEST(Meeting, ACardThatCameFromElsewhereIsNotBelievedBeforeItCameOften)
{
    Meeting meeting({.Period = 10s, .Memory = 4h});
    const TimePoint now{1h};
    const Bytes summary = CardMessageOf(Name(7), {1, 2});
    EXPECT_TRUE(meeting.Received(summary, Host, false, now));
    const HostAddress elsewhere{10, 0, 0, 66};
    EXPECT_FALSE(meeting.Received(summary, elsewhere, false, now));
    EXPECT_FALSE(meeting.Received(summary, elsewhere, false, now));
    EXPECT_TRUE(meeting.Received(summary, Host, false, now));
    EXPECT_FALSE(meeting.Received(summary, elsewhere, false, now));
    EXPECT_FALSE(meeting.Received(summary, elsewhere, false, now));
    EXPECT_TRUE(meeting.Received(summary, elsewhere, false, now));
}

TEST(Meeting, AParticipantSpeaksFromAllAddressesThatItsCardNamesBeforeTheGuardKnowsIt)
{
    Bytes card = CardOf(Name(7), {1, 2});
    const auto named =
        std::search(card.begin(), card.end(), RtpsBytes::SenderHost.begin(), RtpsBytes::SenderHost.end());
    ASSERT_NE(named, card.end());
    const HostAddress second{10, 0, 1, 1};
    std::copy(second.begin(), second.end(), named);
    const Bytes packed = PackCard(card);
    CardMessage message{.From = Name(7), .Summary = SummaryOf(packed)};
    message.HasPart = true;
    message.Bytes = packed;
    const Bytes said = WriteCardMessage(message);
    Meeting meeting({.Period = 10s, .Memory = 4h});
    const TimePoint now{1h};
    EXPECT_TRUE(meeting.Received(said, Host, false, now));
    EXPECT_TRUE(meeting.Received(said, second, false, now));
    EXPECT_TRUE(meeting.Received(said, HostAddress{127, 0, 0, 9}, false, now)) << "this host";
    EXPECT_FALSE(meeting.Received(said, HostAddress{10, 0, 0, 66}, false, now));
}

TEST(Meeting, ACardThatWasHeldUpForLongBehindAGoodbyeBringsNobodyBack)
{
    Meeting meeting({.Period = 10s, .Memory = 4h});
    TimePoint now{1h};
    const Bytes card = CardMessageOf(Name(7), {1, 2});
    EXPECT_TRUE(meeting.Received(card, Host, false, now));
    EXPECT_TRUE(meeting.IsReplayed(Name(7)));
    meeting.SaidGoodbye(Name(7), now);
    now += 10s;
    // All that waited in the queue comes together.
    for (int i = 0; i < 10; ++i)
    {
        now += 100ms;
        EXPECT_TRUE(meeting.Received(card, Host, false, now));
        meeting.HeardUnknown(Name(7), now);
        EXPECT_FALSE(meeting.IsReplayed(Name(7)));
    }
}

TEST(Meeting, ACardFromAnotherAddressThatItsSenderHasNamedIsBelieved)
{
    Meeting meeting({.Period = 10s, .Memory = 4h});
    const TimePoint now{1h};
    const Bytes summary = CardMessageOf(Name(7), {1, 2});
    EXPECT_TRUE(meeting.Received(summary, Host, false, now));
    EXPECT_TRUE(meeting.Received(summary, HostAddress{10, 0, 0, 2}, true, now));
}

TEST(Meeting, InventedParticipantsCauseFewRequests)
{
    Air air(1);
    Air::Node &node = air.Add(1, 3);
    node.Dds->Announce();
    air.Run(20s);
    air.Offered = 0;
    std::mt19937 random(1);
    for (int at = 0; at < 10'000; ++at)
    {
        GuidPrefix invented{};
        std::generate(invented.begin(), invented.end(), [&] { return static_cast<std::uint8_t>(random()); });
        node.Meet->HeardUnknown(invented, air.Now);
        if (at % 10 == 0)
        {
            air.Run(1ms);
        }
    }
    air.Run(5s);
    EXPECT_LE(air.Offered, 6u * 2000u);
}

// Gives the replayed messages to the implementation, and its answers back, until nothing is due.
void Settle(CardReplay &replay, Implementation &dds, std::vector<Bytes> &said, CardReplay::TimePoint now)
{
    const OwnCard own;
    for (int turn = 0; turn < 100 && replay.Due(); ++turn)
    {
        now = std::max(now, *replay.Due());
        for (const CardReplay::Message &message : replay.TakeDue(now, own))
        {
            dds.Receive(message.Bytes);
        }
        for (const Bytes &answer : std::exchange(said, {}))
        {
            const auto parts = ReadEndpointSubmessages(answer);
            for (const EndpointSubmessage &part : parts.value_or(std::vector<EndpointSubmessage>()))
            {
                replay.Said(part, now);
            }
        }
    }
}

TEST(CardReplayTest, ANewCardReplacesTheFormerOneEntirely)
{
    constexpr GuidPrefix self{1, 15, 1};
    constexpr GuidPrefix peer{1, 15, 2};
    std::vector<Bytes> said;
    Implementation dds(self, [&said](const Bytes &message) { said.push_back(message); });
    CardReplay replay(1h);
    replay.SetSelf(self);
    const CardReplay::TimePoint now(1h);
    ASSERT_TRUE(replay.Put(peer, CardOf(peer, {1, 2}), now));
    Settle(replay, dds, said, now);
    EXPECT_EQ(dds.EndpointsOf(peer), (std::set<EntityId>{0x103, 0x203}));
    const std::size_t bytes = replay.BytesOf(peer);
    for (std::uint32_t writer = 3; writer < 300; ++writer)
    {
        ASSERT_TRUE(replay.Put(peer, CardOf(peer, {2, writer}), now));
        Settle(replay, dds, said, now);
        ASSERT_EQ(dds.EndpointsOf(peer), (std::set<EntityId>{0x203, writer << 8 | 3}));
        ASSERT_EQ(replay.BytesOf(peer), bytes);
    }
}

TEST(CardReplayTest, AnImplementationThatAcknowledgesNothingMakesItKeepNoMoreThanTwoCards)
{
    constexpr GuidPrefix peer{1, 15, 2};
    CardReplay replay(1h);
    const CardReplay::TimePoint now(1h);
    ASSERT_TRUE(replay.Put(peer, CardOf(peer, {1}), now));
    const std::size_t one = replay.BytesOf(peer);
    for (std::uint32_t writer = 2; writer < 5000; ++writer)
    {
        ASSERT_TRUE(replay.Put(peer, CardOf(peer, {writer}), now));
    }
    EXPECT_LE(replay.BytesOf(peer), (2 * OwnCard::MostEndpoints + 1) * one);
}

TEST(CardReplayTest, ACardAfterAnotherAnnouncementEndsThatFirst)
{
    constexpr GuidPrefix peer{1, 15, 2};
    CardReplay replay(1h);
    const CardReplay::TimePoint now(1h);
    ASSERT_TRUE(replay.Put(peer, CardOf(peer, {1}), now));
    replay.EndFirst(peer);
    const auto messages = replay.TakeDue(now, OwnCard());
    ASSERT_GE(messages.size(), 2u);
    const auto said = [&](std::size_t message)
    {
        std::vector<bool> alive;
        VisitSubmessages(std::span<const std::uint8_t>(messages[message].Bytes),
                         [&](const ConstSubmessage &part)
                         {
                             const auto announcement = ReadAnnouncement(part.Whole);
                             if (announcement && announcement->Writer == ParticipantWriter)
                             {
                                 alive.push_back(announcement->Alive);
                             }
                         });
        return alive;
    };
    EXPECT_EQ(said(0), std::vector<bool>{false});
    EXPECT_EQ(said(1), std::vector<bool>{true});
}

TEST(MeetingStrangers, OfTooManyThoseOfTheHostThatHasMostAreEnded)
{
    Meeting meeting({.Period = 10s, .Memory = 4h});
    const Meeting::TimePoint now(1h);
    const auto nameOf = [](std::size_t number) {
        return GuidPrefix{1, 15, 9, static_cast<std::uint8_t>(number >> 8),
                          static_cast<std::uint8_t>(number)};
    };
    const auto come = [&](std::size_t number, std::uint8_t host) {
        EXPECT_TRUE(meeting.Received(CardMessageOf(nameOf(number), {1, 2}), {10, 0, 0, host}, false, now));
    };
    constexpr std::size_t honest = 100;
    for (std::size_t number = 0; number < honest; ++number)
    {
        come(number, static_cast<std::uint8_t>(number));
    }
    for (std::size_t number = honest; number < 5000; ++number)
    {
        come(number, 200);
    }
    std::size_t kept = 0;
    for (std::size_t number = 0; number < 5000; ++number)
    {
        kept += meeting.IsReplayed(nameOf(number)) ? 1 : 0;
        EXPECT_TRUE(number >= honest || meeting.IsReplayed(nameOf(number))) << number;
    }
    EXPECT_EQ(kept, Meeting::MostStrangers);
}

TEST_F(MeetingOfTwo, WhatAnEarlierSessionOfANodeSaidEndsOnceItIsSilent)
{
    ASSERT_TRUE(Channel.Until([&] { return Channel.AllKnowAll(8); }));
    EXPECT_TRUE(Two.Meet->Endable().empty());
    Two.Meet->End(One.Self);
    EXPECT_TRUE(Two.Meet->WasEnded(One.Self));
    EXPECT_TRUE(Channel.Until([&] { return !Two.Dds->Knows(One.Self); }, 100ms));
}

}  // namespace
