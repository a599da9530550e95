#pragma once

#include "LinkContext.h"
#include "OutcomeHistory.h"

#include <rabit/gateway/links/LinkCounters.h>
#include <rabit/gateway/links/LinkMessages.h>
#include <rabit/gateway/links/LinkTime.h>

#include <cstdint>
#include <string>

namespace Rabit
{

// The receiving half of one link: rules R1 to R8 of the protocol, for one queue of this node and one other
// node. It keeps no messages: one that cannot be put into the local queue now is left to the sender to send
// again.
class LinkReceiver
{
public:
    // `ownLife`: the life in which this node is to the source; must outlive the object.
    LinkReceiver(LinkContext &context, const std::uint64_t &ownLife, std::string source, std::string queue);

    void OnData(const LinkData &data, LinkTime now);
    // The local queue has room again.
    void OnRoom(LinkTime now);
    // This node takes a new incarnation: what was received in the old one is not continued.
    void DropSession();
    // Acknowledges if it is due. `peerIncarnation`: the highest life of the source heard of.
    void Run(std::uint64_t peerIncarnation, LinkTime now);
    LinkTime NextDue() const { return _ackAt; }

    const std::string &Queue() const { return _queue; }
    LinkReceiverCounters Counters() const;
    std::string Describe() const;

private:
    bool HasSession() const { return _senderIncarnation != 0; }
    bool MayOpen(const LinkData &data, LinkTime now) const;
    void Open(const LinkData &data, LinkTime now);
    bool Consume(const LinkData &data, const LinkItem &item, LinkTime now);
    bool IsInTime(const LinkItem &item, const LinkEcho &echo, LinkTime now) const;
    void Advance(OutcomeHistory::Entry entry);
    void AcknowledgeBy(LinkTime when);

    LinkContext &_context;
    const std::uint64_t &_ownLife;
    const std::string _source;
    const std::string _queue;

    // The session: the stream of the sender's life that is being received.
    std::uint64_t _senderIncarnation = 0;  // s_inc; 0: there is no session
    std::uint64_t _cumulative = 0;         // cum: highest number consumed
    OutcomeHistory _history;
    LinkTime _openedAt{0};
    std::int64_t _latestSentAt = 0;  // by the sender's clock; 0: no datagram of this session yet
    LinkTime _latestCameAt{0};

    LinkTime _ackAt = LinkNever;
    std::size_t _unacknowledged = 0;       // consumed since the last acknowledgement
    std::size_t _unacknowledgedBytes = 0;  // of their payloads
    bool _heldBack = false;                // the sender was last told that there is no room

    LinkReceiverCounters _counters;
};

}  // namespace Rabit
