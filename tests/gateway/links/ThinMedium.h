// Two nodes and a medium in virtual time. Both directions share its rate, in bits per second. Each node has
// a bounded queue in front of it; the medium has a delay, and loss. All is exact and the same each time.
#pragma once

#include <rabit/gateway/links/LinkFrameCodec.h>
#include <rabit/gateway/links/LinkNode.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <deque>
#include <functional>
#include <map>
#include <memory>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace Rabit::Test
{

class ThinMedium
{
public:
    // A node whose queue takes everything. The payload of a message begins with the time at which it was
    // enqueued.
    struct Member final : LinkOutput, LocalQueues, IncarnationSource
    {
        Member(ThinMedium &medium, std::string name, std::size_t index) : Medium(medium), Index(index)
        {
            Settings.Node = std::move(name);
            Settings.Clock = index + 1;
            Settings.AirOverhead = medium.Headers;
            Node = std::make_unique<LinkNode>(Settings, *this, *this, *this);
        }
        // Forgets all, as after kill -9.
        void Restart()
        {
            Settings.Clock += 100;
            Node = std::make_unique<LinkNode>(Settings, *this, *this, *this);
        }
        void Send(const LinkFrame &frame, std::string_view) override
        {
            std::vector<std::uint8_t> bytes(LinkFrameCodec::EncodedSize(frame));
            LinkFrameCodec::Encode(frame, bytes);
            Medium.Offer(Index, std::move(bytes));
        }
        void OnOutcome(std::uint64_t id, std::string_view, std::string_view, LinkOutcome outcome) override
        {
            ++Outcomes[static_cast<std::size_t>(outcome)];
            if (OnEnd)
            {
                OnEnd(id, outcome);
            }
        }
        bool Accepts(std::string_view, std::string_view) override { return true; }
        bool AcceptsType(std::string_view, std::string_view) const override { return true; }
        LocalQueueResult Deliver(const LinkDelivery &delivery) override
        {
            LinkTime::rep enqueuedAt = 0;
            std::memcpy(&enqueuedAt, delivery.Payload.data(), sizeof enqueuedAt);
            Delays[std::string(delivery.Queue)].push_back(Medium.Now - LinkTime(enqueuedAt));
            DeliveredBytes += delivery.Payload.size();
            if (OnDelivery)
            {
                OnDelivery(delivery.Payload);
            }
            return LocalQueueResult::Ok;
        }
        std::size_t Room(std::string_view) const override { return 1000; }
        std::uint64_t Above(std::uint64_t floor) override { return floor + (++Lives << 32); }

        // Returns true if the outbox accepted the message.
        bool Enqueue(std::string_view to, std::string_view queue, std::size_t bytes)
        {
            LinkBytes payload(std::max(bytes, sizeof(LinkTime::rep)));
            const LinkTime::rep now = Medium.Now.count();
            std::memset(payload.Writable().data(), 0, payload.Size());
            std::memcpy(payload.Writable().data(), &now, sizeof now);
            return Node
                ->Enqueue(to, queue, "Bench::Type", std::make_shared<const LinkBytes>(std::move(payload)),
                          Medium.Now)
                .Accepted();
        }
        LinkTime Percentile(const std::string &queue, double part)
        {
            std::vector<LinkTime> sorted = Delays[queue];
            if (sorted.empty())
            {
                return LinkNever;
            }
            std::sort(sorted.begin(), sorted.end());
            return sorted[std::min(sorted.size() - 1,
                                   static_cast<std::size_t>(part * static_cast<double>(sorted.size())))];
        }

        ThinMedium &Medium;
        const std::size_t Index;
        LinkSettings Settings;
        std::uint64_t Lives = 0;
        std::function<void(std::span<const std::uint8_t> payload)> OnDelivery;
        std::function<void(std::uint64_t id, LinkOutcome outcome)> OnEnd;
        std::unique_ptr<LinkNode> Node;
        std::map<std::string, std::vector<LinkTime>> Delays;
        std::array<std::size_t, 4> Outcomes{};
        std::size_t DeliveredBytes = 0;
    };

    explicit ThinMedium(std::size_t headers = Overhead)
        : Headers(headers), A(*this, "alpha", 0), B(*this, "beta", 1)
    {
    }

    // Runs for `time`, with no step beyond its end.
    void Live(LinkTime time)
    {
        for (const LinkTime end = Now + time; Step(end);)
        {
        }
    }
    // Does the next event before `end` and returns true. Without one, sets the time to `end` and returns
    // false.
    bool Step(LinkTime end)
    {
        LinkTime next = std::min(_freeAt, _arrivals.empty() ? LinkNever : _arrivals.begin()->first.first);
        next = std::min({next, std::max(A.Node->NextDue(), Now), std::max(B.Node->NextDue(), Now)});
        if (next > end)
        {
            Now = end;
            return false;
        }
        Now = next;
        if (_freeAt <= Now)
        {
            Transmit();
        }
        while (!_arrivals.empty() && _arrivals.begin()->first.first <= Now)
        {
            const Letter letter = std::move(_arrivals.begin()->second);
            _arrivals.erase(_arrivals.begin());
            Member &to = letter.From == 0 ? B : A;
            LinkFrame frame;
            if (LinkFrameCodec::Decode(letter.Bytes, frame))
            {
                frame.Source = letter.From == 0 ? "alpha" : "beta";
                to.Node->OnFrame(frame, Now);
            }
        }
        A.Node->Run(Now);
        B.Node->Run(Now);
        return true;
    }

    static constexpr std::size_t Overhead = 109;

    LinkTime Now{1000000000};
    double BitsPerSecond = 0;  // 0: no limit
    std::size_t QueueBytes = 16 * 1024;
    LinkTime Delay{std::chrono::milliseconds(1)};
    double Loss = 0;
    bool Cut = false;

    std::size_t BytesSent = 0;  // as on the air, both directions
    std::size_t Datagrams = 0;
    std::size_t Overflows = 0;
    LinkTime LongestWait{0};            // in a queue, since it was last set to 0
    std::size_t BytesCarried = 0;       // since it was last set to 0
    std::array<std::size_t, 2> Sent{};  // datagrams of each node

    const std::size_t Headers;  // bytes of each datagram that are not its frame's
    Member A;
    Member B;

private:
    struct Letter
    {
        std::size_t From = 0;
        LinkTime At{0};
        std::vector<std::uint8_t> Bytes;
    };

    std::size_t CostOf(const Letter &letter) const { return letter.Bytes.size() + Headers; }
    void Offer(std::size_t from, std::vector<std::uint8_t> bytes)
    {
        Letter letter{from, Now, std::move(bytes)};
        BytesSent += CostOf(letter);
        ++Datagrams;
        ++Sent[from];
        if (BitsPerSecond == 0)
        {
            Arrive(std::move(letter));
            return;
        }
        if (_queued[from] + CostOf(letter) > QueueBytes)
        {
            ++Overflows;
            return;
        }
        _queued[from] += CostOf(letter);
        _queue.push_back(std::move(letter));
        if (_freeAt == LinkNever)
        {
            Begin();
        }
    }
    void Begin()
    {
        const Letter &letter = _queue.front();
        LongestWait = std::max(LongestWait, Now - letter.At);
        _freeAt =
            Now +
            LinkTime(static_cast<LinkTime::rep>(static_cast<double>(CostOf(letter)) * 8e9 / BitsPerSecond));
    }
    void Transmit()
    {
        Letter letter = std::move(_queue.front());
        _queue.pop_front();
        _queued[letter.From] -= CostOf(letter);
        BytesCarried += CostOf(letter);
        _freeAt = LinkNever;
        if (!_queue.empty())
        {
            Begin();
        }
        Arrive(std::move(letter));
    }
    void Arrive(Letter letter)
    {
        _random = _random * 6364136223846793005ULL + 1442695040888963407ULL;
        if (!Cut && static_cast<double>(_random >> 33) >= Loss * static_cast<double>(1ULL << 31))
        {
            _arrivals.emplace(std::pair(Now + Delay, ++_order), std::move(letter));
        }
    }

    std::uint64_t _random = 1;
    std::uint64_t _order = 0;
    std::deque<Letter> _queue;
    std::array<std::size_t, 2> _queued{};
    LinkTime _freeAt = LinkNever;
    std::map<std::pair<LinkTime, std::uint64_t>, Letter> _arrivals;
};

}  // namespace Rabit::Test
