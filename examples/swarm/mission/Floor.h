#pragma once

#include <optional>
#include <string>

namespace Swarm
{

// How low an aircraft lets itself be led. All heights are metres above mean sea level.
//
// There are two limits, and the higher one holds: a height above sea level, and a clearance above the ground,
// which counts only where the height of the ground is known. With neither there is no floor.
//
// Immutable.
class Floor
{
public:
    struct Settings
    {
        std::optional<double> AboveSeaM{};  // none: there is no such limit
        std::optional<double> GroundM{};    // height of the ground where it flies; none: it is not known
        double ClearanceM = 30;             // above the ground, from 0
    };

    Floor() = default;
    explicit Floor(const Settings &settings) : _settings(settings) {}

    std::optional<double> GroundM() const { return _settings.GroundM; }
    // The lowest altitude that it may be led to; none: there is no floor.
    std::optional<double> LowestM() const;
    // Why it may not be led to that altitude, in one line for a person of up to 128 letters; empty if it may.
    std::string WhyTooLow(double altitudeM) const;
    // That altitude, or the floor if that is higher.
    double Raised(double altitudeM) const;

private:
    Settings _settings;
};

}  // namespace Swarm
