#include "recording/merge/Merger.h"

#include <rabit/base/NumberIn.h>

#include <nlohmann/json.hpp>

#include <algorithm>
#include <utility>

namespace Rabit::Merge
{
namespace
{

using Json = nlohmann::ordered_json;

constexpr Moment TellPeriod = 10 * OneSecond;
// A chunk ends after this time, so that a few large messages do not keep it open for long.
constexpr Moment LongestChunk = 10 * OneSecond;
constexpr std::uint64_t MessagesBetweenLooks = 1000;

std::string TextOf(const Json &json)
{
    return json.dump(-1, ' ', true, Json::error_handler_t::replace);
}

const char *NameOf(PlannedLife::Way way)
{
    switch (way)
    {
        case PlannedLife::Way::TimeLine:
            return "time line";
        case PlannedLife::Way::Relations:
            return "relations";
        default:
            return "wall clock";
    }
}

std::string TextOf(std::optional<Moment> bound)
{
    return bound ? std::to_string(*bound) : "not known";
}

// Puts the time within a log line, which Foxglove's panel shows, on the time line.
std::optional<Mcap::Bytes> ShiftLogLine(Mcap::ByteView bytes, const TimeMap &map)
{
    Json json = Json::parse(bytes.begin(), bytes.end(), nullptr, false);
    const Json::json_pointer sec("/timestamp/sec");
    const Json::json_pointer nsec("/timestamp/nsec");
    if (!json.contains(sec) || !json.contains(nsec) || !json[sec].is_number_integer() ||
        !json[nsec].is_number_integer())
    {
        return std::nullopt;
    }
    const Moment most = FarthestMoment / OneSecond;
    const Moment seconds = std::clamp(json[sec].get<Moment>(), -most, most);
    const Moment at = map.At(Within(seconds * OneSecond + Within(json[nsec].get<Moment>())));
    const std::uint64_t shown = ToFile(at);
    json[sec] = shown / static_cast<std::uint64_t>(OneSecond);
    json[nsec] = shown % static_cast<std::uint64_t>(OneSecond);
    const std::string text = TextOf(json);
    return Mcap::Bytes(text.begin(), text.end());
}

}  // namespace

// A file, and its next message.
struct Merger::Stream
{
    std::size_t Life = 0;
    std::size_t Order = 0;
    const LifeFile *File = nullptr;
    Moment At = 0;  // on the time line: of the message, or the beginning of the file
    std::unique_ptr<Mcap::ByteSource> Source;
    std::unique_ptr<Mcap::MessageCursor> Cursor;
    Mcap::Message Message;
    std::map<std::uint16_t, std::optional<MergedChannels::Made>> Channels;
};

bool Merger::Later::operator()(const std::unique_ptr<Stream> &left,
                               const std::unique_ptr<Stream> &right) const
{
    return std::pair(left->At, left->Order) > std::pair(right->At, right->Order);
}

Merger::Merger(const OpenFile &open, const Lives &lives, const MergePlan &plan, Mcap::McapWriter &writer)
    : _open(open), _lives(lives), _plan(plan), _writer(writer), _channels(lives, plan, writer)
{
    _merged.Messages.resize(lives.All.size());
    _tellAt.resize(lives.All.size(), -FarthestMoment);
    for (std::size_t life = 0; life < lives.All.size(); ++life)
    {
        for (const LifeFile &file : lives.All[life].Files)
        {
            auto stream = std::make_unique<Stream>();
            stream->Life = life;
            stream->Order = _waiting.size();
            stream->File = &file;
            stream->At = plan.Lives[life].Map.At(file.Begin);
            _waiting.push_back(std::move(stream));
        }
    }
    std::sort(_waiting.begin(), _waiting.end(), Later());
}

Merger::~Merger() = default;

Merged Merger::Run(const std::function<bool()> &stops)
{
    Moment chunksSince = -FarthestMoment;
    std::uint64_t written = 0;
    while (!_waiting.empty() || !_streams.empty())
    {
        if (!_waiting.empty() && (_streams.empty() || _waiting.back()->At <= _streams.front()->At))
        {
            Open();
            continue;
        }
        std::pop_heap(_streams.begin(), _streams.end(), Later());
        auto stream = std::move(_streams.back());
        _streams.pop_back();
        if (stream->At - chunksSince > LongestChunk)
        {
            chunksSince = stream->At;
            _writer.FinishChunks();
        }
        Write(*stream);
        Advance(std::move(stream));
        if (!_writer.IsGood())
        {
            return _merged;
        }
        if (++written % MessagesBetweenLooks == 0 && stops())
        {
            _merged.WasStopped = true;
            return _merged;
        }
    }
    WriteMetadata();
    _merged.IsWritten = _writer.Finish();
    return _merged;
}

void Merger::Open()
{
    auto stream = std::move(_waiting.back());
    _waiting.pop_back();
    stream->Source = _open(stream->File->Path);
    stream->Cursor = std::make_unique<Mcap::MessageCursor>(*stream->Source, stream->File->Contents,
                                                           Mcap::MessageCursor::Selection());
    Advance(std::move(stream));
}

void Merger::Advance(std::unique_ptr<Stream> stream)
{
    if (const auto message = stream->Cursor->Next())
    {
        stream->Message = *message;
        stream->At = _plan.Lives[stream->Life].Map.At(FromFile(message->LogTime));
        _streams.push_back(std::move(stream));
        std::push_heap(_streams.begin(), _streams.end(), Later());
        return;
    }
    for (const std::string &problem : stream->Cursor->Problems())
    {
        _merged.Problems.push_back(stream->File->Path + ": " + problem);
    }
}

void Merger::Write(Stream &stream)
{
    const auto [channel, isNew] = stream.Channels.try_emplace(stream.Message.ChannelId);
    if (isNew)
    {
        channel->second = _channels.Of(stream.Life, stream.File->Contents, stream.Message.ChannelId);
    }
    if (!channel->second)
    {
        ++_merged.Lost;
        return;
    }
    if (IsRepeated(stream, channel->second->Number))
    {
        ++_merged.Repeated;
        return;
    }
    TellTimeLine(stream.Life, stream.At, FromFile(stream.Message.LogTime));
    Mcap::Message message = stream.Message;
    message.ChannelId = channel->second->Number;
    message.LogTime = ToFile(stream.At);
    message.PublishTime = ToFile(_plan.Lives[stream.Life].Map.At(FromFile(stream.Message.PublishTime)));
    const Mcap::Bytes changed = OnTimeLine(stream, channel->second->Times);
    if (!changed.empty())
    {
        message.Data = changed;
    }
    if (_writer.Add(message))
    {
        ++_merged.Messages[stream.Life];
    }
    else
    {
        ++_merged.Lost;
    }
}

// True for a state that is repeated at the beginning of a file, so that the file can be understood alone.
bool Merger::IsRepeated(const Stream &stream, std::uint16_t channel)
{
    const auto [last, isFirst] = _lastPublishTime.try_emplace(channel, stream.Message.PublishTime);
    const bool isSame = !isFirst && last->second == stream.Message.PublishTime;
    last->second = stream.Message.PublishTime;
    return isSame && FromFile(stream.Message.LogTime) == stream.File->Begin &&
           stream.File != &_lives.All[stream.Life].Files.front();
}

// Returns the data of a message with its times on the time line; empty if the data stays as it is.
Mcap::Bytes Merger::OnTimeLine(const Stream &stream, MergedChannels::Inside inside) const
{
    const TimeMap &map = _plan.Lives[stream.Life].Map;
    std::optional<Mcap::Bytes> changed;
    if (inside == MergedChannels::Inside::Clocks)
    {
        changed = ShiftClockReport(stream.Message.Data, stream.At - FromFile(stream.Message.LogTime));
    }
    else if (inside == MergedChannels::Inside::LogLine)
    {
        changed = ShiftLogLine(stream.Message.Data, map);
    }
    return changed.value_or(Mcap::Bytes());
}

void Merger::TellTimeLine(std::size_t life, Moment at, Moment logTime)
{
    if (at < _tellAt[life])
    {
        return;
    }
    _tellAt[life] = at + TellPeriod;
    const auto channel = _channels.TimeLineOf(life);
    if (!channel)
    {
        return;
    }
    const PlannedLife &planned = _plan.Lives[life];
    const auto bound = planned.Map.BoundAt(logTime);
    Json by = Json::array();
    for (const ClockGraph::Clock clock : planned.Map.By())
    {
        by.push_back(_lives.Graph.NodeOf(clock));
    }
    const std::string text = TextOf(Json{{"life", planned.Number},
                                         {"incarnation", std::to_string(_lives.All[life].Incarnation)},
                                         {"clock", NameOf(planned.By)},
                                         {"by", by},
                                         {"later_by_ns", std::to_string(at - logTime)},
                                         {"uncertain_by_ns", bound ? Json(*bound) : Json()}});
    const Mcap::Bytes data(text.begin(), text.end());
    _writer.Add({*channel, 0, ToFile(at), ToFile(at), data});
    ++_merged.TimeLines;
}

void Merger::WriteMetadata()
{
    std::map<std::string, std::uint64_t> lost;
    std::size_t files = 0;
    for (std::size_t life = 0; life < _lives.All.size(); ++life)
    {
        files += _lives.All[life].Files.size();
        WriteLife(life, lost);
    }
    Mcap::TextMap losses;
    for (const auto &[topic, count] : lost)
    {
        losses[topic] = std::to_string(count);
    }
    if (!losses.empty())
    {
        _writer.AddMetadata({"rabit.losses", losses});
    }
    _writer.AddMetadata({"rabit.merge",
                         {{"time_line", _lives.All[_plan.TimeLine].Node},
                          {"time_line_life", std::to_string(_plan.Lives[_plan.TimeLine].Number)},
                          {"lives", std::to_string(_lives.All.size())},
                          {"files", std::to_string(files)},
                          {"uncertain_by_ns", TextOf(_plan.WorstBound())}}});
}

void Merger::WriteLife(std::size_t life, std::map<std::string, std::uint64_t> &lost)
{
    const Life &recorded = _lives.All[life];
    const PlannedLife &planned = _plan.Lives[life];
    Mcap::TextMap values = MetadataOf(recorded.Files.front().Contents, "rabit.node");
    values["node"] = recorded.Node;
    values["life"] = std::to_string(planned.Number);
    values["begin_ns"] = std::to_string(planned.Map.At(recorded.Begin));
    values["end_ns"] = std::to_string(planned.Map.At(recorded.End));
    values["messages"] = std::to_string(_merged.Messages[life]);
    values["clock"] = NameOf(planned.By);
    values["uncertain_by_ns"] = TextOf(planned.Map.WorstBound());
    values["uncertain_by_median_ns"] = TextOf(planned.Map.MedianBound());
    if (recorded.Clock)
    {
        values["incarnation"] = std::to_string(recorded.Incarnation);
    }
    for (const LifeFile &file : recorded.Files)
    {
        std::string &files = values["files"];
        files += (files.empty() ? "" : "\n") + file.Path;
    }
    for (const ClockGraph::Clock clock : planned.Map.By())
    {
        std::string &by = values["by"];
        by += (by.empty() ? "" : " ") + _lives.Graph.NodeOf(clock);
    }
    _writer.AddMetadata({"rabit.recording", values});
    WriteCopy(life, "rabit.configuration");
    WriteCopy(life, "rabit.not_recorded");

    // Losses are counted by topic since the beginning of the recording, so the last file has the sums.
    std::map<std::string, std::string> topics;
    Mcap::TextMap losses;
    for (const LifeFile &file : recorded.Files)
    {
        for (const auto &[id, channel] : file.Contents.Channels)
        {
            topics[channel.Topic] = _channels.TopicOf(life, channel);
        }
        const Mcap::TextMap ofFile = MetadataOf(file.Contents, "rabit.losses");
        losses = ofFile.empty() ? losses : ofFile;
    }
    for (const auto &[topic, text] : losses)
    {
        const auto known = topics.find(topic);
        lost[known == topics.end() ? topic : known->second] += NumberIn<std::uint64_t>(text).value_or(0);
    }
}

void Merger::WriteCopy(std::size_t life, const std::string &name)
{
    Mcap::TextMap values;
    for (const LifeFile &file : _lives.All[life].Files)
    {
        Mcap::TextMap ofFile = MetadataOf(file.Contents, name);
        values = ofFile.empty() ? values : std::move(ofFile);
    }
    if (!values.empty())
    {
        values["node"] = _lives.All[life].Node;
        values["life"] = std::to_string(_plan.Lives[life].Number);
        _writer.AddMetadata({name, values});
    }
}

}  // namespace Rabit::Merge
