#pragma once

#include "LinkContext.h"
#include "LinkReceiver.h"
#include "LinkSender.h"
#include "PathControl.h"
#include "PeerToken.h"

#include <rabit/gateway/links/LinkTime.h>

#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

namespace Rabit
{

// One other node: its life, its token, the path to it, hellos and acknowledgements, and the links to and from
// it. A node's life and clock are the same for all its links, so what one link learns of them holds for all.
class LinkPeer
{
public:
    using Senders = std::map<std::string, std::unique_ptr<LinkSender>, std::less<>>;
    using Receivers = std::map<std::string, std::unique_ptr<LinkReceiver>, std::less<>>;

    LinkPeer(LinkContext &context, std::string name, LinkTime now);

    // The life in which this node is to the peer.
    std::uint64_t OwnLife() const { return _ownLife; }
    // The life that the peer is in as far as known; 0: not heard yet.
    std::uint64_t Incarnation() const { return _incarnation; }

    // Fills in what a short frame of the peer leaves out. False: it is not for this node, not of the peer's
    // present life, or not for that of this node.
    bool Expand(LinkFrame &frame, LinkTime now) const;
    // Whether all acknowledgements in a frame of the present lives can be.
    bool AreAcksPossible(const LinkFrame &frame) const;
    // A frame has come. Rules S4, S5, R1 and R2, and what follows for the links.
    void OnFrame(const LinkFrame &frame, LinkTime now);

    // The peer says, or something else heard, that it is in this life. Rule S5: a higher one than known is
    // a restart, all streams to it start anew; a lower one is old, or the peer has lost its storage and must
    // be told by a hello. Returns whether it is the life known now.
    bool HeardOf(std::uint64_t incarnation, LinkTime now);
    // Sends a hello as soon as HelloGap allows.
    void HelloSoon(LinkTime now);

    // Whether nothing is lost with it but what can be learnt again: nothing waits for it here.
    bool MayBeForgotten() const { return !HasPending(); }
    bool HasLinks() const { return !_senders.empty() || !_receivers.empty(); }
    bool IsUnheardAt(LinkTime now) const { return now - _heardAt >= _context.Settings.SilentAfter; }
    LinkTime HeardAt() const { return _heardAt; }

    // Rules R1 and S6: this node has taken a new incarnation.
    void OnOwnRaise(LinkTime now);

    LinkSender *FindSender(std::string_view queue) const;
    LinkReceiver *FindReceiver(std::string_view queue) const;
    // Makes a link. There must be none for that queue.
    LinkSender &AddSender(std::string_view queue, const LinkOptions &options);
    const Senders &AllSenders() const { return _senders; }
    const Receivers &AllReceivers() const { return _receivers; }
    const PathControl &Path() const { return _path; }

    // A message was enqueued for the peer: one that has given no token, or is silent, is asked.
    void OnEnqueued(LinkTime now);

    // Everything that is due, except sending.
    void Advance(LinkTime now);
    // Advances, and sends all that may be sent now.
    void Run(LinkTime now);
    // Acknowledgements and hellos that are due: their bytes, about; 0: none. And sends them.
    std::size_t UrgentBytes(LinkTime now) const;
    bool SendUrgent(LinkTime now);
    // The next datagram of one link: its bytes, about, if it has at most so many on the air; 0: it has none
    // now. And sends it, of at most so many bytes.
    std::size_t DataBytes(const LinkSender &sender, std::size_t most, LinkTime now) const;
    bool SendData(LinkSender &sender, std::size_t most, LinkTime now);
    LinkTime NextDue() const;
    std::string Describe() const;

private:
    // The receiver of the data; null: the number means nothing yet, the queue is not accepted, or there are
    // too many.
    LinkReceiver *ReceiverOf(const LinkData &data);
    void OnData(const LinkFrame &frame, LinkTime now);
    void OnAcks(const LinkFrame &frame, LinkTime now);
    void Measure(const LinkFrame &frame, LinkTime now);
    // Whether it is newer than the one that was known.
    bool TakeToken(std::uint32_t clock, std::int64_t time, LinkTime now);
    void HeardNow(LinkTime now);

    // True if the frame says an incarnation that no wall clock gives yet, and does not prove by an echo that
    // its sender hears this node.
    bool IsIncredible(const LinkFrame &frame) const;
    bool HasPending() const;
    bool IsOpen() const;
    bool IsSilentAt(LinkTime now) const
    {
        return _unansweredSince != LinkNever && now - _unansweredSince >= _context.Settings.SilentAfter;
    }
    // When an acknowledgement or a hello is due.
    LinkTime UrgentDue() const;
    LinkFrame &BeginFrame(bool mayBeShort, LinkTime now);
    // Adds the acknowledgements that are waiting, due or not, as far as the frame takes no more than `most`
    // bytes; with `one`, the first in any case. Call AcksSent when the frame was sent with them.
    void AddAcks(LinkFrame &frame, std::size_t most, bool one);
    void AcksSent(const LinkFrame &frame);
    void Refuse(const LinkData &data);
    void Send(const LinkFrame &frame, bool asks, LinkTime now);
    void SendHello(LinkTime now);

    // Parts for a queue that this node does not accept, up to a number.
    struct Refusal
    {
        std::uint32_t Link = 0;
        std::uint64_t Oldest = 0;
        std::uint64_t Through = 0;
    };

    LinkContext &_context;
    const std::string _name;
    std::uint64_t _ownLife;
    std::uint64_t _incarnation = 0;
    PeerToken _token;
    bool _knowsMe = false;  // the peer has this node's life and clock
    LinkTime _heardAt;      // when something of its present life came last; at first, when it was made
    LinkTime _unansweredSince = LinkNever;  // since when something that was sent wants an answer
    bool _silent = false;                   // for SilentAfter
    LinkTime _helloAt = LinkNever;
    LinkTime _helloGap;  // until the next one at least; doubles until a frame of both present lives comes
    LinkTime _lastHelloAt = LinkNever;  // LinkNever: none was sent
    PathControl _path;
    Senders _senders;
    std::vector<LinkSender *> _byNumber;  // number 1 is at index 0
    std::size_t _nextTurn = 0;            // whose turn it is to send, by number
    Receivers _receivers;
    std::map<std::uint32_t, LinkReceiver *> _receiverOf;  // by the peer's numbers
    std::vector<std::uint32_t> _unknownLinks;             // numbers that the peer must say the queues of
    std::vector<Refusal> _refusals;                       // to be acknowledged
    // Of the frame that is being made: the receivers of its first acknowledgements; reused.
    std::vector<LinkReceiver *> _acknowledged;
    bool _droppedBeyondGaps = false;  // since the peer was heard
};

}  // namespace Rabit
