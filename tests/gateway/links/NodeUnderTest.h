// One LinkNode with hosts that record what it does, for tests that play its peers by hand.
#pragma once

#include "StoredMessages.h"

#include <rabit/gateway/links/LinkNode.h>

#include <deque>
#include <map>
#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace Rabit::Test
{

using namespace std::chrono_literals;

inline LinkPayload PayloadOf(std::string_view text)
{
    return LinkBytes::CopyOf({reinterpret_cast<const std::uint8_t *>(text.data()), text.size()});
}

struct DeliveredMessage
{
    std::string Source, Queue, Type, Text;
    bool Redelivered = false;

    bool operator==(const DeliveredMessage &) const = default;
};

class NodeUnderTest : public LinkOutput, public LocalQueues, public IncarnationSource
{
public:
    static constexpr std::uint64_t MyClock = 1001;
    static constexpr std::uint64_t FirstLife = 5ULL << 32;

    explicit NodeUnderTest(LinkSettings settings = {}, std::uint64_t life = FirstLife) : _life(life)
    {
        settings.Node = "a";
        settings.Clock = MyClock;
        Node = std::make_unique<LinkNode>(settings, *this, *this, *this);
    }

    // Time passes, and Run is called once at the end.
    void Pass(LinkTime time)
    {
        Now += time;
        Node->Run(Now);
    }
    // Time passes, and Run is called whenever something is due, as a driver does.
    void Live(LinkTime time)
    {
        const LinkTime end = Now + time;
        for (LinkTime due = Node->NextDue(); due <= end; due = Node->NextDue())
        {
            Now = std::max(Now, due);
            Node->Run(Now);
        }
        Now = end;
    }
    std::uint64_t Enqueue(std::string_view text, std::string_view to = "b", std::string_view queue = "q")
    {
        return Node->Enqueue(to, queue, "T", PayloadOf(text), Now).Id;
    }
    void Configure(const LinkOptions &options, std::string_view to = "b", std::string_view queue = "q")
    {
        Node->Configure(to, queue, options, Now);
    }
    void Hear(const StoredData &data) { Node->OnData(data.View(), Now); }
    void Hear(const StoredAck &ack) { Node->OnAck(ack.View(), Now); }
    void Hear(const StoredHello &hello) { Node->OnHello(hello.View(), Now); }

    LinkSenderCounters SenderCounters(std::string_view to = "b", std::string_view queue = "q") const
    {
        LinkSenderCounters found;
        Node->VisitSenders(
            [&](std::string_view destination, std::string_view name, const LinkSenderCounters &counters)
            {
                if (destination == to && name == queue)
                {
                    found = counters;
                }
            });
        return found;
    }
    LinkReceiverCounters ReceiverCounters(std::string_view from = "b", std::string_view queue = "q") const
    {
        LinkReceiverCounters found;
        Node->VisitReceivers(
            [&](std::string_view source, std::string_view name, const LinkReceiverCounters &counters)
            {
                if (source == from && name == queue)
                {
                    found = counters;
                }
            });
        return found;
    }

    // All that was sent / delivered / reported since the last call.
    std::vector<StoredData> TakeDatas() { return std::exchange(_datas, {}); }
    std::vector<StoredAck> TakeAcks() { return std::exchange(_acks, {}); }
    std::vector<StoredHello> TakeHellos() { return std::exchange(_hellos, {}); }
    std::vector<DeliveredMessage> TakeDelivered() { return std::exchange(_delivered, {}); }
    std::vector<std::pair<std::uint64_t, LinkOutcome>> TakeOutcomes() { return std::exchange(_outcomes, {}); }

    LinkTime Now{100s};
    std::unique_ptr<LinkNode> Node;
    // How the local queues answer, and how much room they say there is.
    LocalQueueResult Answer = LocalQueueResult::Ok;
    std::size_t RoomLeft = 1000;

    void Send(const LinkData &data) override { _datas.emplace_back(data); }
    void Send(const LinkAck &ack) override { _acks.emplace_back(ack); }
    void Send(const LinkHello &hello) override { _hellos.emplace_back(hello); }
    void OnOutcome(std::uint64_t id, std::string_view, std::string_view, LinkOutcome outcome) override
    {
        _outcomes.emplace_back(id, outcome);
    }
    LocalQueueResult Deliver(std::string_view source, std::string_view queue, std::string_view type,
                             std::span<const std::uint8_t> payload, bool redelivered) override
    {
        if (Answer == LocalQueueResult::Ok)
        {
            _delivered.push_back({std::string(source), std::string(queue), std::string(type),
                                  std::string(payload.begin(), payload.end()), redelivered});
        }
        return Answer;
    }
    std::size_t Room(std::string_view) const override { return RoomLeft; }
    std::uint64_t Above(std::uint64_t floor) override
    {
        _life = std::max(_life, ((floor >> 32) + 1) << 32);
        return _life;
    }

private:
    std::uint64_t _life;
    std::vector<StoredData> _datas;
    std::vector<StoredAck> _acks;
    std::vector<StoredHello> _hellos;
    std::vector<DeliveredMessage> _delivered;
    std::vector<std::pair<std::uint64_t, LinkOutcome>> _outcomes;
};

// Node "b", played by hand: makes the messages that it would send to node "a".
struct PlayedPeer
{
    static constexpr std::uint64_t Clock = 2002;

    std::uint64_t Life = 7ULL << 32;
    std::uint64_t KnownLife = NodeUnderTest::FirstLife;
    std::int64_t Time = 1'000'000'000;  // its clock; rises with each message

    StoredHello Hello()
    {
        StoredHello hello;
        hello.Source.assign(1, 'b');
        hello.Destination.assign(1, 'a');
        hello.Fields.Incarnation = Life;
        hello.Fields.YourIncarnation = KnownLife;
        hello.Fields.Clock = Clock;
        hello.Fields.Time = ++Time;
        return hello;
    }
    // All messages up to `cumulative` were delivered, except those in `skipped` and `refused` (by number).
    StoredAck Ack(std::uint64_t cumulative, std::uint32_t credit = 100,
                  const std::vector<std::uint64_t> &skipped = {},
                  const std::vector<std::uint64_t> &refused = {})
    {
        StoredAck ack;
        ack.Source.assign(1, 'a');
        ack.Destination.assign(1, 'b');
        ack.Queue.assign(1, 'q');
        ack.Fields.ReceiverIncarnation = Life;
        ack.Fields.SenderIncarnation = KnownLife;
        ack.Fields.Cumulative = cumulative;
        ack.Fields.Delivered.fill(~0ULL);
        const auto flip = [&](LinkBitmap &bits, std::uint64_t sequence)
        { bits[(cumulative - sequence) / 64] ^= 1ULL << ((cumulative - sequence) % 64); };
        for (const std::uint64_t sequence : skipped)
        {
            flip(ack.Fields.Delivered, sequence);
        }
        for (const std::uint64_t sequence : refused)
        {
            flip(ack.Fields.Delivered, sequence);
            flip(ack.Fields.Refused, sequence);
        }
        ack.Fields.Credit = credit;
        ack.Fields.Clock = Clock;
        ack.Fields.Time = ++Time;
        ack.Fields.YourIncarnation = KnownLife;
        return ack;
    }
    // Messages for queue "q" of node "a", numbered from `first`. The echo says that the token of now was
    // received at this moment.
    StoredData Data(std::uint64_t first, const std::vector<std::string> &texts, LinkTime now) const
    {
        StoredData data;
        data.Source.assign(1, 'b');
        data.Destination.assign(1, 'a');
        data.Queue.assign(1, 'q');
        data.Fields.SenderIncarnation = Life;
        data.Fields.ReceiverIncarnation = KnownLife;
        data.Fields.Base = 1;
        data.Fields.First = first;
        data.Fields.Echo = {NodeUnderTest::MyClock, now.count(), 0};
        for (const std::string &text : texts)
        {
            data.Items.push_back({0, LinkNoExpiry, "T", {text.begin(), text.end()}});
        }
        return data;
    }
};

}  // namespace Rabit::Test
