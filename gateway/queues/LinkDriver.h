#pragma once

#include <rabit/RabitHandlerThread.h>
#include <rabit/RabitQueueReceipt.h>
#include <rabit/RabitWorkspace.h>
#include <rabit/gateway/GatewayConfig.h>
#include <rabit/gateway/GatewayTap.h>
#include <rabit/gateway/links/LinkNode.h>
#include <rabit/transport/Transport.h>

#include <atomic>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <span>
#include <string>
#include <string_view>
#include <unordered_map>
#include <utility>
#include <vector>

#include "air/DelayMeter.h"
#include "gateway.idl.h"
#include "incarnation/IncarnationStore.h"
#include "presence/RecentProblems.h"
#include "queues/IncomingQueues.h"
#include "queues/LinkDatagrams.h"

namespace Rabit
{

// Drives the queue links (LinkNode, which does no I/O): passes them arriving frames, serves them in time,
// writes the frames that they send, and reports the outcomes of messages.
//
// Threads: any thread calls Enqueue; the transport's threads pass in arriving frames and put messages
// straight into the local queues; only the gateway's thread, in Service or SendOne, writes to the network.
// One mutex guards the links; while it is held no large message is decoded, no file is written, and neither a
// queue's handler nor the transport is called. So a slow network, disk or handler delays nobody. The
// program's own handlers of queues and receipts are called by `handlers`.
class LinkDriver final : private LinkOutput
{
public:
    using Duration = std::chrono::nanoseconds;
    using Receipt = std::shared_ptr<RabitQueueReceipt>;

    // All references and the handlers must outlive the object, and nobody else may use the incarnations.
    // `clockName` tells this node's monotonic clock from those of its other incarnations. `wake` makes the
    // gateway's thread call Service soon; called on any thread. Without `handlers` all handlers are called on
    // the threads above.
    LinkDriver(const GatewayConfig &config, RabitWorkspace &workspace, IncarnationStore &incarnations,
               std::uint64_t clockName, std::function<void()> wake, RabitHandlerThread *handlers = nullptr);
    ~LinkDriver();

    // The present incarnation of this node.
    std::uint64_t Incarnation() const;
    // Adds the handler of frames that begin with `firstByte`, which is no version of the links, and come by
    // that path. It is called on the transport's threads, with the node that wrote the frame. Before Open.
    using OtherFrames = std::function<void(std::string_view node, std::span<const std::uint8_t> frame)>;
    void AddOtherFrames(std::size_t path, std::uint8_t firstByte, OtherFrames take);
    // Bytes of IPv4, UDP, RTPS and the encapsulation, for a frame.
    static constexpr std::size_t AboutTheHeaders = 110;
    // Sends such a frame to that node alone, by that path; gateway's thread only. The requesting node has to
    // notice a loss.
    void SendOther(std::size_t path, const std::string &node, std::span<const std::uint8_t> frame);
    // Starts to receive by another path, the first one at first, and keeps the session for writing until
    // Close. Throws TransportError.
    void Open(TransportSession &session);
    // Tells by which path a frame for a node goes besides the path of SendOne, and is told when it was sent
    // there. Before Open.
    struct SecondPath
    {
        std::function<std::optional<std::size_t>(std::string_view node, std::string_view queue,
                                                 std::size_t bytesOnTheAir)>
            Choose;
        std::function<void(std::size_t path)> Sent;
        // True if frames without messages go by a second path as well. Called with the links locked.
        std::function<bool(std::string_view node)> TakesAnswers;
    };
    void SetSecondPath(SecondPath second) { _second = std::move(second); }
    // Sends nothing more and receives nothing more. Messages without an outcome get one. Cannot be reopened.
    void Close();

    // Does what is due and writes it. Returns when to call again at the latest. Gateway's thread only.
    Duration Service();

