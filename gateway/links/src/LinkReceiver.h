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

    // Data of the present lives of both nodes. `ackDelay`: how long the acknowledgement may wait for more.
    void OnData(const LinkFrame &frame, LinkTime ackDelay, LinkTime now);
    // The local queue has room again.
    void OnRoom(LinkTime now);
    // Delivers what could not be delivered before, if now it can.
    void Retry(LinkTime now);
    // What was received is not continued: a new life of this node or of the source.
    void DropSession();

    // Does what is due, except acknowledging.
    void Advance(LinkTime now);
    // When it has to be acknowledged; LinkNever: not at all.
    LinkTime AckDue() const { return _ackAt; }
    LinkTime NextDue() const { return _roomCame ? LinkTime(0) : _ackAt; }
    // The acknowledgement of now, which is then no longer due. `sourceLife`: the present life of the source.
    void Acknowledge(LinkAck &ack, std::uint64_t sourceLife);

    // The source's number for the link.
    std::uint32_t Link() const { return _link; }
    const std::string &Queue() const { return _queue; }
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
    // Rules R5 and R6: what is not alive even now may have expired.
    LinkTime AliveUntil(const LinkItem &item, const LinkEcho &echo, LinkTime now) const;
    std::string_view TypeOf(const LinkItem &item);
    void Keep(const ReceivedPart &part);
    void ConsumeKept(LinkTime now);
    Result Consume(const ReceivedPart &part, LinkTime now);
    Result ConsumePiece(const ReceivedPart &part, LinkTime now);
    Result ConsumeLast(const ReceivedPart &part, LinkTime now);
    Result Deliver(const ReceivedPart &part, std::string_view type, std::span<const std::uint8_t> payload,
                   const LinkPayload &owner, LinkTime now);
    void Advance(const ReceivedPart &part, OutcomeHistory::Entry entry);
    void AcknowledgeBy(LinkTime when);

    LinkContext &_context;
    const std::string _source;
    const std::string _queue;
    std::uint32_t _link = 0;

    // The session: the stream of the sender's life that is being received.
    std::uint64_t _senderLife = 0;  // s_inc; 0: there is no session
    std::uint64_t _cumulative = 0;  // cum: highest number consumed
    std::uint64_t _oldest = 0;      // the sender knows the outcomes of all before it
    OutcomeHistory _history;
    LinkTime _openedAt{0};
    std::map<std::uint32_t, std::string> _types;
    ReorderBuffer _kept;
    Assembly _assembly;

    LinkTime _ackAt = LinkNever;
    std::size_t _unacknowledged = 0;       // parts that came since the last acknowledgement
    std::size_t _unacknowledgedBytes = 0;  // of their payloads
    bool _heldBack = false;                // the sender was last told that there is no room
    bool _noMemory = false;                // for the next piece of a large message
    bool _roomCame = false;                // Retry is due

    LinkReceiverCounters _counters;
};

}  // namespace Rabit
