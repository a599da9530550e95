#include "queues/LinkDriver.h"

#include <algorithm>
#include <utility>

#include "names/TypeDefinition.h"
#include "queues/LinkStatus.h"
#include "queues/SendOptions.h"
#include "wire/LinkSampleCodec.h"
#include "wire/LinkTopics.h"

namespace Rabit
{
namespace
{

LinkSettings SettingsOf(const GatewayConfig &config, std::uint64_t clockName)
{
    LinkSettings settings;
    settings.Node = config.Node;
    settings.Clock = std::max<std::uint64_t>(clockName, 1);  // 0 is no name
    settings.MaxDatagram = LargestLinkFrameOf(config);
    settings.LargestMessage = LargestSample;
    return settings;
}

// Names the handlers of receipts for people.
const std::string OfReceipt = "a receipt";

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

LinkDriver::LinkDriver(const GatewayConfig &config, RabitWorkspace &workspace, IncarnationStore &incarnations,
                       std::uint64_t clockName, std::function<void()> wake, RabitHandlerThread *handlers)
    : _config(config),
      _workspace(workspace),
      _incarnations(incarnations),
      _wake(std::move(wake)),
      _handlers(handlers),
      _incoming(config.Accept, workspace, _wake, IncomingQueues::QuicklyDecoded, config.Tap != nullptr),
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

void LinkDriver::AddOtherFrames(std::size_t path, std::uint8_t firstByte, OtherFrames take)
{
    WayOf(path).Others.emplace_back(firstByte, std::move(take));
}

LinkDriver::Way &LinkDriver::WayOf(std::size_t path)
{
    while (_ways.size() <= path)
    {
        _ways.push_back(std::make_unique<Way>());
        _ways.back()->Number = _ways.size() - 1;
    }
    return *_ways[path];
}

void LinkDriver::Open(TransportSession &session)
{
    const std::size_t path = _open++;
    Way &way = WayOf(path);
    way.Session = &session;
    // So that the first message need not wait until the nodes have heard of the writer.
    if (!_config.Accept.empty() || !_config.Send.empty() || _config.Agreement)
    {
        WriterOf(path);
    }
    way.Reader = session.CreateReader(DescribeLinkTopic(), LinkTopicQos(), {},
                                      [this, &way](SampleBytes bytes, const SampleInfo &info)
                                      {
                                          if (info.Alive)
                                          {
                                              OnFrame(bytes, info, way);
                                          }
                                      });
}

void LinkDriver::Close()
{
    for (const std::unique_ptr<Way> &way : _ways)
    {
        way->Reader.reset();
        way->Writer.reset();
        way->Session = nullptr;
    }
    News news;
    {
        const std::lock_guard lock(_mutex);
        _links->Close();
        TakeNews(news);
    }
    Tell(news);
}

std::vector<std::string> LinkDriver::Unanswered() const
{
    const std::lock_guard lock(_mutex);
    std::vector<std::string> nodes;
    _links->VisitUnanswered(Now(), [&nodes](std::string_view node) { nodes.emplace_back(node); });
    return nodes;
}

void LinkDriver::ProbeNow(const std::string &node)
{
    const std::lock_guard lock(_mutex);
    _links->ProbeNow(node, Now());
}

void LinkDriver::PathChanged(const std::string &node)
{
    const std::lock_guard lock(_mutex);
    _links->PathChanged(node, Now());
}

LinkDriver::News &LinkDriver::OwnNews()
{
    static thread_local News news;
    return news;
}

void LinkDriver::TakeNews(News &news)
{
    // Skipped if there is nothing: the swap would replace lists that have memory by lists that have none.
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

void LinkDriver::TellAll(const News &news)
{
    if (_config.Tap)
    {
        TellTap();
    }
    for (const auto &queue : news.Delivered)
    {
        const RabitHandlerThread::Scope scope(_handlers, queue->Name(), queue);
        queue->NotifyEnqueued();
    }
    for (const auto &[receipt, outcome] : news.Settled)
    {
        const RabitHandlerThread::Scope scope(_handlers, OfReceipt, receipt);
        receipt->Settle(outcome);
    }
}

void LinkDriver::TellTap()
{
    std::vector<IncomingQueues::Received> received;
    std::vector<Outcome> outcomes;
    {
        const std::lock_guard lock(_mutex);
        _incoming.TakeReceived(received);
        outcomes.swap(_outcomes);
    }
    for (const IncomingQueues::Received &message : received)
    {
        _config.Tap->Received({message.Source, message.Queue, message.Type, 0, message.Payload->View()});
    }
    for (const Outcome &outcome : outcomes)
    {
        _config.Tap->Settled(outcome.Node, outcome.Queue, outcome.Id, outcome.What);
    }
}

void LinkDriver::VisitPaths(const std::function<void(std::string_view, const LinkPathState &)> &visit) const
{
    const std::lock_guard lock(_mutex);
    _links->VisitPaths(visit);
}

LinkDriver::Duration LinkDriver::ShortestRoundTrip(std::string_view node) const
{
    const std::lock_guard lock(_mutex);
    return _links->ShortestRoundTrip(node);
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
    const std::lock_guard lock(_mutex);
    _came.erase(node);
    // Not if something was enqueued for it at this moment.
    static_cast<void>(_links->Forget(node));
}

void LinkDriver::SetExpiry(const std::string &node, const std::string &queue,
                           std::chrono::milliseconds expire)
{
    const std::lock_guard lock(_mutex);
    _expiries.insert(_expiries.begin(), {.To = node, .Queue = queue, .Expire = expire});
}

LinkRefusal LinkDriver::Enqueue(const std::string &node, const std::string &queue, const std::string &type,
                                const LinkPayload &payload, const Receipt &receipt)
{
    LinkEnqueued enqueued;
    bool sooner = false;
    News news;
    {
        const std::lock_guard lock(_mutex);
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
    if (_config.Tap && enqueued.Accepted())
    {
        _config.Tap->Sent({node, queue, SplitLinkTypeName(type).Type, enqueued.Id, payload->View()});
    }
    Tell(news);  // accepting a message may reveal that others have expired
    if (sooner)
    {
        _wake();
    }
    return enqueued.Refusal;
}

void LinkDriver::Send(const LinkFrame &frame, std::string_view queue)
{
    // A gateway with one path has no use for the queue of a frame.
    _outbox.Add(frame, _second.Choose ? queue : frame.HasData ? frame.Data.Queue : "");
}

// Frames with messages of class bulk never go by a second path.
bool LinkDriver::SendsAcksAlone(std::string_view destination) const
{
    return _second.TakesAnswers && _second.TakesAnswers(destination);
}

LinkOptions LinkDriver::OptionsOf(std::string_view destination, std::string_view queue) const
{
    LinkOptions options = SendOptions(_config.Send, destination, queue);
    if (const SendRule *expiry = FindSendRule(_expiries, destination, queue))
    {
        options.Expire = expiry->Expire;
    }
    return options;
}

void LinkDriver::OnRefusedThere(std::string_view destination, std::string_view queue, std::string_view type)
{
    auto refused = std::find_if(_refused.begin(), _refused.end(),
                                [destination, queue](const Refused &known)
                                { return known.Node == destination && known.Queue == queue; });
    if (refused == _refused.end() && _refused.size() < MostRefused)
    {
        refused = _refused.insert(refused, {std::string(destination), std::string(queue), {}});
    }
    if (refused != _refused.end())
    {
        refused->Type = type;
    }
}

std::vector<LinkDriver::Refused> LinkDriver::TakeRefusedThere()
{
    const std::lock_guard lock(_mutex);
    return std::exchange(_refused, {});
}

void LinkDriver::OnOutcome(std::uint64_t id, std::string_view destination, std::string_view queue,
                           LinkOutcome outcome)
{
    if (_config.Tap)
    {
        _outcomes.push_back({std::string(destination), std::string(queue), id, OutcomeOf(outcome)});
    }
    // LinkNode counts outcomes by link; only messages with a receipt matter here.
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
    return LinkStatus::Inbound(*_links);
}

std::vector<Gateway::Problem> LinkDriver::Problems() const
{
    const std::string storeError = _incarnations.Error();
    const std::lock_guard lock(_mutex);
    std::vector<Gateway::Problem> problems = _incoming.Problems();
    for (Gateway::Problem &problem : _recent.Problems(Now()))
    {
        problems.push_back(std::move(problem));
    }
    if (!storeError.empty())
    {
        problems.push_back({"state_dir " + _config.StateDir, "", storeError});
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
