#pragma once

#include <rabit/ManualClock.h>
#include <rabit/gateway/GatewayTap.h>

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <deque>
#include <map>
#include <memory>
#include <set>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

namespace Rabit::WhatIf
{

using Nanoseconds = std::chrono::nanoseconds;

// The queue messages of all nodes of a simulated flight.
struct QueueBook
{
    using Link = std::tuple<std::string, std::string, std::string>;  // from node, to node, queue
    struct Unanswered
    {
        Nanoseconds At{0};
        std::uint64_t Id = 0;
        std::string Type;
        std::vector<std::uint8_t> Sample;
    };
    struct Entry
    {
        std::uint64_t Refused = 0;
        std::uint64_t Sent = 0;
        std::map<std::string, std::uint64_t> Outcomes{};  // by QueueOutcome
        std::vector<Nanoseconds> Ages{};                  // of each delivered message, at its delivery
        // The messages that were neither received nor settled, all of one life of the sender.
        std::deque<Unanswered> Waiting{};
    };
    std::map<Link, Entry> Links;
};

// Notes the messages that one life of a node sends and receives in a simulated flight. Times count from its
// beginning.
class FlightTap final : public GatewayTap
{
public:
    // `ahead`: of the node's monotonic clock before the time of the flight.
    FlightTap(std::string node, std::shared_ptr<const ManualClock> clock, Nanoseconds ahead,
              std::shared_ptr<QueueBook> book)
        : _node(std::move(node)), _clock(std::move(clock)), _ahead(ahead), _book(std::move(book))
    {
    }
    ~FlightTap() override
    {
        for (auto &[link, entry] : _book->Links)
        {
            if (std::get<0>(link) == _node)
            {
                entry.Waiting.clear();
            }
        }
    }

    // Arrival and post of each value, as the node knows them.
    using Values = std::vector<std::pair<Nanoseconds, Nanoseconds>>;
    const std::map<std::pair<std::string, std::string>, Values> &Arrived() const { return _arrived; }

    void Mirrored(const MirroredSample &sample) override
    {
        _arrived[{std::string(sample.Node), std::string(sample.Message)}].emplace_back(
            Now(), sample.PostedAt - _ahead);
    }

    void Sent(const QueueMessage &message) override
    {
        QueueBook::Entry &entry = Entry(_node, message.Node, message.Queue);
        ++entry.Sent;
        if (IsFirstOf(message.Id))
        {
            entry.Waiting.push_back({Now(),
                                     message.Id,
                                     std::string(message.Type),
                                     {message.Sample.begin(), message.Sample.end()}});
        }
    }
    void Refused(const QueueMessage &message, std::string_view /*reason*/) override
    {
        ++Entry(_node, message.Node, message.Queue).Refused;
    }
    void Settled(std::string_view node, std::string_view queue, std::uint64_t id,
                 QueueOutcome outcome) override
    {
        QueueBook::Entry &entry = Entry(_node, node, queue);
        ++entry.Outcomes[ToString(outcome)];
        if (!IsFirstOf(id))
        {
            std::erase_if(entry.Waiting, [id](const QueueBook::Unanswered &sent) { return sent.Id == id; });
        }
    }
    // A link delivers in order, so earlier messages that are still waiting will not come any more.
    void Received(const QueueMessage &message) override
    {
        QueueBook::Entry &entry = Entry(message.Node, _node, message.Queue);
        const auto found = std::find_if(entry.Waiting.begin(), entry.Waiting.end(),
                                        [&message](const QueueBook::Unanswered &sent)
                                        {
                                            return sent.Type == message.Type &&
                                                   std::equal(sent.Sample.begin(), sent.Sample.end(),
                                                              message.Sample.begin(), message.Sample.end());
                                        });
        if (found != entry.Waiting.end())
        {
            entry.Ages.push_back(Now() - found->At);
            entry.Waiting.erase(entry.Waiting.begin(), std::next(found));
        }
    }

    void Clocks(std::uint64_t /*incarnation*/, Nanoseconds /*sourceAhead*/,
                const std::vector<PeerClock> & /*peers*/) override
    {
    }
    std::vector<Gateway::Problem> Problems() override { return {}; }

private:
    Nanoseconds Now() const { return _clock->Monotonic() - _ahead; }
    // False for the second one of Sent and Settled of a message. Settled may be the first.
    bool IsFirstOf(std::uint64_t id)
    {
        if (_unpaired.erase(id) != 0)
        {
            return false;
        }
        _unpaired.insert(id);
        return true;
    }
    QueueBook::Entry &Entry(std::string_view from, std::string_view to, std::string_view queue)
    {
        return _book->Links[{std::string(from), std::string(to), std::string(queue)}];
    }

    const std::string _node;
    const std::shared_ptr<const ManualClock> _clock;
    const Nanoseconds _ahead;
    const std::shared_ptr<QueueBook> _book;
    std::set<std::uint64_t> _unpaired;  // messages of which one of Sent and Settled has come
    std::map<std::pair<std::string, std::string>, Values> _arrived;
};

}  // namespace Rabit::WhatIf