    // In place of Service, for a scheduler that chooses the next datagram; gateway's thread only.
    //
    // Does all due work except sending. Returns when work is due next, if nothing comes before: not later
    // than now if something could be sent. The gateway's thread is woken for all work that comes between this
    // call and WillServe. After that it is woken for work due before the time given to WillServe.
    Duration Advance();
    void VisitStreams(std::size_t most, const std::function<void(const LinkStream &)> &visit) const;
    // Writes one datagram, made now, of at most `most` bytes on the air (LinkNode::SendOne). Returns true if
    // there was one.
    bool SendOne(std::size_t path, std::string_view destination, std::string_view queue, std::size_t most);
    void WillServe(Duration at);
    // The delays of other nodes' frames that are worth reporting to them (DelayMeter); each datagram is
    // reported once. The name is valid during the call.
    bool HasDelays() const { return _anyDelays; }
    void TakeDelays(
        std::size_t path, Duration now,
        const std::function<void(const std::string &node, Duration delay, Duration arrivedAt)> &take);
    void VisitPaths(const std::function<void(std::string_view node, const LinkPathState &)> &visit) const;
    // With several paths. The nodes of which frames have come since the last call, with the paths (bit i: the
    // i-th) by which new ones came first, and by which any with messages came; and the nodes of which an
    // answer is missing for longer than usual.
    struct CameBy
    {
        std::uint32_t First = 0;
        std::uint32_t Messages = 0;
    };
    std::map<std::string, CameBy> TakeCameBy();
    std::vector<std::string> Unanswered() const;
    // Frames for that node go by a second path, too: the unanswered ones are sent again at once.
    void ProbeNow(const std::string &node);
    // Frames for that node go by another path from now on: what was measured of the former one does not hold.
    void PathChanged(const std::string &node);
    // The shortest round trip to that node, with nothing waiting; 0: not known.
    Duration ShortestRoundTrip(std::string_view node) const;

    // Reports a node's incarnation. The links may learn it later by themselves; messages accepted meanwhile
    // would go to the earlier incarnation and be in doubt.
    void HeardOf(const std::string &node, std::uint64_t incarnation);

    // Accepts a message for a queue of another node; the receipt (may be null), which has had its Begin, gets
    // the outcome. If it is refused, the receipt gets nothing. `type` is a LinkTypeName. Any thread.
    LinkRefusal Enqueue(const std::string &node, const std::string &queue, const std::string &type,
                        const LinkPayload &payload, const Receipt &receipt);

    // Sets the expiry of messages for a queue of nodes that fit the pattern, whatever the configuration says.
    // It applies to links that are not in use yet. The last call that fits holds. Any thread.
    void SetExpiry(const std::string &node, const std::string &queue, std::chrono::milliseconds expire);

    // Takes the links on which an accepted message was refused at the other node since the last call. Each
    // link is there once, with the LinkTypeName of the newest such message. Any thread.
    struct Refused
    {
        std::string Node, Queue, Type;
    };
    std::vector<Refused> TakeRefusedThere();

    // True if messages for that node wait here.
    bool HasPending(const std::string &node) const;
    // The node is remembered no longer. Gateway's thread only.
    void Forget(const std::string &node);
    // Number of messages and datagrams refused or dropped because too many nodes or links are known.
    std::uint64_t CrowdedOut() const;

    std::vector<Gateway::LinkStatus> OutboundStatus() const;
    std::vector<Gateway::InboundStatus> InboundStatus() const;
    std::vector<Gateway::Problem> Problems() const;
    std::uint64_t Malformed() const;

private:
    // LinkOutput; called by LinkNode with the mutex held.
    void Send(const LinkFrame &frame, std::string_view queue) override;
    bool SendsAcksAlone(std::string_view destination) const override;
    LinkOptions OptionsOf(std::string_view destination, std::string_view queue) const override;
    void OnRefusedThere(std::string_view destination, std::string_view queue, std::string_view type) override;
    void OnOutcome(std::uint64_t id, std::string_view destination, std::string_view queue,
                   LinkOutcome outcome) override;

    // The outcome of a message.
    struct Outcome
    {
        std::string Node, Queue;
        std::uint64_t Id = 0;
        QueueOutcome What = QueueOutcome::Pending;
    };
    // Events to report to others once the mutex is free.
    struct News
    {
        std::vector<std::shared_ptr<IncomingQueues::Queue>> Delivered;  // queues with new messages
        std::vector<std::pair<Receipt, QueueOutcome>> Settled;          // receipts with an outcome

        void Clear()
        {
            Delivered.clear();
            Settled.clear();
        }
    };

