#include "mirrors/TopicPublisher.h"

#include <algorithm>
#include <optional>
#include <utility>

#include "mirrors/GapOfRate.h"
#include "wire/GatewayTopics.h"

namespace Rabit
{

// Writes into both partitions: plain DDS programs read the default one, nodes read those of the nodes that
// they subscribe to.
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

TopicPublisher::Duration TopicPublisher::NextGap() const
{
    const Duration gap = GapOfRate(_rule.MaxRate);
    return _timedOut ? std::max(gap, RetryGap) : gap;
}

TopicPublisher::Duration TopicPublisher::Service(Duration now)
{
    Fetch();
    while (!_isWhole)
    {
        WriteNext(now);  // since there was a limit
    }
    if (now >= DueAt(now))
    {
        Write(now, &InstanceWriter::Write);
    }
    return std::max(DueAt(now), now);
}

void TopicPublisher::SetAttached()
{
    _global = _local->GetGlobalPublishSubscribeMessageRef().get();
    _posts.Begin(_global->GetNumberOfPosts());
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
        _posts.Fetched(posts);
        _pending = true;
        _time = TimeOfPost();
    }
}

std::size_t TopicPublisher::NextBytes(const AirCost &cost) const
{
    if (const std::size_t held = _writer.HeldBytes(); held > 0)
    {
        return held;
    }
    const int copies = _writer.Destinations();
    return copies <= 0 ? 1
                       : cost.OfFirst(_type.SerializedSize(*_local) - AirCost::Encapsulation,
                                      {.Destinations = static_cast<std::size_t>(copies)});
}

std::size_t TopicPublisher::SampleBytes(const AirCost &cost) const
{
    const int copies = _writer.Destinations();
    return copies <= 0 ? 0
                       : cost.Of(_type.SerializedSize(*_local) - AirCost::Encapsulation,
                                 {.Destinations = static_cast<std::size_t>(copies)});
}

TopicPublisher::Duration TopicPublisher::DueAt(Duration now) const
{
    if (!_isWhole)
    {
        return now;
    }
    const Duration value = ValueDueAt(now);
    return _writer.OwesDisposal() ? std::min(value, _lastWrite + NextGap()) : value;
}

// A new value is due at once, a requested one at its turn, none more often than the rule allows.
TopicPublisher::Duration TopicPublisher::ValueDueAt(Duration now) const
{
    const Duration mayWriteAt = _everWritten ? _lastWrite + NextGap() : now;
    if (_pending)
    {
        return mayWriteAt;
    }
    const std::optional<Duration> repeat = _repeat.Due();
    return repeat ? std::max(*repeat, mayWriteAt) : Duration::max();
}

void TopicPublisher::WriteNext(Duration now)
{
    if (_isWhole)
    {
        Write(now, &InstanceWriter::WriteHeld);
        return;
    }
    _writer.SendHeld();
    if (!IsUnderWay())
    {
        Written(now);
    }
}

void TopicPublisher::Write(Duration now, Way way)
{
    const bool isValue = now >= ValueDueAt(now);
    const WriteResult result = isValue ? WriteValue(way) : _writer.DisposeFormer();
    _failures += result == WriteResult::Ok ? 0 : 1;
    _timedOut = result == WriteResult::TimedOut || (_writer.OwesDisposal() && !IsUnderWay());
    _lastWrite = now;
    if (!isValue || result == WriteResult::TimedOut)
    {
        return;
    }
    if (result != WriteResult::Ok)
    {
        _writtenTime.reset();
    }
    _isWhole = !IsUnderWay();
    if (_isWhole)
    {
        Written(now);
    }
}

// The last datagram was written. Announced earlier, the State would be requested while it is under way.
void TopicPublisher::Written(Duration now)
{
    _isWhole = true;
    if (_rule.Qos == QosProfile::State)
    {
        const std::uint32_t version = _writtenTime ? StateVersion::Of(*_writtenTime) : StateVersion::None;
        _repeat.Written(std::exchange(_version, version) != version, now);
    }
}

// All times are in the middle of a step, telemetry too: so a sample and the post in the recording of this
// node are known to be the same (../backfill). The second of two values within a step of StateVersion gets
// the time of the next step.
std::int64_t TopicPublisher::TimeOfPost() const
{
    constexpr std::int64_t ShortlyBefore = 100 * StateVersion::Step;
    const std::int64_t time = StateVersion::Quantised(_source.At(_local->GetPostTime().Monotonic));
    return time <= _time && _time - time < ShortlyBefore ? StateVersion::Next(_time) : time;
}

void TopicPublisher::AskedFor(Duration now)
{
    if (_version != StateVersion::None && _isWhole)
    {
        _repeat.Ask(now);
    }
}

WriteResult TopicPublisher::WriteValue(Way way)
{
    const bool wasPending = _pending;
    const WriteResult result = (_writer.*way)(*_local, _time);
    _writtenTime = _time;
    _written += result == WriteResult::Ok ? 1 : 0;
    // A value that the network did not take in time is tried again; a value that can never be sent would only
    // fail again.
    _pending = result == WriteResult::TimedOut;
    if (wasPending && !_pending)
    {
        _posts.Taken();
    }
    _everWritten = true;
    return result;
}

Gateway::PublicationStatus TopicPublisher::Status() const
{
    Gateway::PublicationStatus status;
    status.message = _rule.Message;
    status.written = _written;
    status.offered = _posts.Offered(_pending);
    status.replaced = _posts.Replaced(_pending);
    status.write_failures = _failures;
    status.readers = static_cast<std::uint32_t>(std::max(0, _writer.MatchedReaders()));
    return status;
}

}  // namespace Rabit
