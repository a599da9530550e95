// rabit ping: round trips to a node.
#include <chrono>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>

#include "Command.h"
#include "FleetSession.h"
#include "OneNode.h"
#include "RoundTrips.h"
#include "Table.h"

namespace Rabit::Tool
{
namespace PingParts
{
namespace
{

using Report = FleetExplorer::Report;

struct Options
{
    CommonOptions Common;
    std::string Node;
    std::uint32_t Count = std::numeric_limits<std::uint32_t>::max();
    double Every = 1.0;
    double Timeout = 5.0;
};

std::string Milliseconds(double seconds)
{
    return NumberText(1000.0 * seconds, 2, " ms");
}

bool ShowOne(const Options &options, std::uint32_t number, std::optional<double> seconds)
{
    return Output::ObjectOrLine(options.Common.Json,
                                Json{{"node", options.Node},
                                     {"number", number},
                                     {"round_trip_s", seconds ? Json(*seconds) : Json(nullptr)}},
                                options.Node + "  " + std::to_string(number) + "  " +
                                    (seconds ? Milliseconds(*seconds) : "no answer"));
}

void ShowAll(const Options &options, const RoundTrips &trips)
{
    Output::ObjectOrLine(
        options.Common.Json,
        Json{{"node", options.Node},
             {"sent", trips.Sent()},
             {"answered", trips.Came()},
             {"loss", trips.Loss()},
             {"min_s", trips.Percentile(0.0)},
             {"p50_s", trips.Percentile(0.5)},
             {"p99_s", trips.Percentile(0.99)},
             {"max_s", trips.Percentile(1.0)}},
        std::to_string(trips.Came()) + " of " + std::to_string(trips.Sent()) + " answered, loss " +
            NumberText(100.0 * trips.Loss(), 0, " %") + "; min " + Milliseconds(trips.Percentile(0.0)) +
            "  p50 " + Milliseconds(trips.Percentile(0.5)) + "  p99 " + Milliseconds(trips.Percentile(0.99)) +
            "  max " + Milliseconds(trips.Percentile(1.0)));
}

int Run(const Options &options, Wakeup &wakeup)
{
    FleetSession session(ConfigWithoutOffers(options.Common), options.Common, wakeup);
    if (const int code = WaitForNode(session, options.Common, options.Node); code != Good)
    {
        return code;
    }
    // A node's first answer may be lost, since its writer is new. This request is repeated.
    if (!Request(session, options.Node, Report::Air))
    {
        return ProblemFound;
    }
    FleetExplorer &explorer = session.Explorer();
    RoundTrips trips;
    bool stillRead = true;
    for (std::uint32_t number = 1; number <= options.Count && stillRead && !wakeup.IsInterrupted(); ++number)
    {
        const double begin = session.Seconds();
        explorer.AskForReport(options.Node, Report::Echo, number);
        std::optional<FleetExplorer::Answer> answer;
        session.WaitUntil(begin + options.Timeout, [&]
                          { return (answer = explorer.TakeReport(options.Node, Report::Echo)).has_value(); });
        if (!answer && wakeup.IsInterrupted())
        {
            break;  // nobody knows whether it would have come
        }
        std::optional<double> seconds;
        if (answer)
        {
            seconds = std::chrono::duration<double>(answer->Took).count();
            trips.Answered(*seconds);
        }
        else
        {
            trips.Lost();
        }
        stillRead = ShowOne(options, number, seconds);
        if (number < options.Count)
        {
            session.WaitUntil(begin + options.Every);
        }
    }
    if (stillRead)
    {
        ShowAll(options, trips);
    }
    return trips.Came() > 0 ? Good : ProblemFound;
}

}  // namespace
}  // namespace PingParts

void AddPingCommand(CLI::App &app, Chosen &chosen)
{
    using namespace PingParts;
    const auto [command, options] =
        AddCommand<Options>(app, chosen, "ping", "Round trips to a node, through its gateway", &Run);
    command->add_option("NODE", options->Node, "As uav1")->required();
    AddCommonOptions(*command, options->Common, 5.0);
    command->add_option("-c,--count", options->Count, "Number of round trips (default: until Ctrl-C)")
        ->check(CLI::Range(1u, std::numeric_limits<std::uint32_t>::max()));
    command->add_option("--every", options->Every, "Seconds from one to the next (default: 1)")
        ->check(CLI::Range(0.3, 3600.0));
    command->add_option("--timeout", options->Timeout, "Seconds to wait for an answer (default: 5)")
        ->check(CLI::Range(0.1, 3600.0));
    AddExamples(*command, {"rabit ping uav1", "rabit ping uav1 -c 10", "rabit ping uav1 -c 60 --json"});
}

}  // namespace Rabit::Tool
