// Several nodes on a network without faults of its own: cases that no random run shows.
#include <gmock/gmock.h>

#include <functional>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "NodeUnderTest.h"

namespace Rabit::Test
{
namespace
{

using testing::Each;
using testing::SizeIs;

// Carries everything between nodes in a fixed time. A name without a node is a dead peer.
class Network
{
public:
    struct Member final : LinkOutput, LocalQueues, IncarnationSource
    {
        Member(Network &network, std::string name, std::uint64_t life) : Net(network), Life(life)
        {
            LinkSettings settings;
            settings.Node = std::move(name);
            settings.Clock = ++network._clocks;
            Node = std::make_unique<LinkNode>(settings, *this, *this, *this);
        }
        void Send(const LinkFrame &frame, std::string_view) override
        {
            DatasSent += frame.HasData ? 1 : 0;
            Net.Carry(frame);
        }
        void OnOutcome(std::uint64_t, std::string_view, std::string_view, LinkOutcome outcome) override
        {
            Outcomes.push_back(outcome);
        }
        bool Accepts(std::string_view, std::string_view) override { return true; }
        bool AcceptsType(std::string_view, std::string_view) const override { return true; }
        LocalQueueResult Deliver(const LinkDelivery &delivery) override
        {
            Delivered.emplace_back(Net.Now, std::string(delivery.Payload.begin(), delivery.Payload.end()));
            return LocalQueueResult::Ok;
        }
        std::size_t Room(std::string_view) const override { return 1000; }
        std::uint64_t Above(std::uint64_t floor) override
        {
            Life = std::max(Life, ((floor >> 32) + 1) << 32);
            return Life;
        }

        Network &Net;
        std::uint64_t Life;
        std::unique_ptr<LinkNode> Node;
        std::vector<std::pair<LinkTime, std::string>> Delivered;
        std::vector<LinkOutcome> Outcomes;
        int DatasSent = 0;
    };

    Member &Add(const std::string &name, std::uint64_t life = 1ULL << 32)
    {
        _members.push_back(std::make_unique<Member>(*this, name, life));
        return *_members.back();
    }
    void Live(LinkTime time)
    {
        const LinkTime end = Now + time;
        for (;;)
        {
            LinkTime next = _onTheWay.empty() ? LinkNever : _onTheWay.begin()->first.first;
            for (const auto &member : _members)
            {
                next = std::min(next, std::max(member->Node->NextDue(), Now));
            }
            if (next > end)
            {
                break;
            }
            Now = next;
            while (!_onTheWay.empty() && _onTheWay.begin()->first.first <= Now)
            {
                const StoredFrame letter = std::move(_onTheWay.begin()->second);
                _onTheWay.erase(_onTheWay.begin());
                Hand(letter);
            }
            for (const auto &member : _members)
            {
                member->Node->Run(Now);
            }
        }
        Now = end;
    }

    LinkTime Now{1s};
    LinkTime Delay{5ms};
    // True if a datagram is lost.
    std::function<bool()> Loses = [] { return false; };

private:
    void Carry(const LinkFrame &frame)
    {
        if (!Loses())
        {
            _onTheWay.emplace(std::pair(Now + Delay, ++_order), StoredFrame(frame));
        }
    }
    void Hand(const StoredFrame &frame)
    {
        for (const auto &member : _members)
        {
            if (member->Node->Name() == frame.Destination)
            {
                LinkFrame view = frame.View();
                member->Node->OnFrame(view, Now);
            }
        }
    }

