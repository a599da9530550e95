// rabit play: plays recordings to the network.
#include <unistd.h>

#include <rabit/base/ListedNames.h>
#include <rabit/base/NumberIn.h>
#include <rabit/base/UtcText.h>
#include <rabit/gateway/NamePattern.h>

#include <algorithm>
#include <chrono>
#include <optional>
#include <set>

#include "Command.h"
#include "FleetSession.h"
#include "PlayedFiles.h"
#include "Playing.h"
#include "ReplayFleet.h"
#include "ReplayNetwork.h"
#include "TimeText.h"

namespace Rabit::Tool
{
namespace PlayParts
{
namespace
{

using Replay::ReplayTimeline;

// Limit of nodes: each takes a dozen threads.
constexpr std::size_t MostNodes = 100;
// Seconds in which a node is heard, if its datagrams arrive at all.
constexpr double ShortestListening = 1.5;

struct Options
{
    CommonOptions Common;
    std::vector<std::string> Files;
    std::string Rate = "1";
    std::string From;
    std::string To;
    std::vector<std::string> Renames;
    Replay::PlanSettings Plan;
    bool StartPaused = false;
    bool Loops = false;
};

// Returns the rate; 0: as fast as possible. Empty if the text is no rate.
std::optional<double> RateOf(const std::string &text)
{
    if (text == "max")
    {
        return 0.0;
    }
    const auto rate = NumberIn<double>(text, std::chars_format::fixed);
    return rate && *rate >= 0.1 && *rate <= 100.0 ? rate : std::nullopt;
}

// Returns Good, or reports the error and returns the exit code.
int NameNodes(const Options &options, const Replay::ReplayPlan &plan, Replay::NodeRenames &renames)
{
    for (const std::string &rule : options.Renames)
    {
        if (const std::string misfit = renames.Add(rule); !misfit.empty())
        {
            Output::Talk("--rename " + misfit);
            return Usage;
        }
    }
    if (plan.Nodes.size() > MostNodes)
    {
        Output::Talk(std::to_string(plan.Nodes.size()) + " nodes would be played, and no more than " +
                     std::to_string(MostNodes) + " can be (--include, --exclude)");
        return Usage;
    }
    std::set<std::string> names;
    for (const std::string &node : plan.Nodes)
    {
        const std::string name = renames.NewNameOf(node);
        if (!IsNodeName(name))
        {
            Output::Talk("`" + name + "` is too long for the name of a node; --rename " + node + "=NAME");
            return Usage;
        }
        if (!names.insert(name).second)
        {
            Output::Talk("two nodes would be called `" + name + "`; --rename " + node + "=NAME");
            return Usage;
        }
    }
    return Good;
}

int SetTimes(const Options &options, const Replay::RecordedMessages &messages,
             ReplayTimeline::Settings &settings)
{
    const Replay::Time first = messages.First();
    const Replay::Time last = messages.Last();
    const auto from = options.From.empty() ? std::optional(first) : TimeOf(options.From, first);
    const auto to = options.To.empty() ? std::optional(last) : TimeOf(options.To, first);
    if (!from || !to)
    {
        Output::Talk("`" + (from ? options.To : options.From) +
                     "` is no time; expected seconds from the beginning, as 12.5, or UTC, as " +
                     UtcText(first));
        return Usage;
    }
    if (*from > *to || *from > last || *to < first)
    {
        Output::Talk("nothing was recorded then; the recording is from " + UtcText(first) + " to " +
                     UtcText(last));
        return Usage;
    }
    settings.From = std::max(*from, first);
    settings.To = std::min(*to, last);
    settings.Loops = options.Loops;
    settings.Paused = options.StartPaused;
    settings.Rate = *RateOf(options.Rate);
    return Good;
}

// Returns true if no node has one of the names; reports a node that has.
bool AreFree(const std::vector<std::string> &names, const GatewayConfig &network, const Options &options,
             Wakeup &wakeup)
{
    GatewayConfig config = network;
    config.Tool->AsksOf = names;
    FleetSession session(config, options.Common, wakeup);
    std::string taken;
    const auto isTaken = [&] { return !(taken = session.TakenOf(names)).empty(); };
    if (!session.WaitUntil(std::max(options.Common.Wait, ShortestListening), isTaken))
    {
        return true;
    }
    Output::Talk(NameIsTaken(taken) + " (--rename)");
    return false;
}

std::string Counted(std::uint64_t count, const std::string &one)
{
    return std::to_string(count) + " " + one + (count == 1 ? "" : "s");
}

int Tell(const Options &options, const PlayedFiles &files, const ReplayFleet &fleet, std::uint64_t rounds)
{
    const ReplayFleet::Counts counts = fleet.CountsNow();
    const std::vector<std::string> problems = files.Messages().Problems();
    Output::Talk(problems);
    const auto tell = [](const std::string &what, std::uint64_t count)
    {
        if (count > 0)
        {
            Output::Talk(what + ": " + Counted(count, "message"));
        }
    };
    tell("not played, because they do not decode", counts.Undecodable);
    tell("did not go out, because a newer one of the same name came before its turn", counts.Replaced);
    tell("younger than they were, because a later one had gone out before", counts.AgesNotKept);
    tell("not delivered to a queue", counts.Undelivered);
    if (options.Common.Json)
    {
        Output::Object({{"nodes", fleet.Names()},
                        {"messages", counts.Messages},
                        {"restored", counts.Restored},
                        {"queue_messages", counts.QueueMessages},
                        {"undelivered", counts.Undelivered},
                        {"undecodable", counts.Undecodable},
                        {"replaced", counts.Replaced},
                        {"ages_not_kept", counts.AgesNotKept},
                        {"rounds", rounds},
                        {"lacks", files.Plan().Lacks}});
    }
    else
    {
        Output::Line(
            Counted(counts.Messages + counts.QueueMessages, "message") + " of " +
            Counted(fleet.Names().size(), "node") +
            (counts.Restored > 0 ? ", " + std::to_string(counts.Restored) + " restored before" : ""));
    }
    return problems.empty() && counts.Undecodable == 0 && counts.Undelivered == 0 ? Good : ProblemFound;
}

void TellOfPlace(const ReplayTimeline::Settings &settings, const ReplayFleet &fleet,
                 const GatewayConfig &network)
{
    const double recorded = 1e-9 * static_cast<double>(settings.To - settings.From);
    const std::string length = settings.Loops         ? "again and again"
                               : settings.Rate == 0.0 ? "as fast as possible"
                                                      : "for " + DurationText(recorded / settings.Rate);
    Output::Talk("plays " + Counted(fleet.Names().size(), "node") + " " + length + ", in domain " +
                 std::to_string(network.Domain) + " on " +
                 (network.Interfaces.empty() ? "all interfaces" : ListedNames(network.Interfaces)));
}

int Play(const Options &options, PlayedFiles &files, const Replay::NodeRenames &renames,
         const ReplayTimeline::Settings &settings, Wakeup &wakeup)
{
    // Seconds until the last posts have gone out and the gateways have reported them.
    constexpr double farewell = 1.2;
    // Records of the first 1.5 s tell which nodes were there at the beginning.
    constexpr Replay::Time introduction = 1'500'000'000;
    const auto later = [](double seconds)
    {
        return std::chrono::steady_clock::now() +
               std::chrono::duration_cast<std::chrono::steady_clock::duration>(
                   std::chrono::duration<double>(seconds));
    };
    const GatewayConfig network =
        ReplayNetwork(ConfigOf(options.Common), options.Common, files.Plan().Domains);
    ReplayFleet fleet(files.Plan(), renames, network, options.Common, wakeup);
    if (!AreFree(fleet.Names(), network, options, wakeup))
    {
        return ProblemFound;
    }
    TellOfPlace(settings, fleet, network);
    if (settings.Rate == 0.0)
    {
        fleet.KeepAll();
        fleet.WaitForTurns();
    }
    const Replay::Time at = std::min(settings.From + introduction, settings.To + 1);
    fleet.Begin(files.Messages().LastBefore(at), at);
    // Lets listeners find the nodes before the first message goes out.
    wakeup.WaitUntil(later(options.Common.Wait), [] { return false; });
    Playing playing(files, settings, fleet, wakeup);
    const int code = playing.Run();
    if (!wakeup.IsInterrupted() && code == Good)
    {
        wakeup.WaitUntil(later(farewell), [] { return false; });
        wakeup.WaitUntil(later(options.Common.Wait), [&fleet] { return fleet.IsSettled(); });
    }
    const int told = Tell(options, files, fleet, playing.Rounds());
    return code != Good || wakeup.IsInterrupted() ? code : told;
}

int Run(const Options &options, Wakeup &wakeup)
{
    if (options.StartPaused && ::isatty(STDIN_FILENO) == 0)
    {
        Output::Talk("--start-paused waits for a key, and standard input is no terminal");
        return Usage;
    }
    PlayedFiles files(options.Files, options.Plan);
    if (files.Plan().Nodes.empty())
    {
        Output::Talk("there is nothing in it that can be played, or nothing that was named");
        return ProblemFound;
    }
    Output::Talk(files.Plan().Lacks);
    Replay::NodeRenames renames;
    ReplayTimeline::Settings settings;
    int code = NameNodes(options, files.Plan(), renames);
    code = code == Good ? SetTimes(options, files.Messages(), settings) : code;
    return code == Good ? Play(options, files, renames, settings, wakeup) : code;
}

}  // namespace
}  // namespace PlayParts

void AddPlayCommand(CLI::App &app, Chosen &chosen)
{
    using namespace PlayParts;
    const auto [command, options] = AddCommand<Options>(
        app, chosen, "play",
        "Recordings, once more to the network, as nodes `replay.NAME`; on loopback unless told otherwise",
        &Run);
    command->add_option("FILE", options->Files, "Recordings (MCAP)")->required();
    AddCommonOptions(*command, options->Common, 2.0);
    // A replay leaves loopback only if the command line says so.
    command->get_option("--interface")->envname("");
    command->get_option("--domain")->envname("");
    command->add_option("--rate", options->Rate, "So many recorded seconds in one, 0.1 to 100, or max")
        ->check([](const std::string &text)
                { return RateOf(text) ? "" : "`" + text + "` is no rate; expected 0.1 to 100, or max"; })
        ->capture_default_str();
    command->add_option("--from", options->From, "Seconds from the beginning, or UTC as 2026-11-23T04:04:06");
    command->add_option("--to", options->To, "Likewise, where it ends");
    command->add_flag("--loop", options->Loops, "Begin again at the end, until Ctrl-C");
    command->add_flag("--start-paused", options->StartPaused, "Wait at the beginning until space is pressed");
    command->add_option("--include", options->Plan.Include,
                        "Only these messages, as uav1/Pose; *, ? stand for any");
    command->add_option("--exclude", options->Plan.Exclude, "Messages to leave out, as */CameraView");
    command->add_option("--queues", options->Plan.Queues, "Play messages for these queues, too, as uav1/*");
    command->add_option("--rename", options->Renames, "OLD=NEW node name, as uav1=sim1 or *=*");
    AddExamples(*command, {"rabit play flight.mcap",
                           "rabit play flight.mcap --rate 4 --from 60 --exclude '*/CameraView'",
                           "rabit play uav1_*.mcap --rename uav1=sim1 --loop"});
}

}  // namespace Rabit::Tool
