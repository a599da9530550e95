#include "recording/QueueStreams.h"

#include <rabit/gateway/NamePattern.h>
#include <rabit/gateway/SchemaText.h>
#include <rabit/idl/MessageType.h>
#include <rabit/idl/MessageTypeRegistry.h>

#include <nlohmann/json.hpp>

#include <utility>

#include "recording/JsonStreams.h"

namespace Rabit
{
namespace
{

using Json = nlohmann::ordered_json;

// The word for the other end of a message. No node is called so.
std::string PeerOf(std::string_view node)
{
    return node.empty() ? "(foreign)" : std::string(node);
}

}  // namespace

QueueStreams::QueueStreams(std::shared_ptr<RecordingTarget> target, const RecordSettings &settings)
    : _target(std::move(target)),
      _settings(settings),
      _outcomes(_target->Inbox().AddStream(JsonStreams::Outcomes(_target->Node()))),
      _clocks(_target->Inbox().AddStream(JsonStreams::Clocks(_target->Node()))),
      _others(_target->Inbox().AddStream({.Topic = _target->Node() + "/Recorder/others", .SchemaName = ""}))
{
}

void QueueStreams::Sent(const QueueMessage &message)
{
    Record("sent", message);
}

void QueueStreams::Refused(const QueueMessage &message, std::string_view reason)
{
    Record("refused", message);
    TellOutcome(message.Node, message.Queue, 0, "refused", reason);
}

void QueueStreams::Settled(std::string_view node, std::string_view queue, std::uint64_t id,
                           QueueOutcome outcome)
{
    TellOutcome(node, queue, id, ToString(outcome), "");
}

void QueueStreams::Received(const QueueMessage &message)
{
    Record("received", message);
    if (_settings.BlackBox && MatchesAny(_settings.BlackBox->Queues, message.Queue))
    {
        _target->Happened(std::string(message.Type) + " of " +
                          (message.Node.empty() ? "a foreign program" : std::string(message.Node)) + " in " +
                          std::string(message.Queue));
    }
}

void QueueStreams::Record(const char *what, const QueueMessage &message)
{
    if (!_settings.Queues)
    {
        return;
    }
    const std::uint32_t stream = StreamOf(what, message);
    if (stream == _others)
    {
        _target->Inbox().AddLost(stream, 1);
        return;
    }
    _target->Put(stream, _target->Now(), {message.Sample.begin(), message.Sample.end()},
                 static_cast<std::uint32_t>(message.Id));
}

std::uint32_t QueueStreams::StreamOf(const char *what, const QueueMessage &message)
{
    RecordingStream stream;
    stream.Topic = _target->Node() + "/Recorder/" + what + "/" + PeerOf(message.Node) + "/" +
                   std::string(message.Queue) + "/" + std::string(message.Type);
    const std::lock_guard lock(_mutex);
    if (const auto known = _streams.find(stream.Topic); known != _streams.end())
    {
        return known->second;
    }
    if (_streams.size() >= MostStreams)
    {
        return _others;
    }
    const MessageType *type = MessageTypeRegistry::Find(std::string(message.Type));
    stream.SchemaName = type == nullptr ? "" : type->Name();
    stream.SchemaText = type == nullptr ? "" : SchemaText(type->IdlText());
    stream.Metadata = {{"rabit.kind", std::string("queue ") + what},
                       {"rabit.node", _target->Node()},
                       {"rabit.peer", std::string(message.Node)},
                       {"rabit.queue", std::string(message.Queue)}};
    std::string topic = stream.Topic;
    const std::uint32_t number = _target->Inbox().AddStream(std::move(stream));
    _streams.emplace(std::move(topic), number);
    return number;
}

void QueueStreams::TellOutcome(std::string_view node, std::string_view queue, std::uint64_t id,
                               const std::string &outcome, std::string_view reason)
{
    if (_settings.BlackBox && _settings.BlackBox->Outcomes && outcome != ToString(QueueOutcome::Delivered))
    {
        _target->Happened(outcome + ": a message for " + PeerOf(node) + "/" + std::string(queue));
    }
    if (_settings.Queues)
    {
        _target->PutJson(_outcomes, {{"id", std::to_string(id)},
                                     {"node", PeerOf(node)},
                                     {"queue", queue},
                                     {"outcome", outcome},
                                     {"reason", reason}});
    }
}

// Converts source clocks by the monotonic clock to log time.
void QueueStreams::Clocks(std::uint64_t incarnation, std::chrono::nanoseconds sourceAhead,
                          const std::vector<PeerClock> &peers)
{
    const std::chrono::nanoseconds monotonicToLog = _target->MonotonicToLog();
    const std::string sourceToLog = std::to_string((monotonicToLog - sourceAhead).count());
    if (std::exchange(_incarnation, incarnation) != incarnation)
    {
        // In each file, so that each tells the times of its posts by the clock of their samples.
        _target->Inbox().SetMetadata(
            "rabit.clock", {{"incarnation", std::to_string(incarnation)}, {"source_to_log_ns", sourceToLog}});
    }
    Json others = Json::array();
    for (const PeerClock &peer : peers)
    {
        others.push_back({{"node", peer.Node},
                          {"incarnation", std::to_string(peer.Incarnation)},
                          {"source_to_log_ns", std::to_string((peer.ToLocal + monotonicToLog).count())},
                          {"uncertain_by_ns", peer.RoundTrip ? Json(peer.RoundTrip->count() / 2) : Json()}});
    }
    _target->PutJson(
        _clocks,
        {{"incarnation", std::to_string(incarnation)}, {"source_to_log_ns", sourceToLog}, {"peers", others}});
}

std::vector<Gateway::Problem> QueueStreams::Problems()
{
    const RecordingStatus status = _target->Status();
    std::vector<Gateway::Problem> problems;
    const auto add = [&problems](const std::string &subject, const std::string &reason) {
        problems.push_back({subject, "", reason});
    };
    if (!status.Problem.empty())
    {
        add("record", "nothing is recorded: " + status.Problem);
    }
    std::uint64_t others = 0;
    for (const auto &[topic, count] : status.Lost)
    {
        if (problems.size() < MostProblems)
        {
            add("record " + topic, std::to_string(count) + " messages were not recorded");
        }
        else
        {
            others += count;
        }
    }
    if (others > 0)
    {
        add("record", std::to_string(others) + " messages of further topics were not recorded");
    }
    return problems;
}

}  // namespace Rabit
