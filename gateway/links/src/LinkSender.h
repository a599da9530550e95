#pragma once

#include "ByteWindow.h"
#include "LinkContext.h"
#include "LinkOutbox.h"
#include "PeerToken.h"
#include "ResendTimer.h"

#include <rabit/gateway/links/LinkCounters.h>
#include <rabit/gateway/links/LinkMessages.h>
#include <rabit/gateway/links/LinkOptions.h>
#include <rabit/gateway/links/LinkOutcome.h>
#include <rabit/gateway/links/LinkTime.h>

#include <cstdint>
#include <string>

namespace Rabit
{

// What a sender needs to know of its peer to send to it.
struct PeerView
{
    const std::string &Name;
    std::uint64_t Incarnation = 0;  // r_inc: the life that the peer is in, as far as known
    PeerToken Token;
    bool Silent = false;  // not heard for long: nothing but hellos is sent to it
};

// The sending half of one link: rules S1 to S5 of the protocol, for one queue of one other node.
class LinkSender
{
public:
    // `ownLife`: the life in which this node is to the destination; must outlive the object.
    LinkSender(LinkContext &context, const std::uint64_t &ownLife, std::string destination, std::string queue,
               const LinkOptions &options);

    // Rule S1. `type` must live as long as this object.
    LinkRefusal Enqueue(std::uint64_t id, const std::string &type, LinkPayload payload, LinkTime now);
    // Rules S2 and S3: expires, sends and resends what is due.
    void Run(const PeerView &peer, LinkTime now);
    // When Run has something to do; see LinkNode::NextDue.
    LinkTime NextDue(const PeerView &peer) const;

    // Whether the acknowledgement can be one of this stream: a number never sent cannot be acknowledged.
    bool IsPossible(const LinkAck &ack) const;
    // Rule S4, for an acknowledgement of the peer's present life.
    void OnAck(const LinkAck &ack, LinkTime now);
    // A hello has come from the peer: there is a path, so what waits for the resend timer need not wait
    // longer.
    void OnPeerHeard(LinkTime now);
    // Rules S5 and S6: the receiver, or this node, is in a new life. The stream starts anew.
    void Restart();
    // Reports everything pending as never to be delivered, or in doubt.
    void Close();

    bool HasPending() const { return !_outbox.Empty(); }
    const std::string &Queue() const { return _queue; }
    LinkSenderCounters Counters() const;
    std::string Describe() const;

private:
    void ExpireWaiting(LinkTime now);
    void OnResendTimer(LinkTime now);
    bool MaySendNext() const;
    const OutboxMessage &AtCursor() const;
    std::size_t FrontDatagram() const;
    void GoBackToFront();
    LinkTime ResendTime(LinkTime now, LinkTime timeout) const;
    void SendDatagram(const PeerView &peer, LinkTime now);
    bool Append(LinkData &data, std::size_t &bytes, LinkTime now);
    void Report(const OutboxMessage &message, LinkOutcome outcome);

    LinkContext &_context;
    const std::uint64_t &_ownLife;
    const std::string _destination;
    const std::string _queue;
    const LinkOptions _options;
    LinkOutbox _outbox;

    // First number of this stream. Its incarnation is always _ownLife.
    std::uint64_t _base = 1;
    // Next number to send. Below NextSequence(): it was sent before.
    std::uint64_t _cursor = 1;
    // Bytes of the messages from the first unacknowledged one up to the cursor.
    std::size_t _bytesInFlight = 0;
    ByteWindow _window;
    // Messages that may be in flight: the window, or fewer after a timeout until acknowledgements come again.
    std::size_t _allowed;
    // Highest number that the receiver has given credit for, and when (by its clock) it did.
    std::uint64_t _creditLimit = 0;
    std::int64_t _creditTime = 0;
    // The first message may be sent although there is no credit for it.
    bool _probe = true;

    ResendTimer _timer;
    LinkTime _resendAt{0};
    LinkTime _lastSentAt{0};
    std::int64_t _echoedSentAt = 0;  // of the latest datagram whose round trip was measured

    LinkSenderCounters _counters;
};

}  // namespace Rabit
