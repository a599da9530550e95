// rabit info: the contents of recordings.
#include <rabit/base/NaturalOrder.h>
#include <rabit/base/UtcText.h>
#include <rabit/mcap/FileSource.h>
#include <rabit/mcap/McapContents.h>

#include <algorithm>
#include <cstdlib>
#include <ctime>
#include <map>

#include "Command.h"
#include "PlayedFiles.h"
#include "SafeText.h"
#include "Table.h"
#include "recording/replay/RecordingLacks.h"

namespace Rabit::Tool
{
namespace InfoParts
{
namespace
{

using Mcap::Contents;

struct Options
{
    std::vector<std::string> Files;
    bool Scan = false;
    bool Json = false;
};

double SecondsOf(const Contents &contents)
{
    return 1e-9 * static_cast<double>(contents.Statistics.EndTime - contents.Statistics.StartTime);
}

std::string DateOf(std::uint64_t time)
{
    return UtcText(static_cast<std::time_t>(time / 1000000000), "%Y-%m-%d %H:%M:%S UTC");
}

// Returns a line about a merged file.
std::string MergeText(const Mcap::TextMap &merge)
{
    const std::string bound = Mcap::ValueOf(merge, "uncertain_by_ns");
    const bool isKnown = !bound.empty() && bound.find_first_not_of("0123456789") == std::string::npos;
    return Mcap::ValueOf(merge, "lives") + " recordings of " + Mcap::ValueOf(merge, "files") +
           " files by the clock of " + Mcap::ValueOf(merge, "time_line") +
           (isKnown ? ", wrong by " + NumberText(1e-6 * std::strtod(bound.c_str(), nullptr), 2, " ms at most")
                    : ", how wrong is not known");
}

struct Topic
{
    std::string Name;
    std::string Type;
    std::string Encoding;
    std::uint64_t Messages = 0;
    std::string Life;  // of a merged file: the node that recorded it, and the number of its life
    std::uint16_t Channel = 0;
};

std::vector<Topic> TopicsOf(const Contents &contents)
{
    std::vector<Topic> topics;
    for (const auto &[id, channel] : contents.Channels)
    {
        const auto schema = contents.Schemas.find(channel.SchemaId);
        const auto count = contents.Statistics.ChannelMessageCounts.find(id);
        const std::string recorder = Mcap::ValueOf(channel.Metadata, "rabit.recorded_by");
        topics.push_back(
            {channel.Topic, schema == contents.Schemas.end() ? "" : schema->second.Name,
             channel.MessageEncoding,
             count == contents.Statistics.ChannelMessageCounts.end() ? 0 : count->second,
             recorder.empty() ? "" : recorder + " " + Mcap::ValueOf(channel.Metadata, "rabit.life"), id});
    }
    std::sort(topics.begin(), topics.end(),
              [](const Topic &left, const Topic &right)
              {
                  const NaturalOrder isBefore;
                  return left.Name != right.Name ? isBefore(left.Name, right.Name)
                                                 : isBefore(left.Life, right.Life);
              });
    return topics;
}

bool ShowJson(const std::string &file, std::uint64_t size, const Contents &contents)
{
    Json topics = Json::array();
    for (const Topic &topic : TopicsOf(contents))
    {
        topics.push_back({{"topic", topic.Name},
                          {"type", topic.Type},
                          {"encoding", topic.Encoding},
                          {"messages", topic.Messages}});
        if (!topic.Life.empty())
        {
            topics.back()["life"] = topic.Life;
        }
    }
    Json lost = Json::object();
    for (const auto &[topic, count] : MetadataOf(contents, "rabit.losses"))
    {
        lost[topic] = count;
    }
    return Output::Object({{"file", file},
                           {"bytes", size},
                           {"ended", contents.IsIndexed},
                           {"node", Mcap::ValueOf(MetadataOf(contents, "rabit.node"), "node")},
                           {"begin_ns", std::to_string(contents.Statistics.StartTime)},
                           {"end_ns", std::to_string(contents.Statistics.EndTime)},
                           {"messages", contents.Statistics.MessageCount},
                           {"chunks", contents.Chunks.size()},
                           {"topics", topics},
                           {"lost", lost},
                           {"problems", contents.Problems}});
}

bool ShowText(const std::string &file, Mcap::ByteSource &source, const Contents &contents)
{
    const double seconds = SecondsOf(contents);
    const Mcap::TextMap node = MetadataOf(contents, "rabit.node");
    std::vector<std::vector<std::string>> head;
    head.push_back({"file", SafeText(file)});
    head.push_back({"size", NumberText(1e-6 * static_cast<double>(source.Size()), 3, " MB")});
    if (!node.empty())
    {
        std::string text = Mcap::ValueOf(node, "node");
        for (const char *key : {"host", "process", "version"})
        {
            text += node.count(key) == 0 ? "" : std::string(", ") + key + " " + node.at(key);
        }
        head.push_back({"node", SafeText(text)});
    }
    if (const Mcap::TextMap merge = MetadataOf(contents, "rabit.merge"); !merge.empty())
    {
        head.push_back({"merged", SafeText(MergeText(merge))});
    }
    if (contents.Statistics.MessageCount > 0)
    {
        head.push_back({"begins", DateOf(contents.Statistics.StartTime)});
        head.push_back({"lasts", NumberText(seconds, 1, " s")});
    }
    head.push_back({"messages", std::to_string(contents.Statistics.MessageCount) + " in " +
                                    std::to_string(contents.Chunks.size()) + " chunks"});
    std::vector<std::string> lines = TableLines(head);
    Replay::RecordingLacks lacks;
    lacks.Add(contents);
    for (const std::string &lack : lacks.Messages())
    {
        lines.push_back("! " + SafeText(lack));
    }
    for (const std::string &problem : contents.Problems)
    {
        lines.push_back("! " + SafeText(problem));
    }
    lines.emplace_back();
    std::vector<std::vector<std::string>> table = {{"TOPIC", "TYPE", "MESSAGES", "RATE"}};
    const std::vector<Topic> topics = TopicsOf(contents);
    const bool isMerged =
        std::any_of(topics.begin(), topics.end(), [](const Topic &topic) { return !topic.Life.empty(); });
    if (isMerged)
    {
        table.front().emplace_back("LIFE");
    }
    for (const Topic &topic : topics)
    {
        const auto rate = Mcap::RateOf(source, contents, topic.Channel);
        table.push_back({SafeText(topic.Name), SafeText(topic.Type), std::to_string(topic.Messages),
                         rate ? NumberText(*rate, 2, " Hz") : "-"});
        if (isMerged)
        {
            table.back().push_back(SafeText(topic.Life));
        }
    }
    const std::vector<std::string> rows = TableLines(table);
    lines.insert(lines.end(), rows.begin(), rows.end());
    return Output::Lines(lines);
}

int Run(const Options &options)
{
    bool good = true;
    for (const std::string &file : options.Files)
    {
        Mcap::FileSource source(file);
        if (!options.Json && !Mcap::IsRecording(source))
        {
            Output::Talk(NoRecording(file));
            good = false;
            continue;
        }
        const Contents contents = options.Scan ? Mcap::ScanContents(source) : Mcap::ReadContents(source);
        good = good && contents.Problems.empty() && MetadataOf(contents, "rabit.losses").empty();
        if (!(options.Json ? ShowJson(file, source.Size(), contents) : ShowText(file, source, contents)))
        {
            return Good;
        }
    }
    return good ? Good : ProblemFound;
}

}  // namespace
}  // namespace InfoParts

void AddInfoCommand(CLI::App &app, Chosen &chosen)
{
    using namespace InfoParts;
    const auto [command, options] = AddCommand<Options>(app, chosen, "info", "What recordings hold", &Run);
    command->add_option("FILE", options->Files, "Recordings (MCAP)")->required();
    command->add_flag("--scan", options->Scan, "Read all of it, whatever its index says");
    command->add_flag("--json", options->Json, "One object a line");
    AddExamples(*command,
                {"rabit info flight.mcap", "rabit info *.mcap --json", "rabit info flight.mcap --scan"});
}

}  // namespace Rabit::Tool
