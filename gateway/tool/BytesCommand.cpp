// rabit bytes: the size of a message, and its bytes on the air.
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>

#include "JsonNumber.h"
#include "MeterCommand.h"
#include "air/AirCost.h"

namespace Rabit::Tool
{
namespace
{

// Returns the bytes of IP packets of one sample, to one destination.
double OnAir(const Meter &meter)
{
    const double body = meter.MeanBytes() - static_cast<double>(AirCost::Encapsulation);
    return static_cast<double>(
        AirCost(GatewayConfig().MaxDatagram).Of(static_cast<std::size_t>(std::lround(std::max(0.0, body)))));
}

}  // namespace

void AddBytesCommand(CLI::App &app, Chosen &chosen)
{
    MeterCommand what;
    what.Name = "bytes";
    what.Help =
        "How large a message is, and what it costs on the air, with all headers, for each destination";
    what.Columns = {"VALUES", "SIZE", "ON THE AIR", "EACH SECOND"};
    what.Cells = [](const Meter &meter, const std::string &, FleetSession &)
    {
        return std::vector<std::string>{std::to_string(meter.Count()), NumberText(meter.MeanBytes(), 0, " B"),
                                        NumberText(OnAir(meter), 0, " B"),
                                        NumberText(OnAir(meter) * meter.Rate(), 0, " B/s")};
    };
    what.Members = [](const Meter &meter, const std::string &, FleetSession &, nlohmann::ordered_json &object)
    {
        object["values"] = meter.Count();
        object["bytes"] = JsonNumber(meter.MeanBytes());
        object["air_bytes"] = JsonNumber(OnAir(meter));
        object["air_bytes_per_s"] = JsonNumber(OnAir(meter) * meter.Rate());
    };
    AddMeterCommand(app, chosen, std::move(what));
}

}  // namespace Rabit::Tool
