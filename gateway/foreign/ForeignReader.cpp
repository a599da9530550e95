#include "foreign/ForeignReader.h"

#include <rabit/RabitLog.h>

#include <algorithm>
#include <cstdio>
#include <limits>
#include <utility>

#include "clocks/GpsTime.h"
#include "names/ForeignNames.h"
#include "names/TypeDefinition.h"

namespace Rabit
{
namespace
{

using std::chrono::duration;

// Source times before this (2000-01-01) are those of a clock that was never set.
constexpr std::int64_t EarliestSourceTime = 946684800LL * 1000000000LL;

std::string Digits(const WriterId &id)
{
    std::string text;
    char digits[3];
    for (const std::uint8_t byte : id)
    {
        std::snprintf(digits, sizeof digits, "%02x", byte);
        text += digits;
    }
    return text;
}

std::string Seconds(std::chrono::nanoseconds time)
{
    char text[32];
    std::snprintf(text, sizeof text, "%.1f s", duration<double>(time).count());
    return text;
}

AcceptRule QueueRule(const ForeignRule &rule)
{
    return {.Queue = rule.Local, .Types = {rule.Type}, .From = {"*"}};
}

}  // namespace

ForeignReader::ForeignReader(const ForeignRule &rule, const MessageType &type, ForeignMatch::Network network,
                             RabitWorkspace &workspace, std::function<void()> wake,
                             RabitHandlerThread *handlers, std::shared_ptr<GatewayTap> tap)
    : _rule(rule),
      _type(type),
      _network(std::move(network)),
      _workspace(workspace),
      _wake(wake),
      _handlers(handlers),
      _tap(std::move(tap)),
      _scratch(type.Create()),
      _queue(QueueRule(rule), workspace, std::move(wake))
{
    _status.topic = WireTopicOf(rule);
    _status.type = WireTypeOf(rule);
    _status.local = rule.Local;
    _status.state = Gateway::NodeState::LOST;
}

ForeignReader::~ForeignReader()
{
    _reader.reset();  // first: its handler uses the rest
}

void ForeignReader::Open(TransportSession &session, Duration now)
{
    _session = &session;
    if (!IsQueue())
    {
        const std::shared_ptr<RabitMessage> message = _type.CreateShared();
        if (_workspace.AddPublishSubscribeMessage(_rule.Local, message))
        {
            _global = message->GetGlobalPublishSubscribeMessageRef();
        }
        else
        {
            _localProblem =
                "the local message `" + _rule.Local + "` is of another type than `" + _rule.Type + "`";
        }
    }
    MakeReader(ForeignMatch::FirstReaderQos(_rule));
    Look(now);
}

void ForeignReader::MakeReader(const TopicQos &qos)
{
    TopicDescription topic{
        .Name = _status.topic, .TypeName = _status.type, .KeyOf = {}, .TypeHash = WireHashOf(_rule, _type)};
    if (_type.HasKey())
    {
        topic.KeyOf = [this](SampleBytes bytes, KeyHash &key) { return _type.KeyHashOf(bytes, key); };
    }
    _reader.reset();
    _qos = qos;
    _reader = _session->CreateReader(
        topic, qos, {""}, [this](SampleBytes bytes, const SampleInfo &info) { OnSample(bytes, info); });
}

void ForeignReader::OnSample(SampleBytes bytes, const SampleInfo &info)
{
    const Duration now = _workspace.GetClock().Monotonic();
    {
        const std::lock_guard lock(_mutex);
        if (!info.Node.empty())
        {
            ++_ofNodes;
            return;
        }
        if (info.Alive && !_writers.IsNew(info.Writer, info.Sequence, now))
        {
            ++_overtaken;
            return;
        }
    }
    if (!info.Alive)
    {
        OnEnd(info);
    }
    else if (IsQueue())
    {
        Keep(bytes);
    }
    else
    {
        Post(bytes, info, now);
    }
}

void ForeignReader::OnEnd(const SampleInfo &info)
{
    const std::lock_guard lock(_mutex);
    if (_shown && _shown->Key == info.Key)
    {
        _shown->Ended = true;
    }
}

void ForeignReader::Post(SampleBytes bytes, const SampleInfo &info, Duration now)
{
    _scratch->RabitMessage::Clear();  // it may hold a former post, with ints that a manager here set
    if (!_type.Deserialize(bytes, *_scratch))
    {
        if (CountUndecodable(bytes.size()))
        {
            _wake();
        }
        return;
    }
    const Duration postedAt = PostedAt(info, now);
    if (_global)
    {
        const double stamp =
            _workspace.GetClock().GpsTimeSeconds() - duration<double>(now - postedAt).count();
        const RabitHandlerThread::Scope scope(_handlers, _rule.Local, _global);
        _global->PostContents(_scratch, PostTime{stamp, postedAt});
    }
    const std::lock_guard lock(_mutex);
    _undecodableInARow = 0;
    _samples += _global ? 1 : 0;
    _shown = Shown{postedAt, info.Key, false};
}

// Returns the time of the post by our monotonic clock: from the source time if the rule trusts it, otherwise
// the arrival. The result is never in the future.
ForeignReader::Duration ForeignReader::PostedAt(const SampleInfo &info, Duration now) const
{
    if (!_rule.SourceTimeIsTrusted || info.SourceTime < EarliestSourceTime)
    {
        return now;
    }
    const std::int64_t wall = GpsTime::ToUtcNanoseconds(_workspace.GetClock().GpsTimeSeconds());
    return now - std::max(Duration(0), Duration(wall - info.SourceTime));
}

void ForeignReader::Keep(SampleBytes bytes)
{
    AcceptedQueue::Decoded decoded = _queue.Decode(LinkTypeName(_type), bytes);
    if (!decoded.Message)
    {
        CountUndecodable(bytes.size());
        return;
    }
    const Duration now = _workspace.GetClock().Monotonic();
    const std::size_t held = bytes.size() * (_tap ? 2 : 1);
    bool isFirst = false;
    {
        const std::lock_guard lock(_mutex);
        _undecodableInARow = 0;
        _shown = Shown{now, {}, false};
        isFirst = _waiting.empty();
        _wasDropped =
            _waiting.size() >= _rule.Capacity || (!isFirst && _waitingBytes + held > _rule.CapacityBytes);
        if (_wasDropped)
        {
            ++_overflowed;
            return;
        }
        _waitingBytes += held;
        _waiting.push_back({std::move(decoded.Message), held});
        if (_tap)
        {
            _waiting.back().Sample.assign(bytes.begin(), bytes.end());
        }
    }
    if (isFirst)
    {
        _wake();
    }
}

// Returns true for the first undecodable sample in a row.
bool ForeignReader::CountUndecodable(std::size_t size)
{
    std::uint64_t count = 0;
    bool isFirst = false;
    {
        const std::lock_guard lock(_mutex);
        count = ++_undecodable;
        isFirst = ++_undecodableInARow == 1;
        if (!_log.MayPass(_workspace.GetClock().Monotonic()))
        {
            return isFirst;
        }
    }
    RabitLog::Write(RabitLogLevel::Warning, "gateway: a sample of " + std::to_string(size) +
                                                " bytes of the topic `" + _status.topic +
                                                "` of a program that is no node does not decode as `" +
                                                _rule.Type + "` (" + std::to_string(count) + " so far)");
    return isFirst;
}

ForeignReader::Duration ForeignReader::Service(Duration now)
{
    if (IsQueue())
    {
        Deliver();
    }
    if (!_nextLook || now >= *_nextLook)
    {
        Look(now);
    }
    Judge(now);
    Duration next = *_nextLook;
    const std::lock_guard lock(_mutex);
    if (_shown && _rule.StaleAfter > Duration(0) && _status.state == Gateway::NodeState::UP)
    {
        next = std::min(next, _shown->PostedAt + _rule.StaleAfter + std::chrono::milliseconds(1));
    }
    return next;
}

// Calls the queue's handlers, with no lock held.
void ForeignReader::Deliver()
{
    _changed |= _queue.Find();
    _queue.TakeRoomCame();
    std::shared_ptr<AcceptedQueue::Queue> told;
    for (;;)
    {
        std::shared_ptr<RabitMessage> message;
        {
            const std::lock_guard lock(_mutex);
            if (_waiting.empty())
            {
                break;
            }
            message = _waiting.front().Message;
        }
        if (!_queue.Local() || _queue.Deliver({LocalQueueResult::Ok, message}, false) != LocalQueueResult::Ok)
        {
            _queue.Room();  // asks the queue to tell when it has room
            break;
        }
        told = _queue.Local();
        std::vector<std::uint8_t> sample;
        {
            const std::lock_guard lock(_mutex);
            sample = std::move(_waiting.front().Sample);
            _waitingBytes -= _waiting.front().Bytes;
            _waiting.pop_front();
            ++_samples;
        }
        if (_tap)
        {
            _tap->Received({.Node = "", .Queue = _rule.Local, .Type = _rule.Type, .Id = 0, .Sample = sample});
        }
    }
    if (told)
    {
        const RabitHandlerThread::Scope scope(_handlers, _rule.Local, told);
        told->NotifyEnqueued();
    }
}

void ForeignReader::Look(Duration now)
{
    _nextLook = now + LookPeriod;
    const std::vector<RemoteEndpoint> endpoints = _session->RemoteEndpointsOn(_status.topic);
    const TopicQos wanted = ForeignMatch::ReaderQos(_rule, endpoints, _qos);
    if (wanted.Reliability != _qos.Reliability || wanted.Durability != _qos.Durability)
    {
        MakeReader(wanted);
        _changed = true;
    }
    _found.clear();
    std::copy_if(endpoints.begin(), endpoints.end(), std::back_inserter(_found),
                 [](const RemoteEndpoint &endpoint) { return endpoint.IsWriter && endpoint.Node.empty(); });
    _matching = ForeignMatch::Matching(_rule, _qos, endpoints).size();
    _shortfall = _matching > 0 ? ForeignMatch::Shortfall(_rule, _qos, endpoints) : "";
    _isMismatch = !_shortfall.empty();
    _whyNone = _matching > 0 ? ""
                             : ForeignMatch::WhyNone(_rule, _qos, endpoints, _session->RemoteTopics(),
                                                     _network, _isMismatch);
}

void ForeignReader::Judge(Duration now)
{
    Gateway::NodeState state = Gateway::NodeState::UP;
    std::string reason;
    {
        const std::lock_guard lock(_mutex);
        const Duration age = _shown ? now - _shown->PostedAt : Duration(0);
        if (!_shown || _matching == 0 || _shown->Ended)
        {
            state = Gateway::NodeState::LOST;
            reason = _matching == 0      ? _whyNone
                     : _shown            ? "its writer has disposed of what it shows"
                     : _undecodable == 0 ? "the program that writes it has sent nothing that was received"
                                         : "";
        }
        else if (_rule.StaleAfter > Duration(0) && age > _rule.StaleAfter)
        {
            state = Gateway::NodeState::STALE;
            // The limit, not the age, so that the text does not change with each look.
            reason = "nothing newer than " + Seconds(_rule.StaleAfter);
        }
        if (!_shortfall.empty())
        {
            reason += (reason.empty() ? "" : "; ") + _shortfall;
        }
        if (_undecodableInARow > 0)
        {
            reason = "its samples do not decode as `" + _rule.Type +
                     "`: its program was built with another version of the type";
        }
    }
    const std::string local = IsQueue() ? _queue.Problem() : _localProblem;
    reason = local.empty() ? reason : local;
    _changed |= state != _status.state || reason != _status.reason;
    _status.state = state;
    _status.reason = std::move(reason);
}

bool ForeignReader::TakeChange()
{
    return std::exchange(_changed, false);
}

const Gateway::ForeignTopic &ForeignReader::Status(Duration now)
{
    _status.qos = ForeignMatch::QosText(_qos.Reliability, _qos.Durability);
    const std::lock_guard lock(_mutex);
    _status.samples = _samples;
    _status.missed = _writers.Missed();
    _status.undecodable = _undecodable;
    _status.overtaken = _overtaken;
    _status.of_nodes = _ofNodes;
    _status.overflowed = _overflowed;
    _status.waiting = static_cast<std::uint32_t>(_waiting.size());
    _status.writers.clear();
    for (const RemoteEndpoint &endpoint : _found)
    {
        Gateway::ForeignWriter writer;
        writer.id = Digits(endpoint.Id);
        writer.type = endpoint.Type;
        writer.qos = ForeignMatch::QosText(endpoint.Reliability, endpoint.Durability);
        const ForeignWriters::Writer *known = _writers.Find(endpoint.Id);
        writer.received = known != nullptr ? known->Received : 0;
        writer.missed = known != nullptr ? known->Missed : 0;
        writer.last_heard_s = known != nullptr ? duration<double>(now - known->LastHeard).count()
                                               : std::numeric_limits<double>::infinity();
        _status.writers.push_back(std::move(writer));
    }
    return _status;
}

std::optional<Gateway::Problem> ForeignReader::Problem() const
{
    const std::lock_guard lock(_mutex);
    const bool waitsForTheFirst = _status.state == Gateway::NodeState::LOST && _matching > 0 &&
                                  _shortfall.empty() && _undecodableInARow == 0;
    std::string reason = _status.reason;
    if (_waiting.size() >= _rule.Capacity || (_wasDropped && !_waiting.empty()))
    {
        reason = "the local queue `" + _rule.Local + "` is full; samples are dropped";
    }
    if (reason.empty() || (waitsForTheFirst && (IsQueue() ? _queue.Problem() : _localProblem).empty()))
    {
        return std::nullopt;
    }
    return Gateway::Problem{"foreign " + _status.topic, "", std::move(reason), _isMismatch};
}

}  // namespace Rabit