    std::vector<std::unique_ptr<Member>> _members;
    std::map<std::pair<LinkTime, int>, StoredFrame> _onTheWay;
    int _order = 0;
    std::uint64_t _clocks = 0;
};

// Sends to a live peer, and before each message fills the outboxes to some dead ones. Returns the
// deliveries with their times.
std::vector<std::pair<LinkTime, std::string>> DeliveriesBeside(int deadPeers)
{
    Network network;
    Network::Member &a = network.Add("a");
    Network::Member &b = network.Add("b");
    for (int i = 0; i < 50; ++i)
    {
        for (int dead = 0; dead < deadPeers; ++dead)
        {
            const std::string name("dead" + std::to_string(dead));
            while (a.Node->Enqueue(name, "q", "T", PayloadOf("x"), network.Now).Accepted())
            {
            }
        }
        a.Node->Enqueue("b", "q", "T", PayloadOf(std::to_string(i)), network.Now);
        network.Live(73ms);
    }
    EXPECT_THAT(b.Delivered, SizeIs(50));
    return b.Delivered;
}

TEST(LinkScenarios, DeadPeersWithFullOutboxesDelayNoOtherPeer)
{
    EXPECT_EQ(DeliveriesBeside(20), DeliveriesBeside(0));
}

TEST(LinkScenarios, AFirstMessageTakesThreeWaysAndEachLaterOneASingleWay)
{
    Network network;
    Network::Member &a = network.Add("a");
    Network::Member &b = network.Add("b");
    const LinkTime start = network.Now;
    a.Node->Enqueue("b", "q", "T", PayloadOf("1"), network.Now);
    network.Live(1s);
    a.Node->Enqueue("b", "q", "T", PayloadOf("2"), network.Now);
    a.Node->Enqueue("b", "other", "T", PayloadOf("3"), network.Now);
    const LinkTime second = network.Now;
    network.Live(1s);
    ASSERT_THAT(b.Delivered, SizeIs(3));
    EXPECT_EQ(b.Delivered[0].first - start, 15ms) << "hello, hello, data";
    EXPECT_EQ(b.Delivered[1].first - second, 5ms);
    EXPECT_EQ(b.Delivered[2].first - second, 5ms) << "the first of a link to a known peer as well";
    EXPECT_EQ(a.DatasSent, 3) << "and nothing is sent twice";
}

TEST(LinkScenarios, TwoLiveNodesWithOneNameAreNoticed)
{
    Network network;
    Network::Member &first = network.Add("a", 5ULL << 32);
    Network::Member &second = network.Add("a", 6ULL << 32);
    Network::Member &b = network.Add("b");
    for (int i = 0; i < 20; ++i)
    {
        first.Node->Enqueue("b", "q", "T", PayloadOf("1"), network.Now);
        second.Node->Enqueue("b", "q", "T", PayloadOf("2"), network.Now);
        b.Node->Enqueue("a", "q", "T", PayloadOf("3"), network.Now);
        network.Live(1s);
    }
    EXPECT_TRUE(first.Node->NameInUseElsewhere() || second.Node->NameInUseElsewhere());
}

TEST(LinkScenarios, OneRestartWithLostStorageRaisesNoAlarm)
{
    NodeUnderTest restarted({}, 2ULL << 32);
    PlayedPeer b;
    b.KnownLife = 9ULL << 32;
    restarted.Hear(b.Hello());
    EXPECT_EQ(restarted.Node->Counters().Raises, 1U);
    EXPECT_FALSE(restarted.Node->NameInUseElsewhere());
}

TEST(LinkScenarios, AHundredSecondsWithoutAPathLoseNothingAndSendLittle)
{
    Network network;
    Network::Member &a = network.Add("a");
    Network::Member &b = network.Add("b");
    a.Node->Enqueue("b", "q", "T", PayloadOf("first"), network.Now);
    network.Live(1s);
    network.Loses = [] { return true; };
    const int before = a.DatasSent;
    for (int i = 0; i < 900; ++i)
    {
        EXPECT_TRUE(a.Node->Enqueue("b", "q", "T", PayloadOf(std::to_string(i)), network.Now).Accepted());
        network.Live(111ms);
    }
    EXPECT_LE(a.DatasSent - before, 128 + 20)
        << "what is new once, then a probe a second until the peer is silent";
    network.Loses = [] { return false; };
    network.Live(5s);
    ASSERT_THAT(b.Delivered, SizeIs(901));
    for (std::size_t i = 0; i < 900; ++i)
    {
        ASSERT_EQ(b.Delivered[i + 1].second, std::to_string(i));
    }
    EXPECT_THAT(a.Outcomes, testing::AllOf(SizeIs(901), Each(LinkOutcome::Delivered)));
}

TEST(LinkScenarios, ThirtyPercentLossResendsLessThanThreeTimesTheFreshData)
{
    Network network;
    unsigned random = 1;
    network.Loses = [&random]
    {
        random = random * 1664525 + 1013904223;
        return (random >> 8) % 10 < 3;
    };
    Network::Member &a = network.Add("a");
    Network::Member &b = network.Add("b");
    for (int i = 0; i < 1000; ++i)
    {
        a.Node->Enqueue("b", "q", "T", PayloadOf("message"), network.Now);
        network.Live(20ms);
    }
    network.Live(60s);
    EXPECT_THAT(b.Delivered, SizeIs(1000));
    EXPECT_LE(a.DatasSent, 3000);
}

}  // namespace
}  // namespace Rabit::Test
