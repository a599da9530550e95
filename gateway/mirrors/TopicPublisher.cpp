#include "mirrors/TopicPublisher.h"

#include <algorithm>

#include "wire/GatewayTopics.h"

namespace Rabit
{

// Both partitions: plain DDS programs read the default one, nodes read those of the nodes they want.
TopicPublisher::TopicPublisher(const PublishRule &rule, const MessageType &type, const std::string &node,
                               const SourceClock &source, TransportSession &session)
    : _rule(rule),
      _type(type),
      _source(source),
      _local(type.Create()),
      _writer(type, session.CreateWriter(GatewayTopics::Describe(rule.Message, type),
                                         GatewayTopics::QosOf(rule.Qos), {"", node}))
{
}

TopicPublisher::Duration TopicPublisher::MinimumGap() const
{
    return _rule.MaxRate > 0.0 ? Duration(static_cast<std::int64_t>(1e9 / _rule.MaxRate)) : Duration(0);
}

TopicPublisher::Duration TopicPublisher::NextGap() const
{
    return _timedOut ? std::max(MinimumGap(), RetryGap) : MinimumGap();
}

TopicPublisher::Duration TopicPublisher::Service(Duration now)
{
    Fetch();
    if (now >= DueAt(now))
    {
        Write(now);
    }
    return std::max(DueAt(now), now);
}

// What was posted before may be there still, and is the first value.
void TopicPublisher::SetAttached()
{
    _global = _local->GetGlobalPublishSubscribeMessageRef().get();
    const std::uint64_t posts = _global->GetNumberOfPosts();
    _postsBefore = posts == 0 ? 0 : posts - 1;
}

void TopicPublisher::Fetch()
{
    if (_global == nullptr)
    {
        return;
    }
    const std::uint64_t posts = _global->GetNumberOfPosts();
    if (_local->FetchMessage() && _local->WasPosted())
    {
        _offered = posts - _postsBefore;
        _pending = true;
    }
}

std::size_t TopicPublisher::NextBytes(const AirCost &cost) const
{
    const int copies = _writer.Destinations();
    return copies <= 0 ? 1
                       : cost.Of(_type.SerializedSize(*_local) - AirCost::Encapsulation,
                                 {.Destinations = static_cast<std::size_t>(copies)});
}

TopicPublisher::Duration TopicPublisher::DueAt(Duration now) const
{
    const Duration value = ValueDueAt(now);
    return _writer.OwesDisposal() ? std::min(value, _lastWrite + NextGap()) : value;
}

// What was posted, and what somebody new waits for, at once; a State's repetition in its period; nothing more
// often than the rule allows.
TopicPublisher::Duration TopicPublisher::ValueDueAt(Duration now) const
{
    const bool repeats = _rule.Qos == QosProfile::State && _everWritten;
    const Duration mayWriteAt = _everWritten ? _lastWrite + NextGap() : now;
    if (_pending || (repeats && _repeatNow))
    {
        return mayWriteAt;
    }
    return repeats ? std::max(_lastWrite + StateRepeatPeriod, mayWriteAt) : Duration::max();
}

void TopicPublisher::Write(Duration now)
{
    const WriteResult result = now >= ValueDueAt(now) ? WriteValue() : _writer.DisposeFormer();
    _failures += result == WriteResult::Ok ? 0 : 1;
    _timedOut = result == WriteResult::TimedOut || _writer.OwesDisposal();
    _lastWrite = now;
}

WriteResult TopicPublisher::WriteValue()
{
    _taken += _pending ? 1 : 0;
    const WriteResult result = _writer.Write(*_local, _source.At(_local->GetPostTime().Monotonic));
    _written += result == WriteResult::Ok ? 1 : 0;
    // A value that the network did not take in time is tried again; one that can never be sent would only
    // fail again.
    _taken -= _pending && result == WriteResult::TimedOut ? 1 : 0;
    _pending = result == WriteResult::TimedOut;
    _everWritten = true;
    _repeatNow = false;
    return result;
}

Gateway::PublicationStatus TopicPublisher::Status() const
{
    Gateway::PublicationStatus status;
    status.message = _rule.Message;
    status.written = _written;
    const std::uint64_t kept = _taken + (_pending ? 1 : 0);
    status.offered = std::max(_offered, kept);
    status.replaced = status.offered - kept;
    status.write_failures = _failures;
    status.readers = static_cast<std::uint32_t>(std::max(0, _writer.MatchedReaders()));
    return status;
}

}  // namespace Rabit
