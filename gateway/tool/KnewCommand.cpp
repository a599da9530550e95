// rabit knew: the values that nodes had of each other's messages, and their ages.
#include <rabit/base/ListedNames.h>
#include <rabit/base/NaturalOrder.h>
#include <rabit/base/UtcText.h>
#include <rabit/dynamic/DynamicType.h>
#include <rabit/gateway/NamePattern.h>
#include <rabit/mcap/FileSource.h>
#include <rabit/mcap/MessageCursor.h>

#include <algorithm>
#include <filesystem>
#include <map>
#include <set>
#include <stdexcept>
#include <string>

#include "Command.h"
#include "NewFile.h"
#include "PlayedFiles.h"
#include "SafeText.h"
#include "Table.h"
#include "TimeText.h"
#include "recording/merge/AgePlot.h"
#include "recording/merge/ChannelChunks.h"
#include "recording/merge/Knowledge.h"

namespace Rabit::Tool
{
namespace KnewParts
{
namespace
{

using Merge::AgeHistory;
using Merge::KnowerLife;
using Merge::Knowledge;
using Merge::KnownStream;
using Merge::KnownValue;
using Merge::Moment;

using Names = std::set<std::string, NaturalOrder>;

struct Options
{
    std::string File;
    std::string Knower = "*";
    std::string What = "*/*";
    std::string At;
    std::string Plot;
    bool Json = false;
};

double SecondsOf(Moment time)
{
    return 1e-9 * static_cast<double>(time);
}

// The file, and those of its streams that the options name.
class Asked
{
public:
    explicit Asked(const Options &options)
        : Source(options.File), Contents(Mcap::ReadContents(Source)), Known(Contents), _options(options)
    {
        if (!Mcap::IsRecording(Source))
        {
            throw std::runtime_error(NoRecording(options.File));
        }
        Output::Talk(Contents.Problems);
        for (const KnownStream &stream : Known.Streams)
        {
            const bool isOwn = stream.Node == Known.Lives[stream.Life].Node;
            // A node's own messages count only if the node is asked for by name.
            if (MatchesAny({options.Knower}, Known.Lives[stream.Life].Node) &&
                MatchesAny({options.What}, stream.Node + "/" + stream.Message) &&
                (!isOwn || options.Knower == stream.Node))
            {
                Streams.push_back(&stream);
            }
        }
    }

    const KnowerLife &LifeOf(const KnownStream &stream) const { return Known.Lives[stream.Life]; }
    Moment Begin() const { return Merge::FromFile(Contents.Statistics.StartTime); }
    Moment End() const { return Merge::FromFile(Contents.Statistics.EndTime); }
    // Returns ` (life 2)`; empty if the node has only one life.
    std::string LifeText(const std::string &node, unsigned number) const
    {
        const auto count = std::count_if(Known.Lives.begin(), Known.Lives.end(),
                                         [&node](const KnowerLife &life) { return life.Node == node; });
        return count > 1 ? " (life " + std::to_string(number) + ")" : "";
    }
    std::string LifeText(const std::string &node, std::uint64_t incarnation, const char *otherwise) const
    {
        const auto life = std::find_if(Known.Lives.begin(), Known.Lives.end(),
                                       [&](const KnowerLife &one)
                                       { return one.Node == node && one.Incarnation == incarnation; });
        return life == Known.Lives.end() ? otherwise : LifeText(node, life->Number);
    }
    bool IsGood() const { return Contents.Problems.empty(); }
    // Reports why no stream has those names, with the names that there are.
    int NothingThere() const
    {
        Names knowers;
        Names known;
        for (const KnowerLife &life : Known.Lives)
        {
            knowers.insert(life.Node);
        }
        for (const KnownStream &stream : Known.Streams)
        {
            if (MatchesAny({_options.Knower}, LifeOf(stream).Node))
            {
                known.insert(stream.Node + "/" + stream.Message);
            }
        }
        const auto listed = [](const Names &names)
        {
            const std::vector<std::string> list(names.begin(), names.end());
            return list.empty() ? "nothing" : ListedNames(list);
        };
        const bool isThere =
            std::any_of(knowers.begin(), knowers.end(),
                        [this](const std::string &node) { return MatchesAny({_options.Knower}, node); });
        Output::Talk(isThere ? _options.Knower + " knew no " + _options.What + " in " + _options.File +
                                   "; it knew " + listed(known)
                             : _options.File + " holds nothing of what " + _options.Knower +
                                   " knew; it has what was known to " + listed(knowers) +
                                   " (a node records what it knows with `record:` in its configuration)");
        return ProblemFound;
    }

