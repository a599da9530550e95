#include "backfill/SeriesStreams.h"

#include <rabit/gateway/QosProfileWords.h>
#include <rabit/gateway/SchemaText.h>
#include <rabit/idl/MessageType.h>
#include <rabit/idl/MessageTypeRegistry.h>

#include <nlohmann/json.hpp>

#include <algorithm>

#include "backfill/CredibleTime.h"

namespace Rabit::Backfill
{
namespace
{

RecordingStream MarksOf(const std::string &node)
{
    RecordingStream stream;
    stream.Topic = MarksTopicOf(node);
    stream.Encoding = "json";
    stream.SchemaName = "rabit.Backfill";
    stream.SchemaEncoding = "jsonschema";
    stream.SchemaText =
        R"({"type":"object","properties":{"node":{"type":"string"},"message":{"type":"string"},)"
        R"("incarnation":{"type":"string"},"first_stamp":{"type":"string"},"end_stamp":{"type":"string"}}})";
    stream.Metadata = {{"rabit.kind", "backfill"}, {"rabit.node", node}};
    return stream;
}

GatewayConfig WithoutTap(GatewayConfig config)
{
    config.Tap.reset();  // it keeps the target alive
    return config;
}

}  // namespace

std::string MarksTopicOf(const std::string &node)
{
    return node + "/Recorder/Backfill";
}

SeriesStreams::SeriesStreams(const GatewayConfig &config, std::shared_ptr<RecordingTarget> target,
                             std::shared_ptr<Ledger> ledger)
    : _config(WithoutTap(config)),
      _target(std::move(target)),
      _ledger(std::move(ledger)),
      _messages(config.Record->Backfill.begin(), config.Record->Backfill.end()),
      _marks(_target->Inbox().AddStream(MarksOf(config.Node)))
{
}

std::uint32_t SeriesStreams::StreamOf(const Series &series, bool isLive, std::int64_t sourceToLog)
{
    const std::lock_guard lock(_mutex);
    const auto known = _streams.find({series, isLive});
    if (known != _streams.end())
    {
        return known->second;
    }
    const auto rule =
        std::find_if(_config.Subscribe.begin(), _config.Subscribe.end(),
                     [&series](const SubscribeRule &one) { return one.Message == series.Message; });
    const MessageType *type =
        rule == _config.Subscribe.end() ? nullptr : MessageTypeRegistry::Find(rule->Type);
    RecordingStream stream;
    stream.Topic = series.Node + "/" + series.Message;
    stream.SchemaName = type == nullptr ? "" : type->Name();
    stream.SchemaText = type == nullptr ? "" : SchemaText(type->IdlText());
    stream.Metadata = {{"rabit.kind", isLive ? "mirrored" : "backfilled"},
                       {"rabit.node", series.Node},
                       {"rabit.origin_incarnation", std::to_string(series.Incarnation)},
                       {"rabit.source_to_log_ns", std::to_string(sourceToLog)}};
    if (type != nullptr && rule->Qos)
    {
        stream.Metadata["rabit.qos"] = WordOf(*rule->Qos);
    }
    // A missed State is over: it is not repeated at the beginning of later files.
    stream.IsState = isLive && type != nullptr && rule->Qos != QosProfile::Telemetry;
    const std::uint32_t number = _target->Inbox().AddStream(std::move(stream));
    _streams.emplace(std::pair(series, isLive), number);
    return number;
}

void SeriesStreams::SetPaused(bool isPaused)
{
    std::map<Series, Newest> newest;
    {
        const std::lock_guard lock(_mutex);
        _isPaused = isPaused;
        _hasFirstPauseEnded = _hasFirstPauseEnded || !isPaused;
        if (!isPaused)
        {
            newest.swap(_newestOfFirstPause);
        }
    }
    for (auto &[series, live] : newest)
    {
        Record(series, live.SourceTime, live.PostedAt, std::move(live.Sample));
    }
}

void SeriesStreams::SetLiveOnly(std::set<std::pair<std::string, std::string>> series)
{
    const std::lock_guard lock(_mutex);
    _liveOnly = std::move(series);
}

void SeriesStreams::TakeLive(const GatewayTap::MirroredSample &sample)
{
    if (!IsBackfilled(sample.Message))
    {
        return;
    }
    const Series series{std::string(sample.Node), std::string(sample.Message), sample.Incarnation};
    Mcap::Bytes bytes(sample.Sample.begin(), sample.Sample.end());
    {
        const std::lock_guard lock(_mutex);
        if (_isPaused && !_liveOnly.contains({series.Node, series.Message}))
        {
            if (!_hasFirstPauseEnded &&
                (_newestOfFirstPause.contains(series) || _newestOfFirstPause.size() < MostSeriesOfFirstPause))
            {
                _newestOfFirstPause[series] = Newest{sample.SourceTime, sample.PostedAt, std::move(bytes)};
            }
            return;
        }
    }
    Record(series, sample.SourceTime, sample.PostedAt, std::move(bytes));
}

void SeriesStreams::Record(const Series &series, std::int64_t sourceTime, std::chrono::nanoseconds posted,
                           Mcap::Bytes sample)
{
    const Stamp stamp = StampOf(sourceTime);
    if (!_ledger->Take(series, stamp))
    {
        return;
    }
    const std::uint64_t postedAt = _target->At(posted);
    const std::uint32_t stream = StreamOf(series, true, static_cast<std::int64_t>(postedAt) - sourceTime);
    if (!_target->Put(stream, postedAt, std::move(sample), static_cast<std::uint32_t>(stamp)))
    {
        _ledger->Undo(series, stamp);
    }
}

Requester::Taken SeriesStreams::TakeMissed(const Series &series, const Post &post,
                                           std::chrono::nanoseconds sourceToLocal)
{
    const std::uint64_t time = _target->At(std::chrono::nanoseconds(post.SourceTime) + sourceToLocal);
    if (!IsCredible(time, _target->Now(), _config.Record->BackfillLast))
    {
        ++_incredible;
        return Requester::Taken::Refused;
    }
    const std::uint32_t stream = StreamOf(series, false, static_cast<std::int64_t>(time) - post.SourceTime);
    if (post.Bytes.size() > _config.Record->Memory / 4 * 3)
    {
        ++_tooLarge;
        return Requester::Taken::Refused;  // there is never room for it
    }
    const bool isPut = _target->Inbox().Put(
        {stream, static_cast<std::uint32_t>(StampOf(post.SourceTime)), time, time, post.Bytes});
    return isPut ? Requester::Taken::Recorded : Requester::Taken::NotNow;
}

void SeriesStreams::TakeWhole(const Series &series, Range range)
{
    const nlohmann::ordered_json json = {{"node", series.Node},
                                         {"message", series.Message},
                                         {"incarnation", std::to_string(series.Incarnation)},
                                         {"first_stamp", std::to_string(range.First)},
                                         {"end_stamp", std::to_string(range.End)}};
    _target->PutJson(_marks, json);
}

}  // namespace Rabit::Backfill
