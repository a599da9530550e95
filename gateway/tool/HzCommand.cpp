// rabit hz: the rate of a message, and its jitter.
#include <nlohmann/json.hpp>

#include "JsonNumber.h"
#include "MeterCommand.h"

namespace Rabit::Tool
{

void AddHzCommand(CLI::App &app, Chosen &chosen)
{
    MeterCommand what;
    what.Name = "hz";
    what.Help = "How often a message comes, and how evenly";
    what.Columns = {"VALUES", "RATE", "JITTER", "SHORTEST", "LONGEST"};
    what.Cells = [](const Meter &meter, const std::string &, FleetSession &)
    {
        return std::vector<std::string>{std::to_string(meter.Count()), NumberText(meter.Rate(), 2, " Hz"),
                                        NumberText(1000.0 * meter.Jitter(), 1, " ms"),
                                        NumberText(1000.0 * meter.ShortestGap(), 1, " ms"),
                                        NumberText(1000.0 * meter.LongestGap(), 1, " ms")};
    };
    what.Members = [](const Meter &meter, const std::string &, FleetSession &, nlohmann::ordered_json &object)
    {
        object["values"] = meter.Count();
        object["rate_hz"] = JsonNumber(meter.Rate());
        object["jitter_s"] = JsonNumber(meter.Jitter());
        object["shortest_s"] = JsonNumber(meter.ShortestGap());
        object["longest_s"] = JsonNumber(meter.LongestGap());
    };
    AddMeterCommand(app, chosen, std::move(what));
}

}  // namespace Rabit::Tool
