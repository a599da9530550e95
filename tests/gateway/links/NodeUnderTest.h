// One LinkNode with hosts that record its calls, for tests that play its peers by hand.
#pragma once

#include "StoredMessages.h"

#include <rabit/gateway/links/LinkCheck.h>
#include <rabit/gateway/links/LinkNode.h>

#include <gtest/gtest.h>

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

    // Lets time pass, and calls Run once at the end.
    void Pass(LinkTime time)
    {
        Now += time;
        Node->Run(Now);
    }
    // Lets time pass, and calls Run whenever something is due, as a driver does.
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
    void Hear(const StoredFrame &frame)
    {
        LinkFrame view = frame.View();
        Node->OnFrame(view, Now);
    }

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

    // Return all that was sent / delivered / reported since the last call.
    std::vector<StoredFrame> TakeDatas() { return std::exchange(_datas, {}); }
    std::vector<StoredFrame> TakeAcks() { return std::exchange(_acks, {}); }
    std::vector<StoredFrame> TakeHellos() { return std::exchange(_hellos, {}); }
    std::vector<DeliveredMessage> TakeDelivered() { return std::exchange(_delivered, {}); }
    std::vector<std::pair<std::uint64_t, LinkOutcome>> TakeOutcomes() { return std::exchange(_outcomes, {}); }

    LinkTime Now{100s};
    std::unique_ptr<LinkNode> Node;
    // The answer of the local queues, and the room that they report.
    LocalQueueResult Answer = LocalQueueResult::Ok;
    std::size_t RoomLeft = 1000;
    // Acknowledgements go in frames without messages.
    bool AcksAlone = false;
    // Number of messages that the local queues take before they are full; counts down.
    std::size_t Places = 1'000'000;
    // Queues whose names begin with NoQueue, and the type NoType, are not accepted.
    static constexpr std::string_view NoQueue = "none";
    static constexpr std::string_view NoType = "NoType";
    // Incarnation and number of each message that was offered to a local queue.
    std::vector<std::pair<std::uint64_t, std::uint64_t>> Offered;

    // A frame with data and acknowledgements is counted among both.
    void Send(const LinkFrame &frame, std::string_view queue) override
    {
        EXPECT_EQ(queue.empty(), !frame.HasData);
        if (frame.HasData)
        {
            EXPECT_TRUE(frame.Data.Queue.empty() || frame.Data.Queue == queue);
            _datas.emplace_back(frame);
        }
        if (!frame.Acks.empty())
        {
            _acks.emplace_back(frame);
        }
        if (frame.IsHello())
        {
            _hellos.emplace_back(frame);
        }
    }
    bool SendsAcksAlone(std::string_view) const override { return AcksAlone; }
    void OnOutcome(std::uint64_t id, std::string_view, std::string_view, LinkOutcome outcome) override
    {
        _outcomes.emplace_back(id, outcome);
    }
    bool Accepts(std::string_view, std::string_view queue) override { return !queue.starts_with(NoQueue); }
    bool AcceptsType(std::string_view, std::string_view type) const override { return type != NoType; }
    LocalQueueResult Deliver(const LinkDelivery &delivery) override
    {
        Offered.push_back({delivery.SenderLife, delivery.Number});
        if (Answer == LocalQueueResult::Ok && Places == 0)
        {
            return LocalQueueResult::Full;
        }
        if (Answer == LocalQueueResult::Ok)
        {
            --Places;
            _delivered.push_back(
                {std::string(delivery.Source), std::string(delivery.Queue), std::string(delivery.Type),
                 std::string(delivery.Payload.begin(), delivery.Payload.end()), delivery.Redelivered});
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
    std::vector<StoredFrame> _datas;
    std::vector<StoredFrame> _acks;
    std::vector<StoredFrame> _hellos;
    std::vector<DeliveredMessage> _delivered;
    std::vector<std::pair<std::uint64_t, LinkOutcome>> _outcomes;
};

// Node "b", played by hand: makes frames for node "a".
struct PlayedPeer
{
    static constexpr std::uint32_t Clock = 2002;
    // The number by which node "a" names its own clock.
    static constexpr std::uint32_t ClockOfA = static_cast<std::uint32_t>(NodeUnderTest::MyClock);

    std::uint64_t Life = 7ULL << 32;
    std::uint64_t KnownLife = NodeUnderTest::FirstLife;
    std::int64_t Time = 1'000'000'000;  // its clock; rises by a microsecond with each frame

    // Returns a hello without a question and without an echo.
    StoredFrame Hello()
    {
        StoredFrame frame;
        frame.Source.assign(1, 'b');
        frame.Destination.assign(1, 'a');
        frame.Fields.Check = LinkCheck::OfName("a");
        frame.Fields.SenderLife = Life;
        frame.Fields.ReceiverLife = KnownLife;
        frame.Fields.Clock = Clock;
        frame.Fields.Time = Time += 1000;
        return frame;
    }
    // Acknowledges all parts up to `cumulative` as delivered, except those in `skipped` and `refused` (by
    // number).
    StoredFrame Ack(std::uint64_t cumulative, std::uint32_t credit = 100,
                    const std::vector<std::uint64_t> &skipped = {},
                    const std::vector<std::uint64_t> &refused = {})
    {
        StoredFrame frame = Hello();
        LinkAck &ack = frame.Fields.Acks.emplace_back();
        ack.Link = 1;
        ack.Open = true;
        ack.Cumulative = cumulative;
        ack.Oldest = 1;
        ack.Delivered.fill(~0ULL);
        const auto flip = [](LinkBitmap &bits, std::uint64_t sequence)
        { bits[sequence / 64 % bits.size()] ^= 1ULL << (sequence % 64); };
        for (const std::uint64_t sequence : skipped)
        {
            flip(ack.Delivered, sequence);
        }
        for (const std::uint64_t sequence : refused)
        {
            flip(ack.Delivered, sequence);
            flip(ack.Refused, sequence);
        }
        ack.Credit = credit;
        return frame;
    }
    // The same, with the parts in `held` received beyond a gap.
    StoredFrame AckWith(std::uint64_t cumulative, const std::vector<std::uint64_t> &held)
    {
        StoredFrame frame = Ack(cumulative);
        for (const std::uint64_t sequence : held)
        {
            const std::uint64_t bit = sequence - cumulative - 1;
            frame.Ack().Held[bit / 64] |= 1ULL << (bit % 64);
        }
        return frame;
    }
    // Returns small messages for queue "q" of node "a", numbered from `first`. The echo states that the
    // current token was received at `now`.
    StoredFrame Data(std::uint64_t first, const std::vector<std::string> &texts, LinkTime now)
    {
        StoredFrame frame = Hello();
        frame.Fields.HasData = true;
        frame.Queue.assign(1, 'q');
        frame.Fields.Data.Link = 1;
        frame.Fields.Data.Oldest = 1;
        frame.Fields.Echo = {ClockOfA, now.count(), 0};
        for (const std::string &text : texts)
        {
            StoredItem &item = frame.Items.emplace_back();
            item.Fields.Sequence = item.Fields.Through = first++;
            item.Fields.Flags = LinkFlagFirst | LinkFlagLast;
            item.Type = "T";
            item.Payload.assign(text.begin(), text.end());
        }
        return frame;
    }
    // Returns one message in parts with these texts.
    StoredFrame Parts(std::uint64_t first, const std::vector<std::string> &texts, LinkTime now)
    {
        StoredFrame frame = Data(first, texts, now);
        std::size_t size = 0;
        for (StoredItem &item : frame.Items)
        {
            size += item.Payload.size();
            item.Fields.Flags = 0;
            item.Type.clear();
        }
        frame.Items.front().Fields.Flags = LinkFlagFirst;
        frame.Items.front().Fields.Size = size;
        frame.Items.front().Type = "T";
        frame.Items.back().Fields.Flags |= LinkFlagLast;
        return frame;
    }
};

// Makes the item a SKIP of these numbers.
inline void MakeSkip(StoredItem &item, std::uint64_t first, std::uint64_t through)
{
    item = {};
    item.Fields.Flags = LinkFlagSkip;
    item.Fields.Sequence = first;
    item.Fields.Through = through;
}

}  // namespace Rabit::Test
