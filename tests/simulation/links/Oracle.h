#pragma once

#include "Scenario.h"

#include <rabit/gateway/links/LinkCounters.h>
#include <rabit/gateway/links/LinkOutcome.h>
#include <rabit/gateway/links/LinkTime.h>

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace Rabit::Sim
{

// One accepted message, as the oracle knows it.
struct Record
{
    std::size_t Link = 0;
    std::size_t Life = 0;    // which process sent it; see Oracle::StartLife
    LinkTime EnqueuedAt{0};  // by the clock of that process
    std::size_t Bytes = 0;
    std::string_view Type;
    std::uint32_t Epoch = 0;  // of the link, as its sender knew it when it was enqueued; see Oracle::NewEpoch
    bool Delivered = false;
    bool RefusedByQueue = false;
    bool HasOutcome = false;
    LinkOutcome Outcome = LinkOutcome::Delivered;
};

// Knows the promises and hears of every event. Fails on a broken promise; the numbers are those of the list
// in tests/simulation/README.md.
class Oracle
{
public:
    explicit Oracle(const Scenario &scenario);

    // A node's process starts. Returns the name of this life.
    std::size_t StartLife(std::size_t node);
    // The node takes a new incarnation, after a crash or because it had to: messages that are on their way
    // to or from it may be in doubt.
    void NewEpoch(std::size_t node);
    void EndLife(std::size_t node) { _lifeOf[node] = NoLife; }
    // The node has forgotten the peer: for this pair it is as if the node were in a new incarnation and did
    // not know the peer's.
    void Forgets(std::size_t node, std::size_t peer);
    // A node has taken a frame of the present incarnation of another one.
    void Knows(std::size_t node, std::size_t peer, LinkTime nodeNow)
    {
        _knownEpoch[node][peer] = EpochTo(peer, node);
        _heardAt[node][peer] = nodeNow;
    }

    // Returns the payload of the next message of a link.
    std::vector<std::uint8_t> MakePayload(SimRandom &random) const;
    // Enqueue was called with this result. The outcomes reported during the call come first.
    void OnEnqueue(std::size_t link, std::string_view type, std::span<const std::uint8_t> payload,
                   LinkRefusal refusal, std::uint64_t id, LinkTime senderNow);
    // A message comes out of a link. Returns its record, or null after a violation.
    Record *Find(std::size_t receiver, std::string_view source, std::string_view queue, std::string_view type,
                 std::span<const std::uint8_t> payload);
    // The message was put into the queue. `senderNow`: the time by the clock of the process that sent it.
    void OnDelivered(const Record &record, bool redelivered, LinkTime senderNow);
    void OnOutcome(std::size_t node, std::uint64_t id, std::string_view destination, std::string_view queue,
                   LinkOutcome outcome, LinkTime senderNow);
    // Checks the counters of one link of a live node, after an event.
    void CheckSender(std::size_t node, std::string_view destination, std::string_view queue,
                     const LinkSenderCounters &counters);
    // Number of messages without an outcome, from live nodes to live nodes.
    std::size_t Undrained(const std::vector<bool> &alive) const;

    void Fail(int invariant, const std::string &what);
    const std::string &Failure() const { return _failure; }

    std::size_t Accepted() const { return _records.size(); }
    std::uint64_t Outcomes() const { return _outcomes[0] + _outcomes[1] + _outcomes[2] + _outcomes[3]; }
    std::uint64_t OutcomesOf(LinkOutcome outcome) const
    {
        return _outcomes[static_cast<std::size_t>(outcome)];
    }
    std::uint64_t RedeliveredTwice() const { return _redeliveredTwice; }
    std::uint64_t GivenUp() const { return _givenUp; }
    std::uint64_t Refused() const { return _refused; }
    std::uint64_t AcceptedBytes() const { return _acceptedBytes; }
    std::uint64_t DeliveredBytes() const { return _deliveredBytes; }
    // Number of delivered messages larger than a datagram.
    std::uint64_t LargeDelivered() const { return _largeDelivered; }
    // Sums over messages of live processes without an outcome.
    std::size_t PendingBytes() const;
    std::size_t PendingCount() const;

private:
    static constexpr std::size_t NoLife = static_cast<std::size_t>(-1);

    struct Life
    {
        std::size_t Node = 0;
        std::vector<std::size_t> RecordOfId;  // ids rise by one from 1
    };
    struct LinkState
    {
        std::size_t Life = NoLife;  // which the next two are of
        std::size_t Pending = 0;
        std::size_t PendingBytes = 0;
        std::size_t NextToDeliver = 0;  // records below it must not come any more, unless they are flagged
        std::size_t NextFlagged = 0;    // the same for flagged ones, within an epoch
        std::uint32_t FlaggedEpoch = 0;
    };

    std::size_t FindLink(std::size_t source, std::size_t destination, std::string_view queue) const;
    std::size_t FindNode(std::string_view name) const;
    // Rises with each incarnation that the node has for this peer.
    std::uint32_t EpochTo(std::size_t node, std::size_t peer) const
    {
        return _nodeEpoch[node] + _pairEpoch[node][peer];
    }
    std::uint32_t EpochOf(std::size_t link) const;
    std::size_t IndexOf(const Record &record) const
    {
        return static_cast<std::size_t>(&record - _records.data());
    }

    const Scenario &_scenario;
    std::vector<Record> _records;
    std::vector<Life> _lives;
    std::vector<std::size_t> _lifeOf;                     // by node
    std::vector<std::uint32_t> _nodeEpoch;                // by node
    std::vector<std::vector<std::uint32_t>> _pairEpoch;   // by node and peer: how often it forgot the peer
    std::vector<std::vector<std::uint32_t>> _knownEpoch;  // by node and peer
    std::vector<std::vector<LinkTime>> _heardAt;          // by node and peer, by the clock of the node
    std::vector<LinkState> _links;
    std::vector<std::size_t> _linkIndex;  // by source, destination and queue
    std::uint64_t _outcomes[4] = {};
    std::uint64_t _redeliveredTwice = 0;
    std::uint64_t _givenUp = 0;
    std::uint64_t _refused = 0;
    std::uint64_t _acceptedBytes = 0;
    std::uint64_t _deliveredBytes = 0;
    std::uint64_t _largeDelivered = 0;
    std::string _failure;
};

}  // namespace Rabit::Sim
