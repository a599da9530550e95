#include "recording/replay/ReplayPlan.h"

#include <algorithm>
#include <optional>
#include <tuple>
#include <utility>

#include "names/NamePattern.h"
#include "recording/mcap/RecordedChannel.h"

namespace Rabit::Replay
{
namespace
{

constexpr const char *FleetType = "Rabit::Gateway::Fleet";

// One channel of one file that could be played.
struct Candidate
{
    ReplayStream Stream;
    bool IsOwn = false;        // its own node recorded it, or its sender
    bool IsPublished = false;  // it was seen by others, or could be
    std::size_t File = 0;
    std::uint16_t Channel = 0;
    std::uint64_t Messages = 0;
};

// Returns a key that is the same for all recordings of one message or queue.
std::string ThingOf(const ReplayStream &stream)
{
    return std::to_string(static_cast<int>(stream.What)) + ' ' + stream.Node + ' ' + stream.Name + ' ' +
           stream.Peer + ' ' + (stream.What == ReplayStream::Kind::Queue ? stream.Type : "");
}

bool FillQueue(const Mcap::Channel &channel, const Mcap::RecordedChannel &described, Candidate &candidate)
{
    ReplayStream &stream = candidate.Stream;
    const std::string peer = Mcap::ValueOf(channel.Metadata, "rabit.peer");
    candidate.IsOwn = described.Kind == Mcap::ChannelKind::QueueSent;
    stream.What = ReplayStream::Kind::Queue;
    stream.Recorder = described.Node;
    stream.Node = candidate.IsOwn ? stream.Recorder : peer;
    stream.Peer = candidate.IsOwn ? peer : stream.Recorder;
    stream.Name = Mcap::ValueOf(channel.Metadata, "rabit.queue");
    return IsNodeName(stream.Node) && IsNodeName(stream.Peer) && IsMessageName(stream.Name);
}

bool FillMessage(const Mcap::Channel &channel, const Mcap::RecordedChannel &described,
                 const std::string &recorder, Candidate &candidate)
{
    ReplayStream &stream = candidate.Stream;
    stream.Node = described.Node;
    stream.Name = described.Message;
    stream.Qos = Mcap::ValueOf(channel.Metadata, "rabit.qos");
    candidate.IsOwn = described.Kind == Mcap::ChannelKind::Posted;
    candidate.IsPublished = stream.Qos != "none";
    stream.Recorder = described.Recorder.empty() ? recorder : described.Recorder;
    if (stream.Type == FleetType)
    {
        stream.What = ReplayStream::Kind::Fleet;
    }
    return IsNodeName(stream.Node) && IsMessageName(stream.Name) &&
           (stream.What != ReplayStream::Kind::Fleet || candidate.IsOwn);
}

bool Fill(const Mcap::Channel &channel, const std::string &recorder, Candidate &candidate)
{
    const Mcap::RecordedChannel described = Mcap::Describe(channel);
    switch (described.Kind)
    {
        case Mcap::ChannelKind::QueueSent:
        case Mcap::ChannelKind::QueueReceived:
            return FillQueue(channel, described, candidate);
        case Mcap::ChannelKind::QueueRefused:
        case Mcap::ChannelKind::Recorder:
            return false;
        case Mcap::ChannelKind::Posted:
        case Mcap::ChannelKind::Mirrored:
        case Mcap::ChannelKind::Backfilled:
        case Mcap::ChannelKind::Other:
            break;
    }
    return FillMessage(channel, described, recorder, candidate);
}

std::optional<Candidate> CandidateOf(const Mcap::Contents &contents, const Mcap::Channel &channel,
                                     const std::string &recorder)
{
    const auto schema = contents.Schemas.find(channel.SchemaId);
    if (channel.MessageEncoding != "cdr" || schema == contents.Schemas.end() ||
        schema->second.Encoding != "omgidl")
    {
        return std::nullopt;
    }
    Candidate candidate;
    candidate.Channel = channel.Id;
    candidate.Stream.Type = schema->second.Name;
    candidate.Stream.IdlText = schema->second.Data;
    const auto counted = contents.Statistics.ChannelMessageCounts.find(channel.Id);
    candidate.Messages = counted == contents.Statistics.ChannelMessageCounts.end() ? 0 : counted->second;
    return Fill(channel, recorder, candidate) ? std::optional(std::move(candidate)) : std::nullopt;
}

bool IsSelected(const Candidate &candidate, const PlanSettings &settings)
{
    const ReplayStream &stream = candidate.Stream;
    switch (stream.What)
    {
        case ReplayStream::Kind::Fleet:
            return true;
        case ReplayStream::Kind::Queue:
            return MatchesAny(settings.Queues, stream.Peer + "/" + stream.Name);
        default:
            break;
    }
    const std::string name = stream.Node + "/" + stream.Name;
    return (settings.Include.empty() ? candidate.IsPublished : MatchesAny(settings.Include, name)) &&
           !MatchesAny(settings.Exclude, name);
}

// Keeps one recorder of each message or queue: its own node, or else the recorder with most messages.
std::vector<Candidate> OneRecorderEach(std::vector<Candidate> candidates)
{
    std::map<std::pair<std::string, std::string>, std::uint64_t> counts;       // by thing and recorder
    std::map<std::string, std::tuple<bool, std::uint64_t, std::string>> best;  // by thing
    for (const Candidate &candidate : candidates)
    {
        counts[{ThingOf(candidate.Stream), candidate.Stream.Recorder}] += candidate.Messages;
    }
    for (const Candidate &candidate : candidates)
    {
        const std::string thing = ThingOf(candidate.Stream);
        const std::string &recorder = candidate.Stream.Recorder;
        const std::tuple rank(candidate.IsOwn, counts[{thing, recorder}], recorder);
        const auto [known, isNew] = best.try_emplace(thing, rank);
        known->second = isNew ? rank : std::max(known->second, rank);
    }
    std::erase_if(candidates, [&](const Candidate &candidate)
                  { return std::get<2>(best[ThingOf(candidate.Stream)]) != candidate.Stream.Recorder; });
    return candidates;
}

// True if a node is played even if none of its messages is.
bool IsNodeSelected(const std::string &node, const PlanSettings &settings)
{
    const std::string name = node + "/";
    return (settings.Include.empty() || MatchesAny(settings.Include, name)) &&
           !MatchesAny(settings.Exclude, name);
}

// Adds the node that recorded a file, or a part of a merged one, and its domain.
void TakeRecorder(const Mcap::TextMap &about, const PlanSettings &settings, ReplayPlan &plan)
{
    const std::string node = Mcap::ValueOf(about, "node");
    const std::string domain = Mcap::ValueOf(about, "domain");
    if (!domain.empty())
    {
        plan.Domains.insert(domain);
    }
    if (IsNodeName(node) && Mcap::ValueOf(about, "kind").empty() && IsNodeSelected(node, settings))
    {
        plan.Nodes.insert(node);
    }
}

// Returns the selected channels of all files. Adds nodes and domains to the plan.
std::vector<Candidate> CandidatesOf(const std::vector<const Mcap::Contents *> &files,
                                    const PlanSettings &settings, ReplayPlan &plan)
{
    std::vector<Candidate> candidates;
    for (std::size_t file = 0; file < files.size(); ++file)
    {
        std::string recorder;
        for (const Mcap::Metadata &metadata : files[file]->MetadataRecords)
        {
            if (metadata.Name == "rabit.node" || metadata.Name == "rabit.recording")
            {
                recorder = Mcap::ValueOf(metadata.Values, "node");
                TakeRecorder(metadata.Values, settings, plan);
            }
        }
        for (const auto &[id, channel] : files[file]->Channels)
        {
            auto candidate = CandidateOf(*files[file], channel, recorder);
            if (candidate && IsSelected(*candidate, settings))
            {
                candidate->File = file;
                candidates.push_back(std::move(*candidate));
            }
        }
    }
    return candidates;
}

}  // namespace

ReplayPlan PlanReplay(const std::vector<const Mcap::Contents *> &files, const PlanSettings &settings)
{
    ReplayPlan plan;
    plan.Channels.resize(files.size());
    std::map<std::string, std::size_t> known;  // streams
    for (Candidate &candidate : OneRecorderEach(CandidatesOf(files, settings, plan)))
    {
        ReplayStream &stream = candidate.Stream;
        const std::string key = ThingOf(stream) + ' ' + stream.Type + ' ' + stream.IdlText;
        const auto [entry, isNew] = known.try_emplace(key, plan.Streams.size());
        plan.Channels[candidate.File][candidate.Channel] = entry->second;
        if (stream.What != ReplayStream::Kind::Fleet)
        {
            plan.Nodes.insert(stream.Node);
        }
        if (isNew)
        {
            plan.Streams.push_back(std::move(stream));
        }
    }
    return plan;
}

}  // namespace Rabit::Replay
