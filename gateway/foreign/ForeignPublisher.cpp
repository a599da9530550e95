#include "foreign/ForeignPublisher.h"

#include <algorithm>
#include <utility>

#include "mirrors/GapOfRate.h"
#include "names/ForeignNames.h"

namespace Rabit
{
namespace
{

std::unique_ptr<TransportWriter> MakeWriter(const ForeignRule &rule, const MessageType &type,
                                            TransportSession &session)
{
    TopicDescription topic{.Name = WireTopicOf(rule), .TypeName = WireTypeOf(rule), .KeyOf = {}};
    if (type.HasKey())
    {
        topic.KeyOf = [&type](SampleBytes bytes, KeyHash &key) { return type.KeyHashOf(bytes, key); };
    }
    return session.CreateWriter(topic, ForeignMatch::WriterQos(rule), {""});
}

}  // namespace

ForeignPublisher::ForeignPublisher(const ForeignRule &rule, const MessageType &type,
                                   ForeignMatch::Network network, const SourceClock &source,
                                   TransportSession &session)
    : _rule(rule),
      _network(std::move(network)),
      _source(source),
      _session(session),
      _qos(ForeignMatch::WriterQos(rule)),
      _writer(type, MakeWriter(rule, type, session)),
      _local(type.CreateShared())
{
    _status.topic = WireTopicOf(rule);
    _status.type = WireTypeOf(rule);
    _status.local = rule.Local;
    _status.written = true;
    _status.state = Gateway::NodeState::UP;
    _status.qos = ForeignMatch::QosText(_qos.Reliability, _qos.Durability);
}

ForeignPublisher::Duration ForeignPublisher::Gap() const
{
    const Duration gap = GapOfRate(_rule.MaxRate);
    return _timedOut ? std::max(gap, RetryGap) : gap;
}

ForeignPublisher::Duration ForeignPublisher::Service(Duration now)
{
    if (_attached && _local->FetchMessage() && _local->WasPosted())
    {
        _pending = true;
    }
    if (!_nextLook || now >= *_nextLook)
    {
        Look(now);
    }
    const bool owes = _pending || _writer.OwesDisposal();
    if (owes && (!_lastWrite || now >= *_lastWrite + Gap()))
    {
        Write(now);
    }
    return _pending || _writer.OwesDisposal() ? std::min(*_nextLook, *_lastWrite + Gap()) : *_nextLook;
}

// Keeps a value that the network did not take in time for another attempt. Drops a value that can never be
// sent.
void ForeignPublisher::Write(Duration now)
{
    WriteResult result = WriteResult::Ok;
    if (_pending)
    {
        result = _writer.Write(*_local, _source.At(_local->GetPostTime().Monotonic));
        _pending = result == WriteResult::TimedOut;
        _status.samples += result == WriteResult::Ok ? 1 : 0;
    }
    if (!_pending && _writer.OwesDisposal())
    {
        result = _writer.DisposeFormer();
    }
    _timedOut = result == WriteResult::TimedOut;
    _status.write_failures += result == WriteResult::Ok ? 0 : 1;
    _lastWrite = now;
}

void ForeignPublisher::Look(Duration now)
{
    _nextLook = now + LookPeriod;
    const std::vector<RemoteEndpoint> endpoints = _session.RemoteEndpointsOn(_status.topic);
    const bool any = !ForeignMatch::Matching(_rule, _qos, endpoints).empty();
    _isMismatch = false;
    std::string reason =
        any ? ""
            : ForeignMatch::WhyNone(_rule, _qos, endpoints, _session.RemoteTopics(), _network, _isMismatch);
    if (!_attached)
    {
        reason = "the local message `" + _rule.Local + "` is of another type than `" + _rule.Type + "`";
    }
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
    return _status;
}

// A topic without readers is no problem: a reader may still come.
std::optional<Gateway::Problem> ForeignPublisher::Problem() const
{
    if (_attached && !_isMismatch)
    {
        return std::nullopt;
    }
    return Gateway::Problem{"foreign " + _status.topic, "", _status.reason, _isMismatch};
}

}  // namespace Rabit
