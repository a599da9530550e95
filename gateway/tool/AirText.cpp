#include "AirText.h"

#include <charconv>
#include <cstdint>

namespace Rabit::Tool
{

std::optional<Gateway::AirStatus> AirStatusOf(const std::string &report)
{
    Gateway::AirStatus air;
    const char *next = report.data();
    const char *const end = next + report.size();
    for (double *const rate : {&air.budget, &air.capacity, &air.used, &air.discovery, &air.presence,
                               &air.command, &air.state, &air.telemetry, &air.bulk})
    {
        std::uint64_t number = 0;
        const auto [after, error] = std::from_chars(next, end, number);
        if (error != std::errc())
        {
            return std::nullopt;
        }
        *rate = static_cast<double>(number);
        next = after < end ? after + 1 : end;
    }
    return air;
}

}  // namespace Rabit::Tool
