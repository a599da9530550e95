#include "TargetName.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <tuple>

namespace Common
{

std::string TextOf(const Uav::TargetName &name)
{
    return std::string(name.aircraft).append("/").append(std::to_string(name.number));
}

bool IsOlder(const Uav::TargetName &first, const Uav::TargetName &second)
{
    return std::tie(first.since_gps_time_s, first.aircraft, first.number) <
           std::tie(second.since_gps_time_s, second.aircraft, second.number);
}

bool IsCalled(const Uav::Target &target, const Uav::TargetName &name)
{
    return target.name == name ||
           std::find(target.formerly.begin(), target.formerly.end(), name) != target.formerly.end();
}

bool MakesSense(const Uav::TargetName &name)
{
    constexpr std::uint32_t most = 1'000'000;
    return !name.aircraft.empty() && name.number != 0 && name.number <= most &&
           std::isfinite(name.since_gps_time_s);
}

}  // namespace Common
