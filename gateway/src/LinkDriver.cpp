#include "LinkDriver.h"

#include <rabit/RabitLog.h>
#include <rabit/idl/MessageTypeRegistry.h>

#include <algorithm>

#include "GatewayTopics.h"
#include "GpsTime.h"
#include "LinkDataCodec.h"
#include "LinkWire.h"
#include "NamePattern.h"
#include "TypeDefinition.h"

namespace Rabit
{
namespace
{

// What the encapsulation and RTPS headers take of a datagram.
constexpr std::size_t DatagramOverhead = 100;

LinkSettings SettingsOf(const GatewayConfig &config, std::uint64_t clockName)
{
    LinkSettings settings;
    settings.Node = config.Node;
    settings.Clock = std::max<std::uint64_t>(clockName, 1);  // 0 is no name
    settings.MaxDatagram =
        config.MaxDatagram > 2 * DatagramOverhead ? config.MaxDatagram - DatagramOverhead : DatagramOverhead;
    return settings;
}

LinkOptions OptionsOf(const SendRule &rule)
{
    LinkOptions options;
    options.Capacity = rule.Capacity;
    options.CapacityBytes = rule.CapacityBytes;
    options.Expire = rule.Expire;
    options.Window = rule.Window;
    options.RedeliverInDoubt = rule.RedeliverInDoubt;
    return options;
}

QueueOutcome OutcomeOf(LinkOutcome outcome)
{
    switch (outcome)
    {
        case LinkOutcome::Delivered:
            return QueueOutcome::Delivered;
        case LinkOutcome::Expired:
            return QueueOutcome::Expired;
        case LinkOutcome::RefusedThere:
            return QueueOutcome::Refused;
        case LinkOutcome::InDoubt:
            break;
    }
    return QueueOutcome::InDoubt;
}

void Begin(const std::shared_ptr<RabitQueueReceipt> &receipt, std::size_t messages)
{
    if (receipt)
    {
        receipt->Begin(static_cast<std::uint32_t>(messages));
    }
}

}  // namespace

LinkDriver::LinkDriver(const GatewayConfig &config, RabitWorkspace &workspace, const RemoteQueues &remote,
                       IncarnationStore &incarnations, std::uint64_t clockName, std::function<void()> wake)
    : _config(config),
      _workspace(workspace),
      _remote(remote),
      _incarnations(incarnations),
      _wake(std::move(wake))
{
    for (const AcceptRule &rule : config.Accept)
    {
        _accepted.try_emplace(rule.Queue, rule, workspace, _wake);
    }
    _links = std::make_unique<LinkNode>(SettingsOf(config, clockName), static_cast<LinkOutput &>(*this),
                                        static_cast<LocalQueues &>(*this), incarnations);
    if (!_incarnations.Error().empty())
    {
        RabitLog::Write(RabitLogLevel::Warning, "gateway: " + _incarnations.Error());
    }
}

LinkDriver::~LinkDriver()
{
    Close();
}

std::uint64_t LinkDriver::Incarnation() const
{
    const std::lock_guard lock(_mutex);
    return _links->Incarnation();
}

void LinkDriver::Open(TransportSession &session)
{
    _writers = std::make_unique<LinkWriters>(session);
    const std::vector<std::string> own = {_config.Node};
    const auto open = [this, &session, &own](LinkTopic topic, void (LinkDriver::*input)(SampleBytes))
    {
        _readers.push_back(session.CreateReader(DescribeLinkTopic(topic), LinkTopicQos(topic), own,
                                                [this, input](SampleBytes bytes, const SampleInfo &info)
                                                {
                                                    if (info.Alive)
                                                    {
                                                        (this->*input)(bytes);
                                                    }
                                                }));
    };
    open(LinkTopic::Data, &LinkDriver::OnData);
    open(LinkTopic::Ack, &LinkDriver::OnSample<Gateway::LinkAckSample, LinkAck, &LinkNode::OnAck>);
    open(LinkTopic::Hello, &LinkDriver::OnSample<Gateway::LinkHelloSample, LinkHello, &LinkNode::OnHello>);
}

void LinkDriver::Close()
{
    _readers.clear();
    _writers.reset();
    News news;
    {
        const std::lock_guard lock(_mutex);
        _links->Close();
        news = TakeNews();
    }
    Tell(news);
}

// Views and news are one for each thread of the transport, so that steady traffic allocates nothing for names
// and lists.

void LinkDriver::OnData(SampleBytes bytes)
{
    static thread_local LinkData view;
    if (!LinkDataCodec::Decode(bytes, view))
    {
        ++_malformed;
        return;
    }
    TakeIn<LinkData, &LinkNode::OnData>(view);
    view.Items.clear();  // they point to bytes that are only borrowed
}

template <typename Sample, typename View, void (LinkNode::*Input)(const View &, LinkTime)>
void LinkDriver::OnSample(SampleBytes bytes)
{
    static thread_local Sample sample;
    static thread_local View view;
    if (!GatewayTopics::TypeOf<Sample>().Deserialize(bytes, sample))
    {
        ++_malformed;
        return;
    }
    LinkWire::FromSample(sample, view);
    TakeIn<View, Input>(view);
}

template <typename View, void (LinkNode::*Input)(const View &, LinkTime)>
void LinkDriver::TakeIn(const View &view)
{
    static thread_local News news;
    bool sooner = false;
    {
        const std::lock_guard lock(_mutex);
        (_links.get()->*Input)(view, Now());
        sooner = ServeBy(_outbox.IsEmpty() ? _links->NextDue() : LinkTime(0));
        std::swap(news, _news);
    }
    Tell(news);
    news.Delivered.clear();
    news.Settled.clear();
    if (sooner)
    {
        _wake();
    }
}

bool LinkDriver::ServeBy(LinkTime due)
{
    if (due >= _nextService)
    {
        return false;
    }
    _nextService = due;
    return true;
}

void LinkDriver::Tell(const News &news)
{
    for (AcceptedQueue *queue : news.Delivered)
    {
        queue->Notify();
    }
    for (const auto &[receipt, outcome] : news.Settled)
    {
        Settle(receipt, outcome);
    }
}

bool LinkDriver::Settle(const Receipt &receipt, QueueOutcome outcome)
{
    if (receipt)
    {
        receipt->Settle(outcome);
    }
    return outcome == QueueOutcome::Delivered;
}

void LinkDriver::FindLocalQueues()
{
    for (auto &[name, queue] : _accepted)
    {
        const bool changed = queue.Find();
        if (queue.TakeRoomCame() || changed)
        {
            _links->OnRoom(name, Now());
        }
    }
}

LinkDriver::Duration LinkDriver::Service()
{
    LinkTime next = LinkNever;
    News news;
    {
        const std::lock_guard lock(_mutex);
        FindLocalQueues();
        _links->Run(Now());
        _sending.Swap(_outbox);
        next = _nextService = _links->NextDue();
        news = TakeNews();
    }
    Tell(news);
    const std::int64_t sourceTime = GpsTime::ToUtcNanoseconds(_workspace.GetClock().GpsTimeSeconds());
    for (const LinkDatagrams::Datagram &datagram : _sending)
    {
        if (_writers)
        {
            _writers->Write(datagram, sourceTime);
        }
    }
    _sending.Clear();
    return next;
}

void LinkDriver::HeardOf(const std::string &node, std::uint64_t incarnation)
{
    News news;
    {
        const std::lock_guard lock(_mutex);
        _links->HeardOf(node, incarnation, Now());
        news = TakeNews();
    }
    Tell(news);
}

LocalQueueResult LinkDriver::Deliver(std::string_view /*source*/, std::string_view queue,
                                     std::string_view type, std::span<const std::uint8_t> payload,
                                     bool redelivered)
{
    const auto found = _accepted.find(queue);
    if (found == _accepted.end())
    {
        return LocalQueueResult::Unknown;
    }
    const LocalQueueResult result = found->second.Deliver(type, payload, redelivered);
    if (result == LocalQueueResult::Ok &&
        std::find(_news.Delivered.begin(), _news.Delivered.end(), &found->second) == _news.Delivered.end())
    {
        _news.Delivered.push_back(&found->second);
    }
    return result;
}

std::size_t LinkDriver::Room(std::string_view queue) const
{
    const auto found = _accepted.find(queue);
    return found == _accepted.end() ? 1 : found->second.Room();
}

void LinkDriver::Send(const LinkData &data)
{
    _outbox.Add(data);
}

void LinkDriver::Send(const LinkAck &ack)
{
    static thread_local Gateway::LinkAckSample sample;
    LinkWire::ToSample(ack, sample);
    _outbox.Add(LinkTopic::Ack, ack.Source, GatewayTopics::TypeOf<Gateway::LinkAckSample>(), sample);
}

void LinkDriver::Send(const LinkHello &hello)
{
    static thread_local Gateway::LinkHelloSample sample;
    LinkWire::ToSample(hello, sample);
    _outbox.Add(LinkTopic::Hello, hello.Destination, GatewayTopics::TypeOf<Gateway::LinkHelloSample>(),
                sample);
}

void LinkDriver::OnOutcome(std::uint64_t id, std::string_view /*destination*/, std::string_view /*queue*/,
                           LinkOutcome outcome)
{
    // LinkNode counts them by link; here it is only about those that somebody wants to know of.
    const auto found = _receipts.find(id);
    if (found != _receipts.end())
    {
        _news.Settled.emplace_back(std::move(found->second), OutcomeOf(outcome));
        _receipts.erase(found);
    }
}

bool LinkDriver::Handles(const std::string &queueName) const
{
    return queueName.find('/') != std::string::npos;
}

LinkPayload LinkDriver::Encode(const MessageType &type, const RabitMessage &message) const
{
    const std::shared_ptr<LinkBytes> payload = _payloads->Make(type.SerializedSize(message));
    const bool encoded = type.Serialize(message, payload->Writable()) == payload->Size();
    return encoded ? payload : nullptr;
}

bool LinkDriver::Forward(const std::string &queueName, const std::shared_ptr<RabitMessage> &message,
                         const std::shared_ptr<RabitQueueReceipt> &receipt)
{
    const std::size_t slash = queueName.find('/');
    const std::string node = queueName.substr(0, slash);
    const std::string queue = queueName.substr(slash + 1);
    if (node == _config.Node)
    {
        const bool added = _workspace.DeliverToQueue(queue, message) == QueueAddResult::Ok;
        Begin(receipt, 1);
        return Settle(receipt, added ? QueueOutcome::Delivered : QueueOutcome::Refused);
    }
    const MessageType *type = MessageTypeRegistry::Of(*message);
    if (type == nullptr)
    {
        Begin(receipt, 1);
        return Refuse(node, queue, RemoteQueues::Verdict::WrongType,
                      "the message is of a type that was not made from IDL", receipt);
    }
    const LinkPayload payload = Encode(*type, *message);
    if (!payload)
    {
        Begin(receipt, 1);
        return Refuse(node, queue, RemoteQueues::Verdict::WrongType,
                      "the message does not fit its IDL type `" + type->Name() +
                          "`: a bounded string or sequence is too long",
                      receipt);
    }
    if (node == "*")
    {
        return ForwardToAll(queue, *type, payload, receipt);
    }
    Begin(receipt, 1);
    return ForwardTo(node, queue, *type, payload, receipt);
}

bool LinkDriver::ForwardToAll(const std::string &queue, const MessageType &type, const LinkPayload &payload,
                              const Receipt &receipt)
{
    const std::vector<std::string> nodes =
        _remote.LiveNodesAccepting(queue, type.Name(), DefinitionHash(type));
    if (nodes.empty())
    {
        Begin(receipt, 1);
        return Refuse("*", queue, RemoteQueues::Verdict::UnknownNode,
                      "no live node accepts `" + type.Name() + "` for `" + queue + "`", receipt);
    }
    {
        const std::lock_guard lock(_mutex);
        _refusals.Forgive({"*", queue});
    }
    Begin(receipt, nodes.size());
    bool all = true;
    for (const std::string &node : nodes)
    {
        all = ForwardTo(node, queue, type, payload, receipt) && all;
    }
    return all;
}

bool LinkDriver::ForwardTo(const std::string &node, const std::string &queue, const MessageType &type,
                           const LinkPayload &payload, const Receipt &receipt)
{
    const RemoteQueues::Answer answer = _remote.Ask(node, queue, type.Name(), DefinitionHash(type));
    if (answer.What != RemoteQueues::Verdict::Accepted)
    {
        return Refuse(node, queue, answer.What, answer.Reason, receipt);
    }
    LinkEnqueued enqueued;
    bool sooner = false;
    News news;
    {
        const std::lock_guard lock(_mutex);
        ConfigureOnce(node, queue);
        enqueued = _links->Enqueue(node, queue, type.Name(), payload, Now());
        if (enqueued.Accepted())
        {
            _refusals.Forgive({node, queue});
            if (receipt)
            {
                _receipts.emplace(enqueued.Id, receipt);
            }
            sooner = ServeBy(enqueued.Due);
        }
        news = TakeNews();
    }
    Tell(news);  // to accept one may mean to find that others have expired
    if (!enqueued.Accepted())
    {
        return Settle(receipt, QueueOutcome::Refused);
    }
    if (sooner)
    {
        _wake();
    }
    return true;
}

void LinkDriver::ConfigureOnce(const std::string &node, const std::string &queue)
{
    std::set<std::string> &queues = _configured[node];
    if (queues.count(queue) > 0)
    {
        return;
    }
    queues.insert(queue);
    const auto rule = std::find_if(
        _config.Send.begin(), _config.Send.end(),
        [&node, &queue](const SendRule &candidate)
        { return MatchesPattern(candidate.To, node) && MatchesPattern(candidate.Queue, queue); });
    if (rule != _config.Send.end())
    {
        _links->Configure(node, queue, OptionsOf(*rule), Now());
    }
}

bool LinkDriver::Refuse(const std::string &node, const std::string &queue, RemoteQueues::Verdict verdict,
                        const std::string &reason, const Receipt &receipt)
{
    bool isNew = false;
    {
        const std::lock_guard lock(_mutex);
        isNew = _refusals.Add({node, queue}, verdict, reason);
    }
    if (isNew)
    {
        RabitLog::Write(RabitLogLevel::Warning,
                        "gateway: refused a message for `" + node + "/" + queue + "`: " + reason);
        _wake();
    }
    return Settle(receipt, QueueOutcome::Refused);
}

}  // namespace Rabit