    Mcap::FileSource Source;
    const Mcap::Contents Contents;
    const Knowledge Known;
    std::vector<const KnownStream *> Streams;

private:
    const Options &_options;
};

// Returns values as text or JSON; parses each type once.
class Decoder
{
public:
    std::string Text(const KnownStream &stream, const KnownValue &value)
    {
        const ParsedType &type = TypeOf(stream);
        return type.Type ? type.Type->ToText(value.Sample).value_or("(too large to show)")
                         : "(" + type.Reason + ")";
    }
    Json Value(const KnownStream &stream, const KnownValue &value)
    {
        const ParsedType &type = TypeOf(stream);
        const auto text = type.Type ? type.Type->ToJson(value.Sample, DynamicType::Wide::Text) : std::nullopt;
        return text ? Json::parse(*text, nullptr, false) : Json();
    }

private:
    const ParsedType &TypeOf(const KnownStream &stream)
    {
        const auto [known, isNew] = _types.try_emplace({stream.Type, stream.Schema});
        if (isNew)
        {
            known->second = DynamicType::Parse(stream.Schema, stream.Type);
        }
        return known->second;
    }

    std::map<std::pair<std::string, std::string>, ParsedType> _types;
};

bool Show(const Options &options, const Asked &asked, const KnownStream &stream, const KnownValue &value,
          Moment at, Decoder &decoder)
{
    const KnowerLife &knower = asked.LifeOf(stream);
    const double age = SecondsOf(at - value.PostedAt);
    if (options.Json)
    {
        return Output::Object(
            {{"knower", knower.Node},
             {"life", knower.Number},
             {"node", stream.Node},
             {"incarnation", std::to_string(value.Incarnation)},
             {"message", stream.Message},
             {"type", stream.Type},
             {"at_ns", std::to_string(at)},
             {"received_ns", std::to_string(value.ReceivedAt)},
             {"posted_ns", std::to_string(value.PostedAt)},
             {"age_s", age},
             {"uncertainty_s", value.UncertainBy ? Json(SecondsOf(*value.UncertainBy)) : Json()},
             {"value", decoder.Value(stream, value)}});
    }
    const std::string bound = value.UncertainBy
                                  ? "wrong by " + NumberText(SecondsOf(*value.UncertainBy), 4, " s at most")
                                  : std::string("how wrong is not known");
    return Output::Line(
        SafeText(knower.Node + asked.LifeText(knower.Node, knower.Number) + " knew " + stream.Node + "/" +
                 stream.Message + asked.LifeText(stream.Node, value.Incarnation, "")) +
        "  age " + NumberText(age, 4, " s") + " (" + bound + ")  came " +
        NumberText(SecondsOf(at - value.ReceivedAt), 4, " s") + " before  " + decoder.Text(stream, value));
}

std::string UtcOf(Moment moment)
{
    return UtcText(Merge::ToFile(moment));
}

int ShowMoment(const Options &options, Asked &asked)
{
    const auto time = TimeOf(options.At, Merge::ToFile(asked.Begin()));
    if (!time)
    {
        Output::Talk("--at " + options.At +
                     ": seconds since the beginning, or UTC as 2026-11-23T04:04:07.25Z");
        return Usage;
    }
    const Moment at = Merge::FromFile(*time);
    if (at < asked.Begin() || at > asked.End())
    {
        Output::Talk(options.File + " is from " + UtcOf(asked.Begin()) + " to " + UtcOf(asked.End()));
        return ProblemFound;
    }
    Decoder decoder;
    bool isKnown = false;
    std::set<std::string> alive;  // the knowers' lives at that moment, for people
    std::vector<std::string> problems;
    for (const KnownStream *stream : asked.Streams)
    {
        const KnowerLife &knower = asked.LifeOf(*stream);
        if (at < knower.Begin || at > knower.End)
        {
            continue;
        }
        alive.insert(knower.Node + asked.LifeText(knower.Node, knower.Number));
        const auto value = ValueAt(asked.Source, asked.Contents, asked.Known, *stream, at, problems);
        isKnown = isKnown || value;
        if (value && !Show(options, asked, *stream, *value, at, decoder))
        {
            return Good;
        }
    }
    Output::Talk(problems);
    if (!isKnown)
    {
        Output::Talk(!alive.empty()
                         ? (alive.size() == 1 ? *alive.begin() : options.Knower) + " had nothing of " +
                               options.What + " yet"
                         : options.Knower + " was not recorded at that moment, or never had " + options.What);
    }
    return isKnown && problems.empty() && asked.IsGood() ? Good : ProblemFound;
}

std::vector<AgeHistory> ReadHistories(Asked &asked, std::vector<std::string> &problems)
{
    std::vector<AgeHistory> histories;
    std::map<std::uint16_t, std::size_t> byChannel;
    std::set<std::uint16_t> channels;
    for (std::size_t at = 0; at < asked.Streams.size(); ++at)
    {
        histories.emplace_back(asked.Begin(), asked.End(), Merge::AgePlot::Columns);
        for (const std::uint16_t channel : asked.Streams[at]->Channels)
        {
            byChannel[channel] = at;
            channels.insert(channel);
        }
    }
    const Merge::ChannelChunks chunks(asked.Contents, channels);
    Mcap::MessageCursor cursor(asked.Source, chunks.Contents(), chunks.Selection());
    while (const auto message = cursor.Next())
    {
        histories[byChannel.at(message->ChannelId)].Receive(Merge::FromFile(message->LogTime),
                                                            Merge::FromFile(message->PublishTime));
    }
    for (std::size_t at = 0; at < asked.Streams.size(); ++at)
    {
        histories[at].End(asked.LifeOf(*asked.Streams[at]).End);
    }
    problems = cursor.Problems();
    return histories;
}

void ShowAges(const Options &options, const Asked &asked, const std::vector<AgeHistory> &histories)
{
    std::vector<std::vector<std::string>> table = {
        {"NODE", "KNEW", "VALUES", "AGE 50 %", "90 %", "99 %", "OLDEST", "AT"}};
    for (std::size_t at = 0; at < histories.size(); ++at)
    {
        const KnownStream &stream = *asked.Streams[at];
        const KnowerLife &knower = asked.LifeOf(stream);
        const AgeHistory &ages = histories[at];
        if (options.Json)
        {
            Output::Object({{"knower", knower.Node},
                            {"life", knower.Number},
                            {"node", stream.Node},
                            {"message", stream.Message},
                            {"type", stream.Type},
                            {"values", ages.Values()},
                            {"p50_s", SecondsOf(ages.Percentile(0.5))},
                            {"p90_s", SecondsOf(ages.Percentile(0.9))},
                            {"p99_s", SecondsOf(ages.Percentile(0.99))},
                            {"oldest_s", SecondsOf(ages.Oldest())},
                            {"oldest_at_ns", std::to_string(ages.OldestAt())}});
            continue;
        }
        table.push_back(
            {SafeText(knower.Node + asked.LifeText(knower.Node, knower.Number)),
             SafeText(stream.Node + "/" + stream.Message), std::to_string(ages.Values()),
             NumberText(SecondsOf(ages.Percentile(0.5)), 3, " s"),
             NumberText(SecondsOf(ages.Percentile(0.9)), 3, " s"),
             NumberText(SecondsOf(ages.Percentile(0.99)), 3, " s"),
             NumberText(SecondsOf(ages.Oldest()), 3, " s"),
             NumberText(ages.Values() == 0 ? 0.0 : SecondsOf(ages.OldestAt() - asked.Begin()), 1, " s")});
    }
    Output::Lines(options.Json ? std::vector<std::string>() : TableLines(table));
}

std::string SvgOf(const Options &options, const Asked &asked, const std::vector<AgeHistory> &histories)
{
    Merge::AgePlot plot;
    plot.Title = "Age of what nodes knew of each other";
    plot.Note =
        std::filesystem::path(options.File).filename().string() + ", from " + UtcOf(asked.Begin()) +
        (asked.Known.WorstBound ? ", times are wrong by " +
                                      NumberText(1e3 * SecondsOf(*asked.Known.WorstBound), 2, " ms at most")
                                : "");
    plot.Begin = asked.Begin();
    plot.End = asked.End();
    // Lives of one node share a panel: they do not overlap.
    std::map<std::string, std::size_t> panels;
    for (std::size_t at = 0; at < histories.size(); ++at)
    {
        const KnownStream &stream = *asked.Streams[at];
        const std::string title = "what " + asked.LifeOf(stream).Node + " knew of " + stream.Node;
        const auto [panel, isNew] = panels.try_emplace(title, plot.Panels.size());
        if (isNew)
        {
            plot.Panels.push_back({title, {}});
        }
        plot.Panels[panel->second].Lines.push_back({stream.Message, &histories[at]});
    }
    return plot.ToSvg();
}

void Write(const std::string &path, const std::string &text)
{
    NewFile file(path);
    file.Finish(file.Sink().Write({reinterpret_cast<const std::uint8_t *>(text.data()), text.size()}));
}

int Run(const Options &options)
{
    Asked asked(options);
    if (asked.Streams.empty())
    {
        return asked.NothingThere();
    }
    if (!options.At.empty())
    {
        return ShowMoment(options, asked);
    }
    std::vector<std::string> problems;
    const std::vector<AgeHistory> histories = ReadHistories(asked, problems);
    Output::Talk(problems);
    ShowAges(options, asked, histories);
    if (!options.Plot.empty())
    {
        Write(options.Plot, SvgOf(options, asked, histories));
    }
    return problems.empty() && asked.IsGood() ? Good : ProblemFound;
}

}  // namespace
}  // namespace KnewParts

void AddKnewCommand(CLI::App &app, Chosen &chosen)
{
    using namespace KnewParts;
    const auto [command, options] =
        AddCommand<Options>(app, chosen, "knew", "What nodes knew of each other, and how old it was", &Run);
    command->add_option("FILE", options->File, "A merged recording, or that of one node")->required();
    command->add_option("NODE", options->Knower, "Who knew; *, ? stand for any (default: all)");
    command->add_option("MESSAGE", options->What,
                        "What of whom: uav1/Pose; *, ? stand for any (default: all)");
    CLI::Option *at = command->add_option(
        "--at", options->At, "That moment: seconds since the beginning, or UTC as 2026-11-23T04:04:07.25Z");
    command
        ->add_option("--plot", options->Plot,
                     "Ages over time as a picture (SVG) into that file, which is made")
        ->excludes(at);
    command->add_flag("--json", options->Json, "One object a line");
    AddExamples(*command, {"rabit knew flight.mcap", "rabit knew flight.mcap uav2 uav1/Pose --at 61.5",
                           "rabit knew flight.mcap --plot ages.svg"});
}

}  // namespace Rabit::Tool
