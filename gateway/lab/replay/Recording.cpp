#include "Recording.h"

#include <rabit/base/NumberIn.h>
#include <rabit/dynamic/DynamicType.h>
#include <rabit/gateway/LoadGatewayConfig.h>
#include <rabit/gateway/NamePattern.h>
#include <rabit/gateway/QosProfileWords.h>
#include <rabit/idl/MessageTypeRegistry.h>
#include <rabit/mcap/MessageCursor.h>
#include <rabit/mcap/RecordedChannel.h>

#include <algorithm>
#include <limits>
#include <set>
#include <stdexcept>

namespace Rabit::WhatIf
{
namespace
{

constexpr const char *FleetType = "Rabit::Gateway::Fleet";
// How long a node that did not record is there before its first message, to meet the others, and after its
// last.
constexpr Time BeforeFirst = 6'000'000'000;
constexpr Time AfterLast = 2'000'000'000;
// Nodes that end this shortly before the last one, in nanoseconds, were told to end with it.
constexpr Time EndsTogether = 2'000'000'000;

bool IsKnown(const std::string &type)
{
    return MessageTypeRegistry::Find(type) != nullptr;
}

// The node that recorded a channel.
std::string RecorderOf(const Mcap::Contents &contents, const Mcap::Channel &channel)
{
    const std::string merged = Mcap::ValueOf(channel.Metadata, "rabit.recorded_by");
    return merged.empty() ? Mcap::ValueOf(Mcap::MetadataOf(contents, "rabit.node"), "node") : merged;
}

Time TimeIn(const Mcap::TextMap &values, const std::string &key)
{
    return NumberIn<Time>(Mcap::ValueOf(values, key)).value_or(0);
}

template <typename Rule>
Rule *RuleFor(std::vector<Rule> &rules, const std::string &message)
{
    const auto found = std::find_if(rules.begin(), rules.end(),
                                    [&message](const Rule &rule) { return rule.Message == message; });
    return found == rules.end() ? nullptr : &*found;
}

// Takes out the settings that a simulated network does not have.
void FitToSimulation(GatewayConfig &config)
{
    config.Paths.clear();
    config.Security.reset();
    config.Record.reset();
    config.Fetch.reset();
    config.Interfaces.clear();
    config.Foreign.clear();
    config.Panels.clear();
    config.StateDir.clear();
    config.BackendConfig.clear();
    config.File.clear();
    std::erase_if(config.Publish, [](const PublishRule &rule) { return !IsKnown(rule.Type); });
    std::erase_if(config.Subscribe, [](const SubscribeRule &rule) { return !IsKnown(rule.Type); });
    for (AcceptRule &rule : config.Accept)
    {
        std::erase_if(rule.Types, [](const std::string &type) { return !IsKnown(type); });
    }
    std::erase_if(config.Accept, [](const AcceptRule &rule) { return rule.Types.empty(); });
}

}  // namespace

Recording::Recording(const std::vector<std::string> &names) : _names(names)
{
    std::vector<const Mcap::Contents *> contents;
    std::vector<Replay::RecordedMessages::File> files;
    for (const std::string &name : names)
    {
        _files.push_back(std::make_unique<Mcap::FileSource>(name));
        if (!Mcap::IsRecording(*_files.back()))
        {
            throw std::runtime_error(name + ": is no recording: it does not begin as an MCAP file");
        }
        _contents.push_back(std::make_unique<Mcap::Contents>(Mcap::ReadContents(*_files.back())));
        for (const std::string &problem : _contents.back()->Problems)
        {
            _notes.push_back(name + ": " + problem);
        }
        contents.push_back(_contents.back().get());
        files.push_back({_files.back().get(), contents.back()});
    }
    _plan = Replay::PlanReplay(contents, {.Queues = {"*/*"}});
    _messages = std::make_unique<Replay::RecordedMessages>(std::move(files), _plan);
    RegisterTypes();
    for (const auto &file : _contents)
    {
        FindUses(*file);
    }
    FindLives();
    if (_lives.empty())
    {
        throw std::runtime_error(names.front() +
                                 ": no node in it has messages, so nothing can be flown; name "
                                 "the flight.mcap of a run, or what `rabit merge` writes");
    }
    if (_messages->Last() - _messages->First() > Longest)
    {
        throw std::runtime_error(names.front() +
                                 ": more than a day is not flown; name fewer or shorter recordings");
    }
    if (_lives.size() > MostLives)
    {
        throw std::runtime_error(names.front() + ": it has " + std::to_string(_lives.size()) +
                                 " incarnations of nodes, and no more than " + std::to_string(MostLives) +
                                 " are flown; name fewer recordings");
    }
    if (PairSeconds() > MostPairSeconds)
    {
        throw std::runtime_error(names.front() +
                                 ": too many nodes for too long, which would take hours; name the recordings "
                                 "of fewer nodes, or shorter ones");
    }
    for (RecordedLife &life : _lives)
    {
        life.Config = ConfigOf(life);
    }
}

void Recording::RegisterTypes()
{
    std::set<std::pair<std::string, std::string>> seen;
    for (const auto &contents : _contents)
    {
        for (const auto &[id, schema] : contents->Schemas)
        {
            if (schema.Encoding != "omgidl" || schema.Name == FleetType ||
                !seen.emplace(schema.Name, schema.Data).second)
            {
                continue;
            }
            const ParsedType parsed = DynamicType::Parse(schema.Data, schema.Name);
            if (!parsed.Type)
            {
                _notes.push_back(schema.Name + " is not flown: " + parsed.Reason);
            }
            else if (DynamicType::Register(parsed.Type) == nullptr)
            {
                _notes.push_back(schema.Name + " was recorded in two versions; the second one is not flown");
            }
        }
    }
}

void Recording::FindUses(const Mcap::Contents &contents)
{
    for (const auto &[id, channel] : contents.Channels)
    {
        const auto schema = contents.Schemas.find(channel.SchemaId);
        const std::string recorder = RecorderOf(contents, channel);
        if (!IsNodeName(recorder) || schema == contents.Schemas.end() || schema->second.Name == FleetType ||
            !IsKnown(schema->second.Name))
        {
            continue;
        }
        const std::string &type = schema->second.Name;
        const Mcap::RecordedChannel described = Mcap::Describe(channel);
        const bool isFromOther =
            described.Kind == Mcap::ChannelKind::Mirrored || described.Kind == Mcap::ChannelKind::Backfilled;
        Used &used = _used[recorder];
        if (isFromOther && IsNodeName(described.Node) && IsMessageName(described.Message))
        {
            used.Receives[{described.Node, described.Message}] = type;
        }
        else if (const std::string queue = Mcap::ValueOf(channel.Metadata, "rabit.queue");
                 described.Kind == Mcap::ChannelKind::QueueReceived && IsMessageName(queue))
        {
            used.QueueTypes[queue].insert(type);
        }
    }
}

void Recording::FindLives()
{
    for (const auto &contents : _contents)
    {
        std::map<std::pair<std::string, std::string>, std::string> texts;  // by node and life
        for (const Mcap::Metadata &metadata : contents->MetadataRecords)
        {
            if (metadata.Name == "rabit.configuration")
            {
                texts[{Mcap::ValueOf(metadata.Values, "node"), Mcap::ValueOf(metadata.Values, "life")}] =
                    Mcap::ValueOf(metadata.Values, "text");
            }
        }
        bool isMerged = false;
        for (const Mcap::Metadata &metadata : contents->MetadataRecords)
        {
            if (metadata.Name == "rabit.recording")
            {
                const std::string node = Mcap::ValueOf(metadata.Values, "node");
                isMerged = true;
                AddLife({node, TimeIn(metadata.Values, "begin_ns"), TimeIn(metadata.Values, "end_ns"),
                         Mcap::ValueOf(metadata.Values, "domain"),
                         texts[{node, Mcap::ValueOf(metadata.Values, "life")}]});
            }
        }
        if (!isMerged)
        {
            const Mcap::TextMap about = Mcap::MetadataOf(*contents, "rabit.node");
            AddLife({Mcap::ValueOf(about, "node"), contents->Statistics.StartTime,
                     contents->Statistics.EndTime, Mcap::ValueOf(about, "domain"),
                     texts[std::pair(std::string(), std::string())]});
        }
    }
    AddUnrecorded();
    std::stable_sort(_lives.begin(), _lives.end(),
                     [](const RecordedLife &one, const RecordedLife &other)
                     { return one.Begin < other.Begin; });
}

// Files that follow each other are parts of one recording.
void Recording::AddLife(RecordedLife life)
{
    constexpr Time longestPause = 2'000'000'000;
    if (!IsNodeName(life.Node) || life.End < life.Begin || life.End == 0)
    {
        return;
    }
    for (RecordedLife &known : _lives)
    {
        if (known.Node == life.Node && life.Begin <= known.End + longestPause &&
            known.Begin <= life.End + longestPause && known.Configuration == life.Configuration &&
            _names.size() > 1)
        {
            known.Begin = std::min(known.Begin, life.Begin);
            known.End = std::max(known.End, life.End);
            return;
        }
    }
    _lives.push_back(std::move(life));
}

Time Recording::Begin() const
{
    return _messages->First();
}

Time Recording::End() const
{
    const Time last = _messages->Last();
    Time end = last;
    for (const RecordedLife &life : _lives)
    {
        end = life.End + EndsTogether > last ? std::min(end, life.End) : end;
    }
    return std::max(Begin(), end);
}

double Recording::PairSeconds() const
{
    double together = 0;
    for (const RecordedLife &one : _lives)
    {
        for (const RecordedLife &other : _lives)
        {
            const Time begin = std::max({one.Begin, other.Begin, _messages->First()});
            const Time end = std::min({one.End, other.End, _messages->Last()});
            together += end > begin ? 1e-9 * static_cast<double>(end - begin) : 0;
        }
    }
    return together;
}

void Recording::AddUnrecorded()
{
    std::map<std::string, std::pair<Time, Time>> spans;
    for (const std::string &node : _plan.Nodes)
    {
        if (std::none_of(_lives.begin(), _lives.end(),
                         [&node](const RecordedLife &life) { return life.Node == node; }))
        {
            spans[node] = {0, 0};
        }
    }
    if (spans.empty())
    {
        return;
    }
    _messages->Begin(_messages->First());
    while (const auto item = _messages->Next())
    {
        const auto span = spans.find(_plan.Streams[item->Stream].Node);
        if (span != spans.end())
        {
            auto &[first, last] = span->second;
            first = first == 0 ? item->LogTime : first;
            last = item->LogTime;
        }
    }
    for (const auto &[node, span] : spans)
    {
        _notes.push_back(node +
                         " did not record itself: only those of its messages are flown that another "
                         "node received");
        AddLife({node, std::max(_messages->First() + BeforeFirst, span.first) - BeforeFirst,
                 std::min(_messages->Last(), span.second + AfterLast),
                 _plan.Domains.empty() ? "" : *_plan.Domains.begin()});
    }
}

GatewayConfig Recording::ConfigOf(const RecordedLife &life)
{
    GatewayConfig config;
    if (!life.Configuration.empty())
    {
        try
        {
            // Types that the recording does not have are taken out below.
            const GatewayConfig read =
                ParseGatewayConfig(life.Configuration, "its recorded configuration", life.Node,
                                   [](const std::string &) { return std::string(); });
            config = PathConfigsOf(read).front();
        }
        catch (const ConfigError &error)
        {
            _notes.push_back(life.Node + " flies by what it used, since this version does not accept " +
                             error.what());
        }
    }
    config.Node = life.Node;
    config.Domain = NumberIn<int>(life.Domain).value_or(config.Domain);
    FitToSimulation(config);
    for (const Replay::ReplayStream &stream : _plan.Streams)
    {
        if (stream.What == Replay::ReplayStream::Kind::Message && stream.Node == life.Node &&
            IsKnown(stream.Type) && RuleFor(config.Publish, stream.Name) == nullptr)
        {
            config.Publish.push_back({.Message = stream.Name,
                                      .Type = stream.Type,
                                      .Qos = ProfileOf(stream.Qos).value_or(QosProfile::State)});
        }
    }
    const Used &used = _used[life.Node];
    for (const auto &[stream, type] : used.Receives)
    {
        SubscribeRule *const known = RuleFor(config.Subscribe, stream.second);
        if (known == nullptr)
        {
            config.Subscribe.push_back({.Message = stream.second, .Type = type, .From = {stream.first}});
        }
        else if (known->Type == type && !MatchesAny(known->From, stream.first))
        {
            known->From.push_back(stream.first);
        }
    }
    for (const auto &[queue, types] : used.QueueTypes)
    {
        if (std::none_of(config.Accept.begin(), config.Accept.end(),
                         [&name = queue](const AcceptRule &known) { return known.Queue == name; }))
        {
            config.Accept.push_back({.Queue = queue, .Types = {types.begin(), types.end()}});
        }
    }
    return config;
}

std::map<std::string, std::map<Recording::Stream, std::vector<Recording::Arrival>>> Recording::Arrivals()
    const
{
    std::map<std::string, std::map<Stream, std::vector<Arrival>>> arrivals;
    for (std::size_t file = 0; file < _files.size(); ++file)
    {
        const Mcap::Contents &contents = *_contents[file];
        const auto wants = [&contents](std::uint16_t channel)
        {
            const auto found = contents.Channels.find(channel);
            return found != contents.Channels.end() &&
                   Mcap::Describe(found->second).Kind == Mcap::ChannelKind::Mirrored;
        };
        Mcap::MessageCursor cursor(*_files[file], contents, {.Wants = wants});
        while (const auto message = cursor.Next())
        {
            const Mcap::Channel &channel = contents.Channels.at(message->ChannelId);
            const Mcap::RecordedChannel described = Mcap::Describe(channel);
            arrivals[RecorderOf(contents, channel)][{described.Node, described.Message}].push_back(
                {message->LogTime, message->PublishTime});
        }
    }
    return arrivals;
}

}  // namespace Rabit::WhatIf
