#include "HomeRule.h"

namespace Swarm
{

// The comparisons are written so that a NaN is no cause.
std::string HomeRule::Judge(float batteryPercent, double groundSilentS)
{
    const bool low = batteryPercent < LowBatteryPercent;
    const bool silent = groundSilentS > _silenceLimitS;
    const bool news = (low && !_low) || (silent && !_silent);
    _low = low;
    _silent = silent;
    return news ? Cause() : "";
}

std::string HomeRule::Reason() const
{
    if (_low)
        return "the battery is low";
    return _silent ? "the ground station is silent" : "";
}

std::string HomeRule::Cause() const
{
    return _silent && !_low ? "the ground station was silent" : Reason();
}

}  // namespace Swarm
