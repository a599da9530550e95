#pragma once

#include <string>

namespace Swarm
{

// Decides when an aircraft flies home on its own: its battery is low, or the ground station, heard earlier,
// is silent for too long. Each cause counts once, until it has passed. Not thread-safe.
class HomeRule
{
public:
    static constexpr float LowBatteryPercent = 25;

    explicit HomeRule(double silenceLimitS) : _silenceLimitS(silenceLimitS) {}

    // Returns a new cause to fly home, see Cause; empty if there is none. The arguments may be NaN: not
    // known, and never heard.
    std::string Judge(float batteryPercent, double groundSilentS);
    // The reason why the aircraft should be at home now; empty if there is none.
    std::string Reason() const;
    // The same as it is told of a flight home, which may last longer than a silence.
    std::string Cause() const;

private:
    const double _silenceLimitS;
    bool _low = false;
    bool _silent = false;
};

}  // namespace Swarm
