// rabit hz, rabit bytes, rabit age: what values of a message measure, a line for each node.
#include <rabit/base/NaturalOrder.h>
#include <rabit/gateway/AirCost.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include "Command.h"
#include "Meter.h"
#include "Samples.h"
#include "Table.h"
#include "TimeText.h"

namespace Rabit::Tool
{
namespace MeterParts
{
namespace
{

struct Options
{
    CommonOptions Common;
    std::string What;
    ForeignOptions Foreign;
    double For = 5.0;
};

// The values that came from one node.
struct Measured
{
    Meter Values;
    double Uncertainty = 0.0;  // of the ages, in seconds
};

struct Column
{
    const char *Title;
    const char *Key;  // of the JSON object
    double (*Value)(const Measured &);
    std::string (*Text)(double);
};

// The columns behind the name of the node and the number of values.
using Columns = std::vector<Column>;

// Returns the largest error of an age: beats relate the two clocks, and half of a round trip is taken as the
// one-way delay, which may be any part of it.
double Uncertainty(const std::string &node, const Gateway::Fleet &fleet)
{
    for (const Gateway::NodeStatus &status : fleet.nodes)
    {
        if (status.node == node)
        {
            return status.round_trip_s / 2.0;
        }
    }
    return std::numeric_limits<double>::quiet_NaN();
}

// Returns the bytes of IP packets of one sample, to one destination.
double OnAir(const Meter &meter)
{
    const double body = meter.MeanBytes() - static_cast<double>(AirCost::Encapsulation);
    return static_cast<double>(
        AirCost(GatewayConfig().MaxDatagram).Of(static_cast<std::size_t>(std::lround(std::max(0.0, body)))));
}

int Measure(const Columns &columns, const Options &options, FleetSession &session, Samples &samples,
            Wakeup &wakeup)
{
    std::map<std::string, Measured, NaturalOrder> nodes;
    const double end = session.Seconds() + options.For;
    while (!wakeup.IsInterrupted() && session.Seconds() < end)
    {
        for (const Sample &sample : samples.Take(end))
        {
            nodes[sample.Node].Values.Add(sample.At, sample.Bytes.size(), sample.Age);
        }
    }
    if (nodes.empty())
    {
        session.TellProblems();
        Output::Talk("nothing has come");
        return ProblemFound;
    }
    std::vector<std::vector<std::string>> rows{{"NODE", "VALUES"}};
    for (const Column &column : columns)
    {
        rows[0].emplace_back(column.Title);
    }
    const Gateway::Fleet fleet = session.Fleet();
    for (auto &[node, measured] : nodes)
    {
        measured.Uncertainty = Uncertainty(node, fleet);
        Json object{{"node", node.empty() ? Json(nullptr) : Json(node)},
                    {"message", samples.Message()},
                    {"values", measured.Values.Count()}};
        rows.push_back({node.empty() ? "-" : node, std::to_string(measured.Values.Count())});
        for (const Column &column : columns)
        {
            object[column.Key] = column.Value(measured);
            rows.back().push_back(column.Text(column.Value(measured)));
        }
        if (options.Common.Json && !Output::Object(object))
        {
            return Good;
        }
    }
    if (!options.Common.Json && !Output::Lines(TableLines(rows)))
    {
        return Good;
    }
    if (samples.Missed() > 0)
    {
        Output::Talk(std::to_string(samples.Missed()) + " values came faster than they were counted");
    }
    return Good;
}

// Adds a command that listens for --for seconds, or until Ctrl-C, and then prints a line for each node.
void AddMeterCommand(CLI::App &app, Chosen &chosen, const std::string &name, const std::string &help,
                     const Columns &columns)
{
    const auto run = [columns](const Options &given, Wakeup &wakeup)
    {
        return ListenTo(given.Common, given.What, given.Foreign, wakeup,
                        [&](FleetSession &session, Samples &samples)
                        { return Measure(columns, given, session, samples, wakeup); });
    };
    const auto [command, options] = AddCommand<Options>(app, chosen, name, help, run);
    command->add_option("MESSAGE", options->What, "uav1/Pose; *, ? stand for any node; Pose: of all nodes")
        ->required();
    AddCommonOptions(*command, options->Common, 5.0);
    AddForeignOptions(*command, options->Foreign);
    command->add_option("--for", options->For, "Seconds to listen")
        ->check(CLI::Range(0.1, 86400.0))
        ->capture_default_str();
    const std::string line = "rabit " + name + " ";
    AddExamples(*command,
                {line + "uav1/Pose", line + "'uav*/Pose' --for 20", line + "Pose --domain 7 --json"});
}

std::string Milliseconds(double seconds)
{
    return NumberText(1000.0 * seconds, 1, " ms");
}

std::string Bytes(double bytes)
{
    return NumberText(bytes, 0, " B");
}

}  // namespace
}  // namespace MeterParts

void AddHzCommand(CLI::App &app, Chosen &chosen)
{
    using namespace MeterParts;
    AddMeterCommand(
        app, chosen, "hz", "How often a message comes, and how evenly",
        {{"RATE", "rate_hz", [](const Measured &node) { return node.Values.Rate(); },
          [](double rate) { return NumberText(rate, 2, " Hz"); }},
         {"JITTER", "jitter_s", [](const Measured &node) { return node.Values.Jitter(); }, &Milliseconds},
         {"SHORTEST", "shortest_s", [](const Measured &node) { return node.Values.ShortestGap(); },
          &Milliseconds},
         {"LONGEST", "longest_s", [](const Measured &node) { return node.Values.LongestGap(); },
          &Milliseconds}});
}

void AddBytesCommand(CLI::App &app, Chosen &chosen)
{
    using namespace MeterParts;
    AddMeterCommand(
        app, chosen, "bytes",
        "How large a message is, and what it costs on the air, with all headers, for each destination",
        {{"SIZE", "bytes", [](const Measured &node) { return node.Values.MeanBytes(); }, &Bytes},
         {"ON THE AIR", "air_bytes", [](const Measured &node) { return OnAir(node.Values); }, &Bytes},
         {"EACH SECOND", "air_bytes_per_s",
          [](const Measured &node) { return OnAir(node.Values) * node.Values.Rate(); },
          [](double rate) { return NumberText(rate, 0, " B/s"); }}});
}

void AddAgeCommand(CLI::App &app, Chosen &chosen)
{
    using namespace MeterParts;
    AddMeterCommand(
        app, chosen, "age", "How old values are when they come, and how sure that is",
        {{"50 %", "p50_s", [](const Measured &node) { return node.Values.Age(0.5); }, &DurationText},
         {"90 %", "p90_s", [](const Measured &node) { return node.Values.Age(0.9); }, &DurationText},
         {"99 %", "p99_s", [](const Measured &node) { return node.Values.Age(0.99); }, &DurationText},
         {"OLDEST", "oldest_s", [](const Measured &node) { return node.Values.Age(1.0); }, &DurationText},
         {"UNCERTAIN BY", "uncertainty_s", [](const Measured &node) { return node.Uncertainty; },
          &DurationText}});
}

}  // namespace Rabit::Tool
