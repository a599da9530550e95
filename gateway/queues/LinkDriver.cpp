#include "queues/LinkDriver.h"

#include <algorithm>

#include "clocks/GpsTime.h"
#include "names/NamePattern.h"
#include "queues/LinkStatus.h"
#include "queues/SendOptions.h"
#include "wire/GatewayTopics.h"
#include "wire/LinkDataCodec.h"
#include "wire/LinkWire.h"

namespace Rabit
{
namespace
{

// What the encapsulation and RTPS headers take of a datagram.
constexpr std::size_t DatagramOverhead = 100;
// A datagram up to this size is decoded while the links are locked: a few microseconds, and less than it
// costs to keep what was decoded before.
constexpr std::size_t QuicklyDecoded = 4096;

LinkSettings SettingsOf(const GatewayConfig &config, std::uint64_t clockName)
{
    LinkSettings settings;
    settings.Node = config.Node;
    settings.Clock = std::max<std::uint64_t>(clockName, 1);  // 0 is no name
    settings.MaxDatagram =
        config.MaxDatagram > 2 * DatagramOverhead ? config.MaxDatagram - DatagramOverhead : DatagramOverhead;
    return settings;
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

// Who sends the datagram: an acknowledgement goes back to the source of the messages.
std::string_view SenderOf(const LinkData &data)
{
    return data.Source;
}
std::string_view SenderOf(const LinkAck &ack)
{
    return ack.Destination;
}
std::string_view SenderOf(const LinkHello &hello)
{
    return hello.Source;
}

// Whether the sender's name and a queue that may be new are such as a configuration can have: the answer goes
// to the partition that is called like the sender, and `*` is everybody's. The links compare the other names
// with those that they know.
template <typename View>
bool HasNames(const View &view)
{
    return IsNodeName(SenderOf(view));
}
bool HasNames(const LinkData &data)
{
    return IsNodeName(data.Source) && IsMessageName(data.Queue);
}

}  // namespace

LinkDriver::LinkDriver(const GatewayConfig &config, RabitWorkspace &workspace, IncarnationStore &incarnations,
                       SenderCheck &senders, std::uint64_t clockName, std::function<void()> wake)
    : _config(config),
      _workspace(workspace),
      _incarnations(incarnations),
      _senders(senders),
      _wake(std::move(wake)),
      _incoming(config.Accept, workspace, _wake),
      _links(std::make_unique<LinkNode>(SettingsOf(config, clockName), static_cast<LinkOutput &>(*this),
                                        static_cast<LocalQueues &>(_incoming), incarnations))
{
    _incarnations.Save();
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
    const auto open =
        [this, &session, &own](LinkTopic topic, void (LinkDriver::*input)(SampleBytes, const SampleInfo &))
    {
        _readers.push_back(session.CreateReader(DescribeLinkTopic(topic), LinkTopicQos(topic), own,
                                                [this, input](SampleBytes bytes, const SampleInfo &info)
                                                {
                                                    if (info.Alive)
                                                    {
                                                        (this->*input)(bytes, info);
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
        TakeNews(news);
    }
    Tell(news);
}

// Views and news are one for each thread of the transport, so that steady traffic allocates nothing for names
// and lists.

void LinkDriver::OnData(SampleBytes bytes, const SampleInfo &info)
{
    static thread_local LinkData view;
    static thread_local IncomingQueues::DecodedMessages messages;
    if (!LinkDataCodec::Decode(bytes, view))
    {
        ++_malformed;
        return;
    }
    if (IsFromItsSender(view, info))
    {
        if (bytes.size() > QuicklyDecoded)
        {
            _incoming.Decode(view, messages);
        }
        TakeIn<LinkData, &LinkNode::OnData>(view, messages);
    }
    messages.clear();
    view.Items.clear();  // they point to bytes that are only borrowed
}

template <typename Sample, typename View, void (LinkNode::*Input)(const View &, LinkTime)>
void LinkDriver::OnSample(SampleBytes bytes, const SampleInfo &info)
{
    static thread_local Sample sample;
    static thread_local View view;
    if (!GatewayTopics::TypeOf<Sample>().Deserialize(bytes, sample))
    {
        ++_malformed;
        return;
    }
    LinkWire::FromSample(sample, view);
    if (IsFromItsSender(view, info))
    {
        TakeIn<View, Input>(view);
    }
}

template <typename View>
bool LinkDriver::IsFromItsSender(const View &view, const SampleInfo &info)
{
    if (!HasNames(view))
    {
        ++_malformed;
        return false;
    }
    return _senders.MaySpeakFor(info.Node, SenderOf(view), Now());
}

template <typename View, void (LinkNode::*Input)(const View &, LinkTime)>
void LinkDriver::TakeIn(const View &view, std::span<const IncomingQueues::Decoded> messages)
{
    News &news = OwnNews();
    bool sooner = false;
    {
        const std::lock_guard lock(_mutex);
        _incoming.Offer(messages);
        (_links.get()->*Input)(view, Now());
        _incoming.Offer({});
        sooner = ServeBy(_outbox.IsEmpty() ? _links->NextDue() : LinkTime(0));
        TakeNews(news);
    }
    Tell(news);
    news.Clear();
    if (sooner)
    {
        _wake();
    }
}

LinkDriver::News &LinkDriver::OwnNews()
{
    static thread_local News news;
    return news;
}

void LinkDriver::TakeNews(News &news)
{
    // Not when there is nothing: the lists would lose their memory to lists that have none.
    if (_incoming.AnyDelivered())
    {
        _incoming.TakeDelivered(news.Delivered);
    }
    if (!_settled.empty())
    {
        news.Settled.swap(_settled);
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
    for (const auto &queue : news.Delivered)
    {
        queue->NotifyEnqueued();
    }
    for (const auto &[receipt, outcome] : news.Settled)
    {
        receipt->Settle(outcome);
    }
}

LinkDriver::Duration LinkDriver::Service()
{
    LinkTime next = LinkNever;
    News &news = OwnNews();
    {
        const std::lock_guard lock(_mutex);
        _incoming.Find([this](const std::string &queue) { _links->OnRoom(queue, Now()); });
        _links->Run(Now());
        _sending.Swap(_outbox);
        next = _nextService = _links->NextDue();
        TakeNews(news);
    }
    Tell(news);
    news.Clear();
    // What is sent now may tell of a new life.
    _incarnations.Save();
    const std::int64_t sourceTime = GpsTime::ToUtcNanoseconds(_workspace.GetClock().GpsTimeSeconds());
    _sending.BindNames();
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
        TakeNews(news);
    }
    Tell(news);
}

bool LinkDriver::HasPending(const std::string &node) const
{
    const std::lock_guard lock(_mutex);
    return _links->HasPending(node);
}

void LinkDriver::Forget(const std::string &node)
{
    {
        const std::lock_guard lock(_mutex);
        if (!_links->Forget(node))
        {
            return;  // something was enqueued for it at this moment
        }
    }
    if (_writers)
    {
        _writers->Forget(node);
    }
}

bool LinkDriver::Enqueue(const std::string &node, const std::string &queue, const std::string &type,
                         const LinkPayload &payload, const Receipt &receipt)
{
    LinkEnqueued enqueued;
    bool sooner = false;
    News news;
    {
        const std::lock_guard lock(_mutex);
        if (!_links->HasLinkTo(node, queue))
        {
            _links->Configure(node, queue, SendOptions(_config.Send, node, queue), Now());
        }
        enqueued = _links->Enqueue(node, queue, type, payload, Now());
        if (enqueued.Accepted())
        {
            if (receipt)
            {
                _receipts.emplace(enqueued.Id, receipt);
            }
            sooner = ServeBy(enqueued.Due);
        }
        TakeNews(news);
    }
    Tell(news);  // to accept one may mean to find that others have expired
    if (sooner)
    {
        _wake();
    }
    return enqueued.Accepted();
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
        _settled.emplace_back(std::move(found->second), OutcomeOf(outcome));
        _receipts.erase(found);
    }
}

std::vector<Gateway::LinkStatus> LinkDriver::OutboundStatus() const
{
    const std::lock_guard lock(_mutex);
    return LinkStatus::Outbound(*_links);
}

std::vector<Gateway::InboundStatus> LinkDriver::InboundStatus() const
{
    const std::lock_guard lock(_mutex);
    return LinkStatus::Inbound(*_links, _incoming);
}

std::vector<Gateway::Problem> LinkDriver::Problems() const
{
    const std::string storeError = _incarnations.Error();
    const std::lock_guard lock(_mutex);
    std::vector<Gateway::Problem> problems = _incoming.Problems();
    if (!storeError.empty())
    {
        Gateway::Problem problem;
        problem.subject = "state_dir " + _config.StateDir;
        problem.reason = storeError;
        problems.push_back(problem);
    }
    if (_links->NameInUseElsewhere())
    {
        Gateway::Problem problem;
        problem.subject = "node " + _config.Node;
        problem.reason =
            "the incarnation of this node had to be raised again and again: another live node must have this "
            "name";
        problems.push_back(problem);
    }
    return problems;
}

std::uint64_t LinkDriver::CrowdedOut() const
{
    const std::lock_guard lock(_mutex);
    const LinkNodeCounters counters = _links->Counters();
    return counters.TooManyPeers + counters.TooManyLinks + counters.RefusedTooMany;
}

std::uint64_t LinkDriver::Malformed() const
{
    const std::lock_guard lock(_mutex);
    return _malformed + _links->Counters().Malformed + _links->Counters().NotForUs;
}

}  // namespace Rabit
