#pragma once

#include "LinkContext.h"
#include "LinkReceiver.h"
#include "LinkSender.h"
#include "PathControl.h"
#include "PeerToken.h"

#include <rabit/base/Backoff.h>
#include <rabit/gateway/links/LinkTime.h>

#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

namespace Rabit
{

// One other node: its incarnation, its token, the path to it, hellos and acknowledgements, and the links to
// and from it. A node's incarnation and clock are the same for all its links, so they are kept here.
class LinkPeer
{
public:
    using Senders = std::map<std::string, std::unique_ptr<LinkSender>, std::less<>>;
    using Receivers = std::map<std::string, std::unique_ptr<LinkReceiver>, std::less<>>;

    LinkPeer(LinkContext &context, std::string name, LinkTime now);

    // The incarnation of this node for the peer.
    std::uint64_t OwnLife() const { return _ownLife; }
    // The known incarnation of the peer; 0: not heard yet.
    std::uint64_t Incarnation() const { return _incarnation; }

    // Fills in the fields that a short frame of the peer leaves out. False: the frame is not for this node,
    // or not of both present incarnations.
    bool Expand(LinkFrame &frame, LinkTime now) const;
    // True if all acknowledgements in a frame of the present incarnations are possible.
    bool AreAcksPossible(const LinkFrame &frame) const;
    // Processes a frame by rules S4, S5, R1 and R2, and passes it to the links.
    void OnFrame(const LinkFrame &frame, LinkTime now);

    // Reports the peer's incarnation. Rule S5: a higher one than known is a restart, and all streams to the
    // peer start anew; a lower one is old, or the peer has lost its storage and must be told by a hello.
    // Returns true if it is the known incarnation now.
    bool HeardOf(std::uint64_t incarnation, LinkTime now);
    // Sends a hello as soon as HelloGap allows.
    void HelloSoon(LinkTime now);

    // True if nothing is lost with the peer that cannot be learnt again: nothing waits for it here.
    bool MayBeForgotten() const { return !HasPending(); }
    bool HasLinks() const { return !_senders.empty() || !_receivers.empty(); }
    bool IsUnheardAt(LinkTime now) const { return now - _heardAt >= _context.Settings.SilentAfter; }
    LinkTime HeardAt() const { return _heardAt; }

    // True if a frame that asks is unanswered for longer than answers take. A wireless network may well be
    // silent for some tens of milliseconds.
    static constexpr LinkTime ShortestDoubt = std::chrono::milliseconds(100);
    bool IsUnansweredAt(LinkTime now) const
    {
        return _askedSince != LinkNever && now - _askedSince > std::max(_path.ProbeTimeout(), ShortestDoubt);
    }
    void ProbeNow(LinkTime now);
    // Frames go by another path from now on.
    void PathChanged(LinkTime now);

    // Rules R1 and S6: this node has taken a new incarnation.
    void OnOwnRaise(LinkTime now);

    LinkSender *FindSender(std::string_view queue) const;
    LinkReceiver *FindReceiver(std::string_view queue) const;
    // Makes a link. There must be none for that queue.
    LinkSender &AddSender(std::string_view queue, const LinkOptions &options);
    const Senders &AllSenders() const { return _senders; }
    const Receivers &AllReceivers() const { return _receivers; }
    const PathControl &Path() const { return _path; }

    // A message was enqueued for the peer: sends a hello to a peer that has given no token or is silent.
    void OnEnqueued(LinkTime now);

    // Everything that is due, except sending.
    void Advance(LinkTime now);
    // Advances, and sends all that may be sent now.
    void Run(LinkTime now);
    // UrgentBytes returns the approximate bytes of the acknowledgements and hellos that are due, 0 if none;
    // SendUrgent sends them.
    std::size_t UrgentBytes(LinkTime now) const;
    bool SendUrgent(LinkTime now);
    // DataBytes returns the approximate bytes of the link's next datagram, which takes at most `most` bytes
    // on the air; 0: it has none now. SendData sends it.
    std::size_t DataBytes(const LinkSender &sender, std::size_t most, LinkTime now) const;
    bool SendData(LinkSender &sender, std::size_t most, LinkTime now);
    LinkTime NextDue() const;
    std::string Describe() const;

private:
    // The receiver of the data; null: the number means nothing yet, the queue is not accepted, or there are
    // too many.
    LinkReceiver *ReceiverOf(const LinkData &data);
    // Drops a receiver that a former incarnation of the peer used, and that keeps nothing. False: there is
    // none.
    bool DropFormerReceiver();
    void OnData(const LinkFrame &frame, LinkTime now);
    void OnAcks(const LinkFrame &frame, LinkTime now);
    // How long the acknowledgement of data that came now may wait.
    LinkTime AckDelay(LinkTime now);
    void Measure(const LinkFrame &frame, LinkTime now);
    // Takes the token if it is newer than the known one. Returns true if it was.
    bool TakeToken(std::uint32_t clock, std::int64_t time, LinkTime now);
    void HeardNow(LinkTime now);

    // True if the frame names an incarnation that no wall clock gives yet, and no echo proves that its sender
    // hears this node.
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
    void Send(const LinkFrame &frame, std::string_view queue, bool asks, LinkTime now);
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
    bool _knowsMe = false;  // the peer knows this node's incarnation and clock
    LinkTime _heardAt;      // when a frame of its present incarnation came last; at first, when this object
                            // was made
    LinkTime _unansweredSince = LinkNever;  // since when a sent frame waits for an answer
    // The first and the newest frame that wait for an answer, as precise as their echoes.
    LinkTime _askedSince = LinkNever;
    LinkTime _askedAt{0};
    bool _silent = false;  // for SilentAfter
    LinkTime _helloAt = LinkNever;
    Backoff _helloGap;  // least time to the next hello; reset by a frame of both present incarnations
    LinkTime _lastHelloAt = LinkNever;  // LinkNever: none was sent
    PathControl _path;
    Senders _senders;
    std::vector<LinkSender *> _byNumber;  // number 1 is at index 0
    std::size_t _nextTurn = 0;            // the link whose turn it is to send, by number
    Receivers _receivers;
    std::map<std::uint32_t, LinkReceiver *> _receiverOf;  // by the peer's numbers
    std::vector<std::uint32_t> _unknownLinks;             // numbers whose queues the peer must name
    std::vector<Refusal> _refusals;                       // to be acknowledged
    // The receivers of the first acknowledgements of the frame that is being made; reused.
    std::vector<LinkReceiver *> _acknowledged;
    bool _droppedBeyondGaps = false;  // since the peer was heard
    LinkTime _dataAt{0};              // when the last data came
    bool _acksGoWithData = false;     // true if the last acknowledgement went with data
    LinkTime _lookAt = LinkNever;     // this is due then, even if nothing is to be sent
};

}  // namespace Rabit
