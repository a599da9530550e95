#pragma once

#include <rabit/gateway/links/LinkCounters.h>
#include <rabit/gateway/links/LinkHost.h>
#include <rabit/gateway/links/LinkMessages.h>
#include <rabit/gateway/links/LinkOptions.h>
#include <rabit/gateway/links/LinkOutcome.h>
#include <rabit/gateway/links/LinkPayload.h>
#include <rabit/gateway/links/LinkTime.h>

#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <set>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace Rabit
{

class LinkPeer;
class LinkReceiver;
class LinkSender;
struct LinkContext;

// A source of datagrams to another node: one link, or the acknowledgements and hellos of all links.
struct LinkStream
{
    std::string_view Destination;
    std::string_view Queue;  // empty: acknowledgements and hellos, which go before everything else
    std::size_t Bytes = 0;   // size of its next datagram on the air, approximately; never 0
};

// Measurements of the path to another node.
struct LinkPathState
{
    LinkTime RoundTrip{0};      // smoothed; 0: not measured yet
    LinkTime QueueingDelay{0};  // the part of it spent in buffers on the way, in the last round trip
    std::size_t Window = 0;     // bytes that may be under way, as on the air
    std::size_t InFlight = 0;   // bytes that are under way
    double DeliveryRate = 0;    // bytes per second that arrived when the window was last full; 0: not known
    double LossRate = 0;        // 0 to 1
};

// All queue links of one node: the state machine that a gateway drives. Messages enqueued here reach a queue
// of another node exactly once and in order as long as both live, whatever the network does in between; each
// gets one outcome. gateway/links/README.md has the protocol.
//
// It does no I/O and reads no clock. The driver hands in what happens and the time (LinkTime, never lower
// than before). It is called back through LinkOutput, LocalQueues and IncarnationSource during these calls.
// The usual loop: hand in what has come, call Run, wait until NextDue() or until something comes.
//
// Threads: none of its own, and not thread-safe: the driver calls from one thread at a time. Enqueue sends
// nothing and reports only outcomes, so that it may be called under a lock by any thread; the sending is done
// by Run. Not re-entrant: the callbacks must not call back into the object.
//
// Lifetime: the three hosts must outlive the object. Destroying it reports no outcomes; see Close.
//
// Memory: names, outboxes and windows are bounded by LinkOptions and LinkSettings. In the steady state no
// memory is allocated for a message.
class LinkNode
{
public:
    // Takes its first incarnation from the source. Throws std::invalid_argument if a setting is out of range.
    LinkNode(const LinkSettings &settings, LinkOutput &output, LocalQueues &queues,
             IncarnationSource &incarnations);
    ~LinkNode();
    LinkNode(const LinkNode &) = delete;
    LinkNode &operator=(const LinkNode &) = delete;

    // Makes a link to a queue of another node with these options, if there is none yet; one that is in use
    // keeps its options. Returns LinkRefusal::None if the link is there now. Throws std::invalid_argument if
    // an option is out of range.
    LinkRefusal Configure(std::string_view destination, std::string_view queue, const LinkOptions &options,
                          LinkTime now);

    // Accepts a message for a queue of another node, or refuses it at once. The link is made on first use,
    // with the options of Configure or else those of LinkOutput::OptionsOf. Rule S1. Call Run when
    // LinkEnqueued::Due says.
    LinkEnqueued Enqueue(std::string_view destination, std::string_view queue, std::string_view type,
                         LinkPayload payload, LinkTime now);

    // Processes a frame from a peer's gateway, frame.Source. A frame that is malformed or meant for another
    // node is dropped and counted, and changes nothing else: false. Fills in the fields that a short frame
    // leaves out.
    bool OnFrame(LinkFrame &frame, LinkTime now);
    // Reports a node's incarnation that another source than the links has learnt; the effect is that of a
    // hello. Does nothing if the links know that incarnation, or do not know the node.
    void HeardOf(std::string_view node, std::uint64_t incarnation, LinkTime now);

    // A message was taken out of this local queue, or the queue has come into being. The links that wait for
    // it take turns, a message each; the turn goes on after the link that was served last.
    void OnRoom(std::string_view queue);
    // The driver has prepared the message that LocalQueues::Deliver answered Later: it is offered again, with
    // `prepared`. Null: it could not be prepared now, and is offered again without. Does nothing if that
    // message is no longer the next one of its link.
    void Prepared(std::string_view source, std::string_view queue, std::uint64_t senderLife,
                  std::uint64_t number, std::shared_ptr<void> prepared, LinkTime now);

    // Forgets a node and the links to and from it, unless messages for it wait here (false). Messages from
    // that node whose outcome it has not learnt will be in doubt there. Without this call a node is forgotten
    // when LinkSettings::MaxPeers are known and another one comes.
    bool Forget(std::string_view node);
    // True if messages for that node wait here.
    bool HasPending(std::string_view node) const;

    // Does everything that is due: expiry, sending, resending, acknowledging, hellos.
    void Run(LinkTime now);
    // When Run has work to do: now or earlier if at once, LinkNever if none until the next input.
    LinkTime NextDue() const;

    // In place of Run, for a scheduler that chooses the next datagram: Advance does everything that is due
    // except sending, VisitStreams lists the streams that could send now, SendOne sends one datagram of one
    // of them.
    void Advance(LinkTime now);
    // `most` is the largest datagram in bytes on the air. A part that was cut for a larger datagram goes
    // whole.
    void VisitStreams(std::size_t most, LinkTime now,
                      const std::function<void(const LinkStream &)> &visit) const;
    // Sends at most `most` bytes on the air, unless a single small message is larger; acknowledgements and
    // hellos are always sent. Returns true if anything was sent. LinkOutput::Send is called at most once.
    bool SendOne(std::string_view destination, std::string_view queue, std::size_t most, LinkTime now);

    // Ends all links to other nodes in an orderly way. Messages that were never sent are reported as Expired
    // (they will never be delivered), messages that were sent and not acknowledged as InDoubt. The object
    // must not be used afterwards, except for its counters.
    void Close();

    const std::string &Name() const;
    // The incarnation of this node for peers that it meets now. It rises when a peer knows a higher one
    // (rules R1 and S6), and when a peer with links is forgotten.
    std::uint64_t Incarnation() const;
    // The incarnation of this node for that peer: the same, or an earlier one from before other peers were
    // forgotten.
    std::uint64_t IncarnationTo(std::string_view node) const;
    // The alarm of rule S6: incarnations had to be taken so often that another live node must have this name.
    bool NameInUseElsewhere() const;

    LinkNodeCounters Counters() const;
    // Calls the function for each link to another node / from another node, in the order of their names.
    void VisitSenders(const std::function<void(std::string_view destination, std::string_view queue,
                                               const LinkSenderCounters &)> &visit) const;
    void VisitReceivers(const std::function<void(std::string_view source, std::string_view queue,
                                                 const LinkReceiverCounters &)> &visit) const;
    // The same for the path to each node that there is a link to.
    void VisitPaths(const std::function<void(std::string_view node, const LinkPathState &)> &visit) const;
    // Calls the function for each node that has not answered a frame for longer than its answers usually
    // take.
    void VisitUnanswered(LinkTime now, const std::function<void(std::string_view node)> &visit) const;
    // Does not wait for the answers of that node: sends a probe on each link at once.
    void ProbeNow(std::string_view node, LinkTime now);
    // Frames for that node go by another path from now on: what was measured of the former one does not hold.
    void PathChanged(std::string_view node, LinkTime now);
    // The shortest round trip to that node, measured anew now and then with nothing waiting; 0: not known, or
    // nothing was ever sent there.
    LinkTime ShortestRoundTrip(std::string_view node) const;
    // The whole state except the counters as text, one line per peer and link: for logs, and for tests that
    // state did not change.
    std::string Describe() const;

private:
    using Peers = std::map<std::string, std::unique_ptr<LinkPeer>, std::less<>>;

    bool IsPossiblePeer(std::string_view name) const;
    LinkPeer *FindPeer(std::string_view name) const;
    LinkPeer *FindOrAddPeer(std::string_view name, LinkTime now);
    // Without options a new link has those of LinkOutput::OptionsOf.
    LinkRefusal FindOrAddSender(std::string_view destination, std::string_view queue,
                                const LinkOptions *options, LinkTime now, LinkPeer *&peer,
                                LinkSender *&sender);
    bool Accepts(LinkFrame &frame, const LinkPeer *peer, LinkTime now);
    void OnUnknownShort(const LinkFrame &frame, LinkTime now);
    bool ForgetOne(LinkTime now);
    void Forget(Peers::iterator peer);
    void HeardOfMyself(const LinkPeer *from, std::uint64_t incarnation, LinkTime now);
    void ServeRooms(LinkTime now);

    // A local queue and the node whose link to it was served last.
    struct Turn
    {
        std::string Last;
        bool RoomCame = false;
    };

    IncarnationSource &_incarnations;
    std::unique_ptr<LinkContext> _context;
    Peers _peers;
    std::set<std::string, std::less<>> _types;        // type names that messages in outboxes point to
    std::map<std::string, Turn, std::less<>> _turns;  // by queue
    bool _roomCame = false;                           // in any of them
    std::vector<std::pair<const std::string *, LinkReceiver *>> _waiting;  // reused
    std::uint64_t _nextId = 1;
    LinkTime _mayRaiseAt{LinkTime::min()};
};

}  // namespace Rabit
