// rabit merge: the recordings of several nodes on one time line.
#include <rabit/RabitVersion.h>
#include <rabit/mcap/FileSource.h>

#include <array>
#include <memory>

#include "Command.h"
#include "NewFile.h"
#include "SafeText.h"
#include "Table.h"
#include "Wakeup.h"
#include "recording/merge/Merger.h"

namespace Rabit::Tool
{
namespace MergeParts
{
namespace
{

using Merge::Lives;
using Merge::Merged;
using Merge::MergePlan;
using Merge::Moment;
using Merge::PlannedLife;

struct Options
{
    std::string To;
    std::vector<std::string> Files;
    Merge::MergeWishes Wishes;
    bool Json = false;
};

std::string Seconds(Moment time)
{
    return NumberText(1e-9 * static_cast<double>(time), 1, " s");
}

std::string Bound(std::optional<Moment> bound)
{
    if (!bound)
    {
        return "not known";
    }
    const double milliseconds = 1e-6 * static_cast<double>(*bound);
    return milliseconds < 10000 ? NumberText(milliseconds, 2, " ms")
                                : NumberText(1e-3 * milliseconds, 1, " s");
}

// Returns the nodes between the two clocks; empty if they are related directly.
std::vector<std::string> Between(const Lives &lives, const PlannedLife &planned)
{
    std::vector<std::string> nodes;
    for (const Merge::ClockGraph::Clock clock : planned.Map.By())
    {
        nodes.push_back(lives.Graph.NodeOf(clock));
    }
    return nodes;
}

std::string WayOf(const Lives &lives, const MergePlan &plan, const PlannedLife &planned)
{
    if (planned.By == PlannedLife::Way::TimeLine)
    {
        return "is the time line";
    }
    if (planned.By == PlannedLife::Way::WallClock)
    {
        return "wall clock";
    }
    std::string way = lives.All[plan.TimeLine].Node;
    const char *word = " by ";
    for (const std::string &node : Between(lives, planned))
    {
        way += word + node;
        word = ", ";
    }
    return way;
}

Moment Earliest(const Lives &lives, const MergePlan &plan)
{
    Moment earliest = Merge::FarthestMoment;
    for (std::size_t life = 0; life < lives.All.size(); ++life)
    {
        earliest = std::min(earliest, plan.Lives[life].Map.At(lives.All[life].Begin));
    }
    return earliest;
}

void ShowText(const Options &options, const Lives &lives, const MergePlan &plan, const Merged &merged)
{
    const Moment earliest = Earliest(lives, plan);
    std::vector<std::vector<std::string>> table = {
        {"NODE", "LIFE", "BEGINS", "LASTS", "FILES", "MESSAGES", "CLOCK", "UNCERTAIN BY", "AT WORST"}};
    for (std::size_t life = 0; life < lives.All.size(); ++life)
    {
        const Merge::Life &recorded = lives.All[life];
        const PlannedLife &planned = plan.Lives[life];
        const Moment begin = planned.Map.At(recorded.Begin);
        table.push_back({SafeText(recorded.Node), std::to_string(planned.Number), Seconds(begin - earliest),
                         Seconds(planned.Map.At(recorded.End) - begin), std::to_string(recorded.Files.size()),
                         std::to_string(merged.Messages[life]), SafeText(WayOf(lives, plan, planned)),
                         Bound(planned.Map.MedianBound()), Bound(planned.Map.WorstBound())});
    }
    std::uint64_t messages = 0;
    for (const std::uint64_t count : merged.Messages)
    {
        messages += count;
    }
    Output::Lines(TableLines(table));
    const auto worst = plan.WorstBound();
    Output::Line(SafeText(options.To) + ": " + std::to_string(messages) + " messages (and " +
                 std::to_string(merged.TimeLines) + " about the time line) by the clock of " +
                 SafeText(NameOf(lives, plan, plan.TimeLine)) +
                 (worst ? ", wrong by " + Bound(worst) + " at most" : ", how wrong is not known"));
}

Json JsonOf(std::optional<Moment> bound)
{
    return bound ? Json(1e-9 * static_cast<double>(*bound)) : Json();
}

void ShowJson(const Options &options, const Lives &lives, const MergePlan &plan, const Merged &merged)
{
    static constexpr std::array<const char *, 3> ways = {"time line", "relations", "wall clock"};
    Json recordings = Json::array();
    for (std::size_t life = 0; life < lives.All.size(); ++life)
    {
        const Merge::Life &recorded = lives.All[life];
        const PlannedLife &planned = plan.Lives[life];
        recordings.push_back({{"node", recorded.Node},
                              {"life", planned.Number},
                              {"incarnation", std::to_string(recorded.Incarnation)},
                              {"begin_ns", std::to_string(planned.Map.At(recorded.Begin))},
                              {"end_ns", std::to_string(planned.Map.At(recorded.End))},
                              {"files", recorded.Files.size()},
                              {"messages", merged.Messages[life]},
                              {"clock", ways[static_cast<std::size_t>(planned.By)]},
                              {"by", Between(lives, planned)},
                              {"uncertainty_s", JsonOf(planned.Map.MedianBound())},
                              {"worst_uncertainty_s", JsonOf(planned.Map.WorstBound())}});
    }
    Output::Object({{"file", options.To},
                    {"time_line", lives.All[plan.TimeLine].Node},
                    {"worst_uncertainty_s", JsonOf(plan.WorstBound())},
                    {"recordings", recordings}});
}

// Reports doubts about the merged file.
void Warn(const Lives &lives, const MergePlan &plan, const Merged &merged)
{
    for (std::size_t life = 0; life < lives.All.size(); ++life)
    {
        if (plan.Lives[life].By == PlannedLife::Way::WallClock)
        {
            Output::Talk(NameOf(lives, plan, life) +
                         ": nothing relates its clock, so its wall clock is taken; its times may be wrong by "
                         "anything");
        }
    }
    Output::Talk(merged.Problems);
    if (merged.Lost > 0)
    {
        Output::Talk(std::to_string(merged.Lost) + " messages are of no channel, and were left out");
    }
}

int Run(const Options &options, Wakeup &wakeup)
{
    const Merge::OpenFile open = [](const std::string &path)
    { return std::make_unique<Mcap::FileSource>(path); };
    const Lives lives = Merge::ReadLives(open, options.Files);
    Output::Talk(lives.Remarks);
    if (!lives.Problem.empty())
    {
        Output::Talk(lives.Problem);
        return ProblemFound;
    }
    const MergePlan plan = MakePlan(lives, options.Wishes);
    if (!plan.Problem.empty())
    {
        Output::Talk(plan.Problem +
                     (options.Wishes.TakesWallClocks || plan.Lives.empty()
                          ? ""
                          : "; --wall-clock takes it by its wall clock, which may be wrong by anything"));
        return ProblemFound;
    }
    NewFile file(options.To);
    Mcap::McapWriter writer(file.Sink(), {"rabit " RABIT_VERSION_STRING, "rabit", true});
    const Merged merged =
        Merge::Merger(open, lives, plan, writer).Run([&wakeup] { return wakeup.IsInterrupted(); });
    file.Finish(merged.IsWritten, merged.WasStopped);
    Warn(lives, plan, merged);
    (options.Json ? ShowJson : ShowText)(options, lives, plan, merged);
    return merged.Problems.empty() && merged.Lost == 0 ? Good : ProblemFound;
}

}  // namespace
}  // namespace MergeParts

void AddMergeCommand(CLI::App &app, Chosen &chosen)
{
    using namespace MergeParts;
    const auto [command, options] = AddCommand<Options>(
        app, chosen, "merge", "Recordings of several nodes, on one time line in one file", &Run);
    command->add_option("OUT", options->To, "The file to be made; none is overwritten")->required();
    command->add_option("FILE", options->Files, "Recordings (MCAP), which stay as they are")->required();
    command->add_option("--reference", options->Wishes.Reference,
                        "The node whose clock is the time line (default: that which heard most others)");
    command->add_flag("--wall-clock", options->Wishes.TakesWallClocks,
                      "Take nodes whose clocks nothing relates by their wall clocks, and do not refuse them");
    command->add_flag("--json", options->Json, "One object");
    AddExamples(*command, {"rabit merge flight.mcap ground_*.mcap uav?_*.mcap",
                           "rabit merge flight.mcap *.mcap --reference ground",
                           "rabit merge flight.mcap *.mcap --wall-clock --json"});
}

}  // namespace Rabit::Tool
