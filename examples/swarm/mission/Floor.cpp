#include "Floor.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>

namespace Swarm
{
namespace
{
// Accepts a floor that was rounded to a float.
constexpr double ToleranceM = 0.01;

// Metres, with a decimal only where there is one.
std::string Metres(double value)
{
    const double tenths = std::round(value * 10);
    std::array<char, 64> text{};
    std::snprintf(text.data(), text.size(), std::fmod(tenths, 10) == 0 ? "%.0f m" : "%.1f m", tenths / 10);
    return text.data();
}

std::string AgainstGround(double aboveM)
{
    if (aboveM < 0)
        return Metres(-aboveM) + " below the ground";
    return Metres(aboveM) + " above the ground";
}
}  // namespace

std::optional<double> Floor::LowestM() const
{
    std::optional<double> lowest = _settings.AboveSeaM;
    if (_settings.GroundM)
        lowest = std::max(lowest.value_or(-INFINITY), *_settings.GroundM + _settings.ClearanceM);
    return lowest;
}

std::string Floor::WhyTooLow(double altitudeM) const
{
    const std::optional<double> lowest = LowestM();
    if (!lowest || altitudeM >= *lowest - ToleranceM)
        return "";
    std::string why = Metres(altitudeM) + " above sea level is ";
    if (_settings.GroundM)
        why += AgainstGround(altitudeM - *_settings.GroundM) + " and ";
    return why + "below the floor of " + Metres(*lowest);
}

double Floor::Raised(double altitudeM) const
{
    return std::max(altitudeM, LowestM().value_or(altitudeM));
}

}  // namespace Swarm
