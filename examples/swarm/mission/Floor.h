#pragma once

#include <optional>
#include <string>

namespace Swarm
{

// The lowest altitude to which an aircraft obeys commands. All heights are metres above mean sea level.
//
// It is the higher of two limits: a height above sea level, and a clearance above the ground, which counts
// only if the height of the ground is known. Without either there is no floor.
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
    // The floor; nothing if there is none.
    std::optional<double> LowestM() const;
    // The reason to decline that altitude, as one line of at most 128 characters for a person; empty if it
    // is allowed.
    std::string WhyTooLow(double altitudeM) const;
    // That altitude, or the floor if that is higher.
    double Raised(double altitudeM) const;

private:
    Settings _settings;
};

}  // namespace Swarm
