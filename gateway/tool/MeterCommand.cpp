#include "MeterCommand.h"

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include <cmath>
#include <cstdio>
#include <map>
#include <memory>
#include <utility>

#include "Output.h"
#include "Samples.h"
#include "Table.h"

namespace Rabit::Tool
{
namespace
{

struct Options
{
    CommonOptions Common;
    std::string What;
    double For = 5.0;
};

int Measure(const MeterCommand &what, const Options &options, FleetSession &session, Samples &samples,
            Wakeup &wakeup)
{
    std::map<std::string, Meter> meters;
    const double end = session.Seconds() + options.For;
    while (!wakeup.IsInterrupted() && session.Seconds() < end)
    {
        for (const Sample &sample : samples.Take(end))
        {
            meters[sample.Node].Add(sample.At, sample.Bytes.size(), sample.Age);
        }
    }
    if (meters.empty())
    {
        for (const Gateway::Problem &problem : session.Fleet().problems)
        {
            Output::Talk(problem.subject + ": " + problem.reason);
        }
        Output::Talk("nothing has come");
        return ProblemFound;
    }
    std::vector<std::vector<std::string>> rows{{"NODE"}};
    rows[0].insert(rows[0].end(), what.Columns.begin(), what.Columns.end());
    for (const auto &[node, meter] : meters)
    {
        if (options.Common.Json)
        {
            nlohmann::ordered_json object{{"node", node}, {"message", samples.Message()}};
            what.Members(meter, node, session, object);
            if (!Output::Object(object))
            {
                return Good;
            }
            continue;
        }
        rows.push_back({node});
        const std::vector<std::string> cells = what.Cells(meter, node, session);
        rows.back().insert(rows.back().end(), cells.begin(), cells.end());
    }
    for (const std::string &line : options.Common.Json ? std::vector<std::string>() : TableLines(rows))
    {
        if (!Output::Line(line))
        {
            return Good;
        }
    }
    if (samples.Missed() > 0)
    {
        Output::Talk(std::to_string(samples.Missed()) + " values came faster than they were counted");
    }
    return Good;
}

int Run(const MeterCommand &what, const Options &options, Wakeup &wakeup)
{
    return ListenTo(options.Common, options.What, wakeup,
                    [&](FleetSession &session, Samples &samples)
                    { return Measure(what, options, session, samples, wakeup); });
}

}  // namespace

std::string NumberText(double number, int digits, const char *unit)
{
    char text[64];
    std::snprintf(text, sizeof text, "%.*f%s", digits, number, unit);
    return std::isfinite(number) ? text : "-";
}

void AddMeterCommand(CLI::App &app, Chosen &chosen, MeterCommand what)
{
    auto options = std::make_shared<Options>();
    CLI::App *command = app.add_subcommand(what.Name, what.Help);
    command->add_option("MESSAGE", options->What, "uav1/Pose; *, ? stand for any node; Pose: of all nodes")
        ->required();
    AddCommonOptions(*command, options->Common, 5.0);
    command->add_option("--for", options->For, "Seconds to listen")
        ->check(CLI::Range(0.1, 86400.0))
        ->capture_default_str();
    const std::string line = "rabit " + std::string(what.Name) + " ";
    AddExamples(*command,
                {line + "uav1/Pose", line + "'uav*/Pose' --for 20", line + "Pose --domain 7 --json"});
    command->callback(
        [options, &chosen, what = std::move(what)]
        { chosen.Run = [options, what](Wakeup &wakeup) { return Run(what, *options, wakeup); }; });
}

}  // namespace Rabit::Tool
