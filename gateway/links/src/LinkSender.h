#pragma once

#include "LinkContext.h"
#include "LinkOutbox.h"
#include "PathControl.h"
#include "TypeNumbers.h"

#include <rabit/gateway/links/LinkCounters.h>
#include <rabit/gateway/links/LinkMessages.h>
#include <rabit/gateway/links/LinkOptions.h>
#include <rabit/gateway/links/LinkOutcome.h>
#include <rabit/gateway/links/LinkTime.h>

#include <cstdint>
#include <string>
#include <string_view>

namespace Rabit
{

// The sending half of one link: rules S1 to S5 of the protocol, for one queue of one other node.
class LinkSender
{
public:
    // `path` must outlive the object. `number` is the number of this link among those to the destination.
    LinkSender(LinkContext &context, PathControl &path, std::uint32_t number, std::string destination,
               std::string queue, const LinkOptions &options);

    // Rule S1. `type` must live as long as this object.
    LinkRefusal Enqueue(std::uint64_t id, const std::string &type, LinkPayload payload, LinkTime now);

    // Rules S3 and S7 and the timers: everything that is due except sending. `open`: the peer has given a
    // token and is not silent.
    void Advance(bool open, LinkTime now);
    // True if a datagram may be sent now, if the peer is open.
    bool IsReady(LinkTime now) const;
    // The queue of its messages; valid as long as the object.
    std::string_view Queue() const { return _queue; }
    // Approximate bytes of parts in the next datagram, at most `most`. Parts that are sent again come first
    // and are not cut anew.
    std::size_t NextBytes(std::size_t most) const;
    enum class Filled
    {
        Nothing,
        Parts,
        Question  // no parts: asks only whether the receiver hears it
    };
    // Rule S2: puts the next datagram's parts into the frame, whose header is complete. The frame is not
    // larger than `most`, unless a single small part makes it so.
    Filled Fill(LinkFrame &frame, std::size_t most, LinkTime now);
    // True if there is more to send as soon as the path allows it.
    bool HasMore() const { return HasLost() || MayCut(); }
    // True if there is more that may be sent only after an acknowledgement, whatever the path.
    bool WaitsForAck() const { return _outbox.HasMore() && !MayCut(); }
    // When Advance or sending is due; see LinkNode::NextDue.
    LinkTime NextDue(bool open) const;

    // True if the acknowledgement is possible for this stream: a number never sent cannot be acknowledged.
    bool IsPossible(const LinkAck &ack) const;
    // Rule S4, for an acknowledgement of the present incarnations. `time`: the receiver's clock when it was
    // sent. `echo`: when the newest frame was sent that the receiver had then; 0: unknown.
    void OnAck(const LinkAck &ack, std::int64_t time, LinkTime echo, LinkTime now);
    // The peer has received the frame that was sent at `echo`.
    void OnEcho(LinkTime echo);
    // A frame came from the peer after a silence: the wait for the probe timer ends.
    void OnPeerHeard(LinkTime now);
    // If frames are under way, a probe goes at once, and the wait for the next one is the shortest again.
    void ProbeNow(LinkTime now);
    // Rules S5 and S6: the receiver, or this node, has a new incarnation. The stream starts anew.
    void Restart();
    // Reports everything pending as never to be delivered, or in doubt.
    void Close();

    bool HasPending() const { return _outbox.Count() > 0; }
    LinkSenderCounters Counters() const;
    std::string Describe() const;

private:
    struct Filling;  // a datagram that is being filled

    void ExpireWaiting(LinkTime now);
    void ExpireSent(LinkTime now);
    void SettleExpired(LinkTime now);
    void OnProbeTimer();
    // True if so many probes were unanswered that whole datagrams are sent only once the receiver shows that
    // it hears.
    bool IsInVain() const;
    LinkTime ReadyAt() const;
    // True if there is credit for this sent message, or if it is the first one and goes as a probe.
    bool HasCredit(std::uint64_t message) const;
    bool HasLost() const;
    bool MayCut() const;

    void FillAgain(Filling &filling);
    std::size_t BytesAgain(const Filling &filling, std::uint64_t sequence) const;
    std::size_t BytesForNext(const Filling &filling) const;
    bool FillNew(Filling &filling);
    bool Again(Filling &filling, std::uint64_t &sequence);
    void Describe(const SentPart &part, const OutboxMessage &message, std::uint64_t sequence, LinkItem &item,
                  LinkTime now) const;
    bool IsProbeSmall(LinkTime now) const;
    void OnSent(std::size_t bytes, bool hasParts, bool turnedAway, LinkTime now);
    void OnPartSent(Filling &filling, SentPart &part, std::size_t bytes);

    void TakeUpTo(const LinkAck &ack, LinkTime now);
    void TakeHeld(const LinkAck &ack, LinkTime now);
    void FindLost(LinkTime echo, LinkTime now);
    void OnArrived(SentPart &part, LinkTime now);
    void SetLost(SentPart &part, bool onTheWay);
    void LeavePath(SentPart &part);
    void ArmProbe(bool turnedAway, LinkTime now);
    // True if the receiver has no room for the first message, or for parts that it has already.
    bool IsTurnedAway() const;
    // True if the receiver has the first part, and waits for room.
    bool IsFirstHeld() const;
    void Report(const OutboxMessage &message, LinkOutcome outcome);
    void ReportExpired(const OutboxMessage &message);

    LinkContext &_context;
    PathControl &_path;
    const std::uint32_t _number;
    const std::string _destination;
    const std::string _queue;
    const LinkOptions _options;
    LinkOutbox _outbox;
    TypeNumbers _types;
    bool _isKnown = false;  // the receiver knows which queue the number means

    std::uint64_t _base = 1;  // first number of this stream; its incarnation is the present one
    std::size_t _inFlight = 0;
    std::size_t _lost = 0;  // parts that are to be sent again
    std::size_t _held = 0;  // parts that the receiver has, beyond a gap
    // The first sent message without credit, and the receiver's clock in that acknowledgement.
    std::uint64_t _creditLimit = 0;
    std::int64_t _ackTime = 0;

    // One datagram may go out although there is no credit or no room on the path.
    bool _probe = true;
    int _doublings = 0;  // probes since anything was heard of this stream
    // Probes sent since the first of these, those of them that carried parts, and their bytes; and since when
    // these are too many.
    int _probesInVain = 0;
    int _partsInVain = 0;
    std::size_t _bytesInVain = 0;
    LinkTime _inVainSince{0};
    int _stalls = 0;  // the same since anything was acknowledged, while the receiver holds the stream up
    LinkTime _probeAt = LinkNever;
    LinkTime _lostAt = LinkNever;  // when overtaken parts count as lost
    LinkTime _lastEcho{0};
    LinkTime _lastSentAt{0};

    LinkSenderCounters _counters;
};

}  // namespace Rabit
