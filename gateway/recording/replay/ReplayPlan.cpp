#include "recording/replay/ReplayPlan.h"

#include <rabit/base/ListedNames.h>
#include <rabit/gateway/NamePattern.h>
#include <rabit/gateway/SchemaText.h>
#include <rabit/mcap/RecordedChannel.h>

#include <algorithm>
#include <optional>
#include <tuple>
#include <utility>

#include "recording/replay/RecordingLacks.h"

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

bool HasCdr(const Mcap::Contents &contents, const Mcap::Channel &channel)
{
    const auto schema = contents.Schemas.find(channel.SchemaId);
    return channel.MessageEncoding == "cdr" && schema != contents.Schemas.end() &&
           schema->second.Encoding == "omgidl";
}

std::optional<Candidate> CandidateOf(const Mcap::Contents &contents, const Mcap::Channel &channel,
                                     const std::string &recorder)
{
    if (!HasCdr(contents, channel))
    {
        return std::nullopt;
    }
    const Mcap::Schema &schema = contents.Schemas.at(channel.SchemaId);
    Candidate candidate;
    candidate.Channel = channel.Id;
    candidate.Stream.Type = schema.Name;
    // Older recordings have names such as `_String` escaped.
    candidate.Stream.IdlText = SchemaText(schema.Data);
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

// All recordings of one message or queue.
struct Recordings
{
    struct Count
    {
        bool IsOwn = false;
        std::uint64_t Messages = 0;
        std::uint64_t Channels = 0;
    };
    const ReplayStream *Stream = nullptr;
    std::map<std::string, Count> Of;  // by recorder
    std::string Best;                 // the recorder whose recording is played
};

// Returns a line about the gap in the played recording of one message or queue; empty: there is none.
// `recorders` has each node whose own recording is among the files.
std::string LackOf(const Recordings &recordings, const std::set<std::string> &recorders)
{
    const ReplayStream &stream = *recordings.Stream;
    const Recordings::Count &best = recordings.Of.at(recordings.Best);
    const std::string name = stream.What == ReplayStream::Kind::Queue
                                 ? stream.Peer + "/" + stream.Name + ", from " + stream.Node
                                 : stream.Node + "/" + stream.Name;
    if (!best.IsOwn)
    {
        return recorders.count(stream.Node) == 0 ? ""
                                                 : name + ": not in the recording of " + stream.Node +
                                                       "; played as " + recordings.Best + " has it";
    }
    for (const auto &[recorder, other] : recordings.Of)
    {
        // A recorder may repeat a State at the beginning of each file.
        if (other.Messages > best.Messages + other.Channels)
        {
            return name + ": played from the recording of " + recordings.Best + ", which has " +
                   std::to_string(best.Messages) + " messages, though that of " + recorder + " has " +
                   std::to_string(other.Messages);
        }
    }
    return "";
}

// Keeps one recorder of each message or queue: its own node, or else the recorder with most messages. Adds
// what its recording lacks.
std::vector<Candidate> OneRecorderEach(std::vector<Candidate> candidates,
                                       const std::set<std::string> &recorders,
                                       std::vector<std::string> &lacks)
{
    std::map<std::string, Recordings> things;
    for (const Candidate &candidate : candidates)
    {
        Recordings &recordings = things[ThingOf(candidate.Stream)];
        recordings.Stream = &candidate.Stream;
        Recordings::Count &count = recordings.Of[candidate.Stream.Recorder];
        count.IsOwn = candidate.IsOwn;
        count.Messages += candidate.Messages;
        ++count.Channels;
    }
    for (auto &[thing, recordings] : things)
    {
        const auto rank = [](const auto &entry)
        { return std::tuple(entry.second.IsOwn, entry.second.Messages, entry.first); };
        recordings.Best = std::max_element(recordings.Of.begin(), recordings.Of.end(),
                                           [&rank](const auto &left, const auto &right)
                                           { return rank(left) < rank(right); })
                              ->first;
        if (std::string lack = LackOf(recordings, recorders); !lack.empty())
        {
            lacks.push_back(std::move(lack));
        }
    }
    std::erase_if(candidates, [&things](const Candidate &candidate)
                  { return things[ThingOf(candidate.Stream)].Best != candidate.Stream.Recorder; });
    return candidates;
}

// True if a node is played even if none of its messages is.
bool IsNodeSelected(const std::string &node, const PlanSettings &settings)
{
    const std::string name = node + "/";
    return (settings.Include.empty() || MatchesAny(settings.Include, name)) &&
           !MatchesAny(settings.Exclude, name);
}

// Selected channels of all files, and each node whose own recording is among them.
struct Selection
{
    std::vector<Candidate> Candidates;
    std::set<std::string> Recorders;
};

// Adds the node that recorded a file, or a part of a merged one, and its domain.
void TakeRecorder(const Mcap::TextMap &about, const PlanSettings &settings, Selection &selection,
                  ReplayPlan &plan)
{
    const std::string node = Mcap::ValueOf(about, "node");
    const std::string domain = Mcap::ValueOf(about, "domain");
    if (!domain.empty())
    {
        plan.Domains.insert(domain);
    }
    if (IsNodeName(node) && Mcap::ValueOf(about, "kind").empty())
    {
        selection.Recorders.insert(node);
        if (IsNodeSelected(node, settings))
        {
            plan.Nodes.insert(node);
        }
    }
}

// Adds what the files themselves tell that they lack, and the topics that cannot be played.
void AddLacks(const std::vector<const Mcap::Contents *> &files, ReplayPlan &plan)
{
    RecordingLacks lacks;
    std::set<std::string> topics;
    for (const Mcap::Contents *file : files)
    {
        lacks.Add(*file);
        for (const auto &[id, channel] : file->Channels)
        {
            if (Mcap::Describe(channel).Kind != Mcap::ChannelKind::Recorder && !HasCdr(*file, channel))
            {
                topics.insert(channel.Topic);
            }
        }
    }
    plan.Lacks = lacks.Messages();
    const std::vector<std::string> missing = lacks.Files();
    plan.Lacks.insert(plan.Lacks.end(), missing.begin(), missing.end());
    if (!topics.empty())
    {
        plan.Lacks.push_back("without CDR and the IDL of their types, and not played: " +
                             ListedNames(std::vector<std::string>(topics.begin(), topics.end())));
    }
}

// Adds nodes and domains to the plan.
Selection SelectionOf(const std::vector<const Mcap::Contents *> &files, const PlanSettings &settings,
                      ReplayPlan &plan)
{
    Selection selection;
    for (std::size_t file = 0; file < files.size(); ++file)
    {
        std::string recorder;
        for (const Mcap::Metadata &metadata : files[file]->MetadataRecords)
        {
            if (metadata.Name == "rabit.node" || metadata.Name == "rabit.recording")
            {
                recorder = Mcap::ValueOf(metadata.Values, "node");
                TakeRecorder(metadata.Values, settings, selection, plan);
            }
        }
        for (const auto &[id, channel] : files[file]->Channels)
        {
            auto candidate = CandidateOf(*files[file], channel, recorder);
            if (candidate && IsSelected(*candidate, settings))
            {
                candidate->File = file;
                selection.Candidates.push_back(std::move(*candidate));
            }
        }
    }
    return selection;
}

}  // namespace

ReplayPlan PlanReplay(const std::vector<const Mcap::Contents *> &files, const PlanSettings &settings)
{
    ReplayPlan plan;
    plan.Channels.resize(files.size());
    AddLacks(files, plan);
    Selection selection = SelectionOf(files, settings, plan);
    std::map<std::string, std::size_t> known;  // streams
    for (Candidate &candidate :
         OneRecorderEach(std::move(selection.Candidates), selection.Recorders, plan.Lacks))
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
