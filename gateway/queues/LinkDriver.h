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
#include "queues/IncomingQueues.h"
#include "queues/LinkDatagrams.h"
#include "queues/LinkVersions.h"

namespace Rabit
{

// Drives the queue links (LinkNode, which does no I/O): takes in what arrives, serves them in time, writes
// what they send, and tells what became of messages.
//
// Threads: any thread calls Enqueue; the transport's threads hand in what arrives and put it straight into
// the local queues; only the gateway's thread, in Service or SendOne, writes to the network. One mutex guards
// the links; while it is held no large message is decoded, no file is written, and no handler of a queue and
// nothing of the transport is called, so that a slow network, disk or handler delays nobody. The program's
// own handlers of queues and receipts are called by `handlers`.
class LinkDriver final : private LinkOutput
{
public:
    using Duration = std::chrono::nanoseconds;
    using Receipt = std::shared_ptr<RabitQueueReceipt>;

    // All references and the handlers must outlive the object, and nobody else may use the incarnations.
    // `clockName` tells this node's monotonic clock from those of its other lives. `wake` makes the gateway's
    // thread call Service soon; called on any thread. Without `handlers` all handlers are called on the
    // threads above.
    LinkDriver(const GatewayConfig &config, RabitWorkspace &workspace, IncarnationStore &incarnations,
               std::uint64_t clockName, std::function<void()> wake, RabitHandlerThread *handlers = nullptr);
    ~LinkDriver();

    // The present life of this node.
    std::uint64_t Incarnation() const;
    // What is to be done with frames that begin with that byte, which is no version of the links: called on
    // the transport's threads, with the node that has written it. Before Open.
    using OtherFrames = std::function<void(std::string_view node, std::span<const std::uint8_t> frame)>;
    void SetOtherFrames(std::uint8_t firstByte, OtherFrames take);
    // Sends such a frame to that node alone; gateway's thread only. A loss is for who asked to notice.
    void SendOther(const std::string &node, std::span<const std::uint8_t> frame);
    // Starts to receive, and keeps the session for writing until Close. Throws TransportError.
    void Open(TransportSession &session);
    // Sends nothing more and receives nothing more. What has no outcome yet gets one. For good.
    void Close();

    // Does what is due and writes it. Returns when to call again at the latest. Gateway's thread only.
    Duration Service();

    // In place of Service, for a scheduler that decides what goes out next; gateway's thread only.
    //
    // Does what is due but sending. Returns when something is due next, if nothing comes before: not later
    // than now if something could be sent. The gateway's thread is woken for whatever comes after this call
    // and before WillServe, and after that for what is due before the time that it says.
    Duration Advance();
    void VisitStreams(std::size_t most, const std::function<void(const LinkStream &)> &visit) const;
    // Writes one datagram, made now, of at most so many bytes on the air as LinkNode::SendOne has it. Returns
    // whether there was one.
    bool SendOne(std::string_view destination, std::string_view queue, std::size_t most);
    void WillServe(Duration at);
    // How late the frames of other nodes come, where that is worth telling them (DelayMeter); one datagram is
    // told once. The name is valid during the call.
    bool HasDelays() const { return _anyDelays; }
    void TakeDelays(
        Duration now,
        const std::function<void(const std::string &node, Duration delay, Duration arrivedAt)> &take);
    void VisitPaths(const std::function<void(std::string_view node, const LinkPathState &)> &visit) const;
    // To that node and back, with nothing waiting; 0: not known.
    Duration ShortestRoundTrip(std::string_view node) const;

    // A node is in that life. The links may learn it later, and send what is accepted meanwhile to the life
    // before, which puts it in doubt.
    void HeardOf(const std::string &node, std::uint64_t incarnation);

    // Accepts a message for a queue of another node; the receipt (null: nobody wants to know), which has had
    // its Begin, gets the outcome. False: refused, because the link is full or there are too many; the
    // receipt gets nothing. Any thread.
    bool Enqueue(const std::string &node, const std::string &queue, const std::string &type,
                 const LinkPayload &payload, const Receipt &receipt);

    // Whether messages for that node wait here.
    bool HasPending(const std::string &node) const;
    // The node is remembered no longer. Gateway's thread only.
    void Forget(const std::string &node);
    // What was refused or dropped because too many nodes or links are known.
    std::uint64_t CrowdedOut() const;

    std::vector<Gateway::LinkStatus> OutboundStatus() const;
    std::vector<Gateway::InboundStatus> InboundStatus() const;
    std::vector<Gateway::Problem> Problems() const;
    std::uint64_t Malformed() const;

private:
    // LinkOutput; called by LinkNode with the mutex held.
    void Send(const LinkFrame &frame) override;
    void OnOutcome(std::uint64_t id, std::string_view destination, std::string_view queue,
                   LinkOutcome outcome) override;

    // What became of a message.
    struct Outcome
    {
        std::string Node, Queue;
        std::uint64_t Id = 0;
        QueueOutcome What = QueueOutcome::Pending;
    };
    // What somebody outside is to be told once the mutex is free.
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

    // The calling thread's own, empty, with the memory that it had. For the threads of the transport and of
    // the gateway; not for managers, which are called while it is read.
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
    // The same: what came and what became of messages, before anybody else is told.
    void TellTap();

    // Handler of the transport.
    void OnFrame(SampleBytes bytes, const SampleInfo &info);
    // Without the mutex: decodes the large messages that are complete, and has the links deliver them. For
    // threads that may take that long; every call of the links that may complete a message comes before one.
    void DecodeLarge(News &news);
    void MakeWriter();
    // Writes what the links have sent; without the mutex.
    void WriteOut();
    LinkTime Now() const { return _workspace.GetClock().Monotonic(); }

    const GatewayConfig &_config;
    RabitWorkspace &_workspace;
    IncarnationStore &_incarnations;
    const std::function<void()> _wake;
    RabitHandlerThread *const _handlers;

    mutable std::mutex _mutex;
    IncomingQueues _incoming;                              // guarded, but for Decode
    std::unordered_map<std::uint64_t, Receipt> _receipts;  // of messages without an outcome, by their ids
    std::vector<std::pair<Receipt, QueueOutcome>> _settled;
    std::vector<Outcome> _outcomes;  // for the tap
    LinkDatagrams _outbox;
    std::unique_ptr<LinkNode> _links;
    LinkTime _nextService{0};  // when the gateway's thread will call Service at the latest

    std::uint8_t _otherByte = LinkVersion;
    OtherFrames _otherFrames;

    DelayMeter _delays;
    std::atomic<bool> _anyDelays{false};  // changed with the mutex held
    LinkVersions _versions;
    std::atomic<std::uint64_t> _malformed{0};

    LinkDatagrams _sending;  // gateway's thread only
    TransportSession *_session = nullptr;
    // One for all nodes, made when the node has a use for it: each endpoint of DDS costs all others
    // discovery.
    std::unique_ptr<TransportWriter> _writer;
    std::unique_ptr<TransportReader> _reader;
};

}  // namespace Rabit
