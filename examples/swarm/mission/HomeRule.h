#pragma once

#include <string>

namespace Swarm
{

// When an aircraft must go home for a reason of its own: its battery is low, or the ground station, having
// been heard before, is silent for too long. Each cause counts once, until it has passed. Not thread-safe.
class HomeRule
{
public:
    static constexpr float LowBatteryPercent = 25;

    explicit HomeRule(double silenceLimitS) : _silenceLimitS(silenceLimitS) {}

    // Both may be NaN: not known, and never heard. Empty if there is nothing new; otherwise why to go home.
    std::string Judge(float batteryPercent, double groundSilentS);
    // Why the aircraft should be at home now; empty if it need not.
    std::string Reason() const;

private:
    const double _silenceLimitS;
    bool _low = false;
    bool _silent = false;
};

}  // namespace Swarm
