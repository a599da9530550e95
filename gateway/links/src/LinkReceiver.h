#pragma once

#include "Assembly.h"
#include "LinkContext.h"
#include "OutcomeHistory.h"
#include "ReorderBuffer.h"

#include <rabit/gateway/links/LinkCounters.h>
#include <rabit/gateway/links/LinkMessages.h>
#include <rabit/gateway/links/LinkTime.h>

#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <string_view>

namespace Rabit
{

// The receiving half of one link: rules R3 to R8 of the protocol, for one queue of this node and one other
// node.
class LinkReceiver
{
public:
    LinkReceiver(LinkContext &context, std::string source, std::string queue);

    // Processes data of the present incarnations of both nodes. `ackDelay`: how long the acknowledgement may
    // wait for more.
    void OnData(const LinkFrame &frame, LinkTime ackDelay, LinkTime now);
    // True if parts wait here, or the sender was told that there is no room.
    bool IsWaiting() const { return HasSession() && (_heldBack || !_kept.Empty()); }
    // The local queue has room again, for which `waiting` links wait: the sender is told of its share soon.
    void OnRoom(std::size_t waiting, LinkTime now);
    // Consumes waiting parts, up to one message that goes into the local queue. True if one did.
    bool TakeTurn(LinkTime now);
    // See LinkNode::Prepared.
    void Prepared(std::uint64_t senderLife, std::uint64_t number, std::shared_ptr<void> prepared,
                  LinkTime now);
    // Ends the session: a new incarnation of this node or of the source does not continue it.
    void DropSession();
    // The source has been silent: gives back the memory of parts that wait for an earlier one. The sender
    // sends them again if it returns.
    void DropBeyondGap();
    // The incarnation of the source is over: no more parts of incomplete messages come.
    void SourceEnded();
    bool KeepsParts() const { return !_kept.Empty(); }
    // True if a stream of that incarnation of the source is being received.
    bool HasSessionOf(std::uint64_t sourceLife) const { return HasSession() && _senderLife == sourceLife; }

    // When an acknowledgement is due; LinkNever: none is.
    LinkTime AckDue() const { return _ackAt; }
    // Makes the present acknowledgement. `sourceLife`: the present incarnation of the source.
    void Describe(LinkAck &ack, std::uint64_t sourceLife) const;
    // That acknowledgement was sent.
    void Acknowledged(const LinkAck &ack);

    LinkReceiverCounters Counters() const;
    std::string Describe() const;

private:
    enum class Result
    {
        Consumed,
        NotNow,  // it waits for room
        Late     // it may have expired on the way
    };

    bool HasSession() const { return _senderLife != 0; }
    bool MayOpen(const LinkFrame &frame, LinkTime now) const;
    void Open(const LinkFrame &frame, LinkTime now);
    void OnItem(const LinkFrame &frame, const LinkItem &item, LinkTime soon, LinkTime now);
    // Rules R5 and R6: if the returned time is not after `now`, the message may have expired.
    LinkTime AliveUntil(const LinkItem &item, const LinkEcho &echo, LinkTime now) const;
    std::string_view TypeOf(const LinkItem &item);
    void Keep(const ReceivedPart &part);
    // Consumes kept parts; with `turn`, no more once a message went into the queue.
    void ConsumeKept(LinkTime now, bool turn = false);
    Result HoldBack(LinkTime now);
    bool Append(const ReceivedPart &part, LinkTime now);
    Result Consume(const ReceivedPart &part, LinkTime now);
    Result ConsumePiece(const ReceivedPart &part, LinkTime now);
    Result ConsumeLast(const ReceivedPart &part, LinkTime now);
    Result Deliver(const ReceivedPart &part, std::string_view type, std::span<const std::uint8_t> payload,
                   const LinkPayload &owner, LinkTime now);
    void Advance(const ReceivedPart &part, OutcomeHistory::Entry entry);
    void AcknowledgeBy(LinkTime when);
    std::uint32_t Credit() const;

    LinkContext &_context;
    const std::string _source;
    const std::string _queue;
    std::uint32_t _link = 0;  // the source's number for the link

    // The session: the stream of the sender's incarnation that is being received.
    std::uint64_t _senderLife = 0;  // s_inc; 0: there is no session
    std::uint64_t _cumulative = 0;  // cum: highest number consumed
    std::uint64_t _oldest = 0;      // the sender knows the outcomes of all before it
    OutcomeHistory _history;
    LinkTime _openedAt{0};
    std::map<std::uint32_t, std::string> _types;
    ReorderBuffer _kept;
    Assembly _assembly;  // of the message whose turn it is

    LinkTime _ackAt = LinkNever;
    std::size_t _unacknowledged = 0;       // parts that came since the last acknowledgement
    std::size_t _unacknowledgedBytes = 0;  // of their payloads
    bool _heldBack = false;                // the sender was last told that there is no room, or nearly none
    bool _waits = false;                   // the next part could not be consumed for want of room or memory
    std::uint32_t _toldCredit = 0;         // by the last acknowledgement
    std::size_t _sharers = 1;              // links that share the room that the sender is told of next
    bool _noMemory = false;                // for the next piece of a large message
    // Number of the message that the driver prepares or has prepared; 0: none. It is the next one.
    std::uint64_t _givenOut = 0;
    std::shared_ptr<void> _prepared;  // null while the driver prepares it

    LinkReceiverCounters _counters;
};

}  // namespace Rabit
