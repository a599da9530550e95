#include "queues/LinkDriver.h"


#include <algorithm>

#include "clocks/GpsTime.h"
#include "wire/GatewayTopics.h"
#include "wire/LinkDataCodec.h"
#include "wire/LinkWire.h"

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
    News &news = OwnNews();
    bool sooner = false;
    {
        const std::lock_guard lock(_mutex);
        (_links.get()->*Input)(view, Now());
        sooner = ServeBy(_outbox.IsEmpty() ? _links->NextDue() : LinkTime(0));
        std::swap(news, _news);
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
    News &news = OwnNews();
    {
        const std::lock_guard lock(_mutex);
        FindLocalQueues();
        _links->Run(Now());
        _sending.Swap(_outbox);
        next = _nextService = _links->NextDue();
        std::swap(news, _news);
    }
    Tell(news);
    news.Clear();
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

}  // namespace Rabit