    // One path of the gateway.
    struct Way
    {
        std::size_t Number = 0;
        std::vector<std::pair<std::uint8_t, OtherFrames>> Others;  // by their first byte
        DelayMeter Delays;                                         // guarded
        TransportSession *Session = nullptr;
        // One for all nodes, made when the node has a use for it: each endpoint of DDS costs all others
        // discovery.
        std::unique_ptr<TransportWriter> Writer;
        std::unique_ptr<TransportReader> Reader;
    };

    // The calling thread's own empty News, with its memory. For the threads of the transport and of the
    // gateway; not for managers, which are called while it is read.
    static News &OwnNews();
    // With the mutex held, into empty lists.
    void TakeNews(News &news);
    // With the mutex held: something is due then. True if the gateway's thread must be woken for it: it would
    // come later, and was not woken for anything as early.
    bool ServeBy(LinkTime due);
    // Without the mutex.
    void Tell(const News &news)
    {
        if (_config.Tap || !news.Delivered.empty() || !news.Settled.empty())
        {
            TellAll(news);
        }
    }
    void TellAll(const News &news);
    // The same for the tap: received messages and outcomes, reported to it before all others.
    void TellTap();

    // Links that are remembered for TakeRefusedThere.
    static constexpr std::size_t MostRefused = 64;

    // Handler of the transport.
    void OnFrame(SampleBytes bytes, const SampleInfo &info, Way &way);
    // Without the mutex: decodes the large messages that are complete, and has the links deliver them. For
    // threads that may take that long; every call of the links that may complete a message comes before one.
    void DecodeLarge(News &news);
    // Without the mutex: tells the news, and if there are `large` messages, decodes them. Clears the news.
    void TellAndDecode(News &news, bool large);
    // With the mutex: notes the path by which a frame has come.
    void NoteCame(const SampleInfo &info, const LinkFrame &frame, std::size_t path);
    // With the mutex: notes that another live node must have this name, if this one's incarnation was raised
    // too often.
    void NoteRaises(LinkTime now);
    // Before Open, makes it if there is none yet.
    Way &WayOf(std::size_t path);
    // Null before Open and after Close.
    TransportWriter *WriterOf(std::size_t path)
    {
        const bool isMade = path < _ways.size() && _ways[path]->Writer;
        return isMade ? _ways[path]->Writer.get() : MakeWriter(path);
    }
    TransportWriter *MakeWriter(std::size_t path);
    // Writes what the links have sent, by that path; without the mutex.
    void WriteOut(std::size_t path);
    static void Write(const LinkDatagrams::Datagram &datagram, TransportWriter *writer,
                      std::int64_t sourceTime);
    LinkTime Now() const { return _workspace.GetClock().Monotonic(); }

    const GatewayConfig &_config;
    RabitWorkspace &_workspace;
    IncarnationStore &_incarnations;
    const std::function<void()> _wake;
    RabitHandlerThread *const _handlers;

    mutable std::mutex _mutex;
    std::vector<SendRule> _expiries;                       // guarded; the last one first
    IncomingQueues _incoming;                              // guarded, but for Decode
    std::unordered_map<std::uint64_t, Receipt> _receipts;  // of messages without an outcome, by their ids
    std::vector<std::pair<Receipt, QueueOutcome>> _settled;
    std::vector<Outcome> _outcomes;  // for the tap
    std::vector<Refused> _refused;   // there; at most MostRefused
    LinkDatagrams _outbox;
    std::unique_ptr<LinkNode> _links;
    LinkTime _nextService{0};  // when the gateway's thread will call Service at the latest

    std::vector<std::unique_ptr<Way>> _ways;
    std::size_t _open = 0;  // of these
    SecondPath _second;
    // Of each node, with several paths: the time by its clock of the newest frame, and the paths by which new
    // frames came before they came by another. Guarded.
    struct Came
    {
        std::uint64_t Incarnation = 0;
        std::int64_t Newest = 0;
        CameBy By;
    };
    std::map<std::string, Came, std::less<>> _came;

    std::atomic<bool> _anyDelays{false};  // changed with the mutex held
    RecentProblems _recent;               // other versions of the links, and another node of this name
    std::uint64_t _lastIncarnation = 0;   // of this node, at the last frame; 0: no frame has come
    std::atomic<std::uint64_t> _malformed{0};

    LinkDatagrams _sending;  // gateway's thread only
};

}  // namespace Rabit
