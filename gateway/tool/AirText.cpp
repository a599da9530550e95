#include "AirText.h"

#include <rabit/gateway/ClassRates.h>

#include <charconv>
#include <cstdint>

namespace Rabit::Tool
{

std::optional<Gateway::AirStatus> AirStatusOf(const std::string &report)
{
    Gateway::AirStatus air;
    const char *next = report.data();
    const char *const end = next + report.size();
    std::vector<double *> rates{&air.budget, &air.capacity, &air.used, &air.discovery};
    for (const auto &[name, rate] : ClassRates)
    {
        rates.push_back(&(air.*rate));
    }
    for (double *const rate : rates)
    {
        std::uint64_t number = 0;
        const auto [after, error] = std::from_chars(next, end, number);
        // Older nodes have no class foreign.
        if (rate == &air.foreign && next == end)
        {
            break;
        }
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
