// rabit age: how old values are when they come.
#include <nlohmann/json.hpp>

#include <limits>

#include "JsonNumber.h"
#include "MeterCommand.h"
#include "TimeText.h"

namespace Rabit::Tool
{
namespace
{

// Returns the largest error of an age: beats relate the two clocks, and half of a round trip is taken as the
// one-way delay, which may be any part of it.
double Uncertainty(const std::string &node, FleetSession &session)
{
    for (const Gateway::NodeStatus &status : session.Fleet().nodes)
    {
        if (status.node == node)
        {
            return status.round_trip_s / 2.0;
        }
    }
    return std::numeric_limits<double>::quiet_NaN();
}

}  // namespace

void AddAgeCommand(CLI::App &app, Chosen &chosen)
{
    MeterCommand what;
    what.Name = "age";
    what.Help = "How old values are when they come, and how sure that is";
    what.Columns = {"VALUES", "50 %", "90 %", "99 %", "OLDEST", "UNCERTAIN BY"};
    what.Cells = [](const Meter &meter, const std::string &node, FleetSession &session)
    {
        return std::vector<std::string>{
            std::to_string(meter.Count()), DurationText(meter.Age(0.5)),
            DurationText(meter.Age(0.9)),  DurationText(meter.Age(0.99)),
            DurationText(meter.Age(1.0)),  DurationText(Uncertainty(node, session))};
    };
    what.Members =
        [](const Meter &meter, const std::string &node, FleetSession &session, nlohmann::ordered_json &object)
    {
        object["values"] = meter.Count();
        object["p50_s"] = JsonNumber(meter.Age(0.5));
        object["p90_s"] = JsonNumber(meter.Age(0.9));
        object["p99_s"] = JsonNumber(meter.Age(0.99));
        object["oldest_s"] = JsonNumber(meter.Age(1.0));
        object["uncertainty_s"] = JsonNumber(Uncertainty(node, session));
    };
    AddMeterCommand(app, chosen, std::move(what));
}

}  // namespace Rabit::Tool
