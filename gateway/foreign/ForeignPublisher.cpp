#include "foreign/ForeignPublisher.h"

#include <algorithm>
#include <utility>

#include "mirrors/GapOfRate.h"
#include "names/ForeignNames.h"
#include "wire/MessageEncoder.h"

namespace Rabit
{
namespace
{

std::unique_ptr<TransportWriter> MakeWriter(const ForeignRule &rule, const MessageType &type,
                                            TransportSession &session)
{
    TopicDescription topic{.Name = WireTopicOf(rule),
                           .TypeName = WireTypeOf(rule),
                           .KeyOf = {},
                           .TypeHash = WireHashOf(rule, type)};
    if (type.HasKey())
    {
        topic.KeyOf = [&type](SampleBytes bytes, KeyHash &key) { return type.KeyHashOf(bytes, key); };
    }
    return session.CreateWriter(topic, ForeignMatch::WriterQos(rule), {""});
}

}  // namespace

ForeignPublisher::ForeignPublisher(const ForeignRule &rule, const MessageType &type,
                                   ForeignMatch::Network network, const RabitWorkspace &workspace,
                                   const SourceClock &source, TransportSession &session, const AirCost &cost,
                                   std::shared_ptr<ForeignOutbox> outbox)
    : _rule(rule),
      _type(type),
      _network(std::move(network)),
      _workspace(workspace),
      _source(source),
      _session(session),
      _qos(ForeignMatch::WriterQos(rule)),
      _cost(cost),
      _writer(type, MakeWriter(rule, type, session)),
      _outbox(std::move(outbox)),
      _local(_outbox ? nullptr : type.CreateShared())
{
    _status.topic = WireTopicOf(rule);
    _status.type = WireTypeOf(rule);
    _status.local = rule.Local;
    _status.written = true;
    _status.state = Gateway::NodeState::UP;
    _status.qos = ForeignMatch::QosText(_qos.Reliability, _qos.Durability);
}

void ForeignPublisher::SetAttached()
{
    _global = _local->GetGlobalPublishSubscribeMessageRef().get();
    _posts.Begin(_global->GetNumberOfPosts());
}

ForeignPublisher::Duration ForeignPublisher::Gap() const
{
    const Duration gap = GapOfRate(_rule.MaxRate);
    return _timedOut ? std::max(gap, RetryGap) : gap;
}

ForeignPublisher::Duration ForeignPublisher::Service(Duration now)
{
    if (!_nextLook || now >= *_nextLook)
    {
        Look(now);
    }
    return *_nextLook;
}

ForeignPublisher::Duration ForeignPublisher::WriteDue(Duration now)
{
    Fetch();
    while (_writer.HeldBytes() > 0)
    {
        _writer.SendHeld();  // since there was a limit
    }
    for (int most = MostAtOnce; most > 0 && DueAt(now) <= now; --most)
    {
        Write(now, Way::Whole);
    }
    return DueAt(now);
}

void ForeignPublisher::Fetch()
{
    if (_global == nullptr)
    {
        return;
    }
    const std::uint64_t posts = _global->GetNumberOfPosts();
    if (_local->FetchMessage() && _local->WasPosted())
    {
        _posts.Fetched(posts);
        _pending = true;
    }
}

ForeignPublisher::Duration ForeignPublisher::DueAt(Duration now) const
{
    if (_writer.HeldBytes() > 0)
    {
        return now;
    }
    if (!HasNext() && !_writer.OwesDisposal())
    {
        return Duration::max();
    }
    return _lastWrite ? *_lastWrite + Gap() : now;
}

std::size_t ForeignPublisher::Copies() const
{
    return static_cast<std::size_t>(std::max(0, _writer.Destinations()));
}

std::size_t ForeignPublisher::NextSize() const
{
    const ForeignOutbox::Message *const next = _outbox ? _outbox->Front() : nullptr;
    const std::size_t size = next != nullptr ? next->Sample.size()
                             : _local        ? _type.SerializedSize(*_local)
                                             : 0;
    return size - std::min(size, AirCost::Encapsulation);
}

std::size_t ForeignPublisher::NextBytes() const
{
    if (const std::size_t held = _writer.HeldBytes(); held > 0)
    {
        return held;
    }
    const std::size_t copies = Copies();
    return copies == 0 ? 1 : _cost.OfFirst(NextSize(), {.Destinations = copies});
}

void ForeignPublisher::WriteNext(Duration now)
{
    if (_writer.HeldBytes() > 0)
    {
        _writer.SendHeld();
        return;
    }
    Write(now, Way::FirstDatagram);
}

// Keeps a sample that the network did not take in time for another attempt. Drops a sample that can never be
// sent.
void ForeignPublisher::Write(Duration now, Way way)
{
    WriteResult result = WriteResult::Ok;
    if (HasNext())
    {
        result = _outbox ? WriteMessage(way) : WriteValue(way);
    }
    if (!HasNext() && _writer.OwesDisposal() && _writer.HeldBytes() == 0)
    {
        result = _writer.DisposeFormer();
    }
    _timedOut = result == WriteResult::TimedOut;
    _status.write_failures += result == WriteResult::Ok ? 0 : 1;
    _lastWrite = now;
}

// A volatile writer keeps nothing for later readers.
bool ForeignPublisher::IsUnread() const
{
    return _qos.Durability == Durability::Volatile && _writer.MatchedReaders() <= 0;
}

WriteResult ForeignPublisher::WriteMessage(Way way)
{
    if (IsUnread())
    {
        ++_status.unread;
        _outbox->Pop(QueueOutcome::Refused);
        return WriteResult::Ok;
    }
    const ForeignOutbox::Message &next = *_outbox->Front();
    const WriteResult result = WriteSample(static_cast<const SampleEncoder &>(BytesEncoder(next.Sample)),
                                           next.Sample.size(), next.SourceTime, way);
    if (result != WriteResult::TimedOut)
    {
        _outbox->Pop(result == WriteResult::Ok ? QueueOutcome::Delivered : QueueOutcome::Refused);
    }
    return result;
}

WriteResult ForeignPublisher::WriteValue(Way way)
{
    const WriteResult result =
        WriteSample(*_local, _type.SerializedSize(*_local), _source.At(_local->GetPostTime().Monotonic), way);
    _pending = result == WriteResult::TimedOut;
    if (!_pending)
    {
        _posts.Taken();
    }
    return result;
}

template <typename Sample>
WriteResult ForeignPublisher::WriteSample(const Sample &sample, std::size_t size, std::int64_t sourceTime,
                                          Way way)
{
    const WriteResult result =
        way == Way::Whole ? _writer.Write(sample, sourceTime) : _writer.WriteHeld(sample, sourceTime);
    if (result == WriteResult::Ok)
    {
        ++_status.samples;
        const std::size_t copies = Copies();
        _sentBytes += copies == 0 ? 0 : _cost.Of(size - AirCost::Encapsulation, {.Destinations = copies});
    }
    return result;
}

std::string ForeignPublisher::LocalProblem() const
{
    if (!_outbox)
    {
        return _global != nullptr
                   ? ""
                   : "the local message `" + _rule.Local + "` is of another type than `" + _rule.Type + "`";
    }
    return _workspace.FindQueue(_rule.Local) == nullptr
               ? ""
               : "a manager has a queue `" + _rule.Local + "`, which gets the messages in place of the topic";
}

void ForeignPublisher::Look(Duration now)
{
    _nextLook = now + LookPeriod;
    const std::vector<RemoteEndpoint> endpoints = _session.RemoteEndpointsOn(_status.topic);
    std::string reason;
    if (ForeignMatch::Matching(_rule, _qos, endpoints).empty())
    {
        reason =
            ForeignMatch::WhyNone(_rule, _qos, endpoints, _session.RemoteTopics(), _network, _isMismatch);
    }
    else
    {
        reason = ForeignMatch::Shortfall(_rule, _qos, endpoints);
        _isMismatch = !reason.empty();
    }
    _localProblem = LocalProblem();
    reason = _localProblem.empty() ? std::move(reason) : _localProblem;
    _changed |= reason != _status.reason;
    _status.reason = std::move(reason);
}

bool ForeignPublisher::TakeChange()
{
    return std::exchange(_changed, false);
}

const Gateway::ForeignTopic &ForeignPublisher::Status()
{
    _status.readers = static_cast<std::uint32_t>(std::max(0, _writer.MatchedReaders()));
    _status.replaced = _posts.Replaced(_pending);
    _status.waiting = _outbox ? static_cast<std::uint32_t>(_outbox->Waiting()) : 0;
    _status.refused = _outbox ? _outbox->Refused() : 0;
    return _status;
}

// A topic without readers is no problem: a reader may still come.
std::optional<Gateway::Problem> ForeignPublisher::Problem(Duration now) const
{
    std::string reason = _isMismatch || !_localProblem.empty() ? _status.reason : "";
    if (reason.empty() && _outbox)
    {
        reason = _outbox->Problem(now);
    }
    if (reason.empty())
    {
        return std::nullopt;
    }
    return Gateway::Problem{"foreign " + _status.topic, "", std::move(reason), _isMismatch};
}

}  // namespace Rabit
