#pragma once

#include <rabit/QueueForwarder.h>
#include <rabit/RabitQueueReceipt.h>
#include <rabit/RabitWorkspace.h>
#include <rabit/gateway/GatewayConfig.h>
#include <rabit/gateway/links/LinkNode.h>
#include <rabit/transport/Transport.h>

#include <atomic>
#include <chrono>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <set>
#include <string>
#include <unordered_map>
#include <utility>
#include <vector>

#include "gateway.idl.h"
#include "incarnation/IncarnationStore.h"
#include "presence/RemoteQueues.h"
#include "queues/AcceptedQueue.h"
#include "queues/LinkDatagrams.h"
#include "queues/LinkPayloadPool.h"
#include "queues/LinkRefusals.h"

namespace Rabit
{

// Joins the queue links (LinkNode, which does no I/O) to the workspace and to the transport.
//
// Threads: any manager's thread calls Forward; the transport's threads hand in what arrives and put it
// straight into the local queues; only the gateway's thread, in Service, writes to the network. One mutex
// guards the links; while it is held no handler of a queue and nothing of the transport is called, so that a
// slow network or a handler that sends again delays nobody.
class LinkDriver final : public QueueForwarder, private LocalQueues, private LinkOutput
{
public:
    using Duration = std::chrono::nanoseconds;

    // All references must outlive the object, and nobody else may use the incarnations. `clockName` tells
    // this node's monotonic clock from those of its other lives. `wake` makes the gateway's thread call
    // Service soon; called on any thread.
    LinkDriver(const GatewayConfig &config, RabitWorkspace &workspace, const RemoteQueues &remote,
               IncarnationStore &incarnations, std::uint64_t clockName, std::function<void()> wake);
    ~LinkDriver() override;

    // The present life of this node.
    std::uint64_t Incarnation() const;
    // Starts to receive, and keeps the session for writing until Close. Throws TransportError.
    void Open(TransportSession &session);
    // Sends nothing more and receives nothing more. What has no outcome yet gets one. For good.
    void Close();

    // Does what is due and writes it. Returns when to call again at the latest. Gateway's thread only.
    Duration Service();

    // A node is in that life. The links may learn it later, and send what is accepted meanwhile to the life
    // before, which puts it in doubt.
    void HeardOf(const std::string &node, std::uint64_t incarnation);

    bool Handles(const std::string &queueName) const override;
    bool Forward(const std::string &queueName, const std::shared_ptr<RabitMessage> &message,
                 const std::shared_ptr<RabitQueueReceipt> &receipt) override;

    std::vector<Gateway::LinkStatus> OutboundStatus() const;
    std::vector<Gateway::InboundStatus> InboundStatus() const;
    std::vector<Gateway::Problem> Problems() const;
    std::uint64_t Malformed() const;

private:
    // LocalQueues; called by LinkNode with the mutex held.
    LocalQueueResult Deliver(std::string_view source, std::string_view queue, std::string_view type,
                             std::span<const std::uint8_t> payload, bool redelivered) override;
    std::size_t Room(std::string_view queue) const override;
    // LinkOutput; called by LinkNode with the mutex held.
    void Send(const LinkData &data) override;
    void Send(const LinkAck &ack) override;
    void Send(const LinkHello &hello) override;
    void OnOutcome(std::uint64_t id, std::string_view destination, std::string_view queue,
                   LinkOutcome outcome) override;

    using Receipt = std::shared_ptr<RabitQueueReceipt>;

    // What somebody outside is to be told once the mutex is free.
    struct News
    {
        std::vector<AcceptedQueue *> Delivered;                 // queues with new messages
        std::vector<std::pair<Receipt, QueueOutcome>> Settled;  // receipts with an outcome

        bool IsEmpty() const { return Delivered.empty() && Settled.empty(); }
        void Clear()
        {
            Delivered.clear();
            Settled.clear();
        }
    };

    // The receipt has had its Begin for this message.
    bool ForwardTo(const std::string &node, const std::string &queue, const MessageType &type,
                   const LinkPayload &payload, const Receipt &receipt);
    bool ForwardToAll(const std::string &queue, const MessageType &type, const LinkPayload &payload,
                      const Receipt &receipt);
    // These return false.
    bool Refuse(const std::string &node, const std::string &queue, QueueAcceptance verdict,
                const std::string &reason, const Receipt &receipt);
    static bool Settle(const Receipt &receipt, QueueOutcome outcome);
    // The calling thread's own, empty, with the memory that it had. For the threads of the transport and of
    // the gateway; not for managers, which are called while it is read.
    static News &OwnNews();
    // With the mutex held.
    News TakeNews() { return _news.IsEmpty() ? News() : std::exchange(_news, {}); }
    // With the mutex held: something is due then. True if the gateway's thread must be woken for it: it would
    // come later, and was not woken for anything as early.
    bool ServeBy(LinkTime due);
    // Without the mutex.
    static void Tell(const News &news);
    void ConfigureOnce(const std::string &node, const std::string &queue);
    LinkPayload Encode(const MessageType &type, const RabitMessage &message) const;

    // Handlers of the transport, and what they have in common.
    void OnData(SampleBytes bytes);
    template <typename Sample, typename View, void (LinkNode::*Input)(const View &, LinkTime)>
    void OnSample(SampleBytes bytes);
    template <typename View, void (LinkNode::*Input)(const View &, LinkTime)>
    void TakeIn(const View &view);
    void FindLocalQueues();
    LinkTime Now() const { return _workspace.GetClock().Monotonic(); }

    const GatewayConfig &_config;
    RabitWorkspace &_workspace;
    const RemoteQueues &_remote;
    IncarnationStore &_incarnations;  // guarded by the mutex
    const std::function<void()> _wake;
    const std::shared_ptr<LinkPayloadPool> _payloads = std::make_shared<LinkPayloadPool>();

    mutable std::mutex _mutex;
    std::map<std::string, AcceptedQueue, std::less<>> _accepted;
    std::unordered_map<std::uint64_t, Receipt> _receipts;  // of messages without an outcome, by their ids
    News _news;
    LinkDatagrams _outbox;
    LinkRefusals _refusals;
    std::map<std::string, std::set<std::string>> _configured;  // queues of a node
    std::unique_ptr<LinkNode> _links;
    LinkTime _nextService{0};  // when the gateway's thread will call Service at the latest

    std::atomic<std::uint64_t> _malformed{0};

    LinkDatagrams _sending;  // gateway's thread only
    std::unique_ptr<LinkWriters> _writers;
    std::vector<std::unique_ptr<TransportReader>> _readers;
};

}  // namespace Rabit
