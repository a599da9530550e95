#pragma once

#include "../Geo.h"
#include "BadInput.h"

#include <string>
#include <vector>

namespace Swarm
{

// A world file that cannot be used. what() is one line for a person: `file:line: what is wrong`, or
// `file: reason` if the file cannot be read at all.
class WorldError : public Common::BadInput
{
public:
    using Common::BadInput::BadInput;
};

// Something on the ground that a camera can see. It stands, or walks back and forth.
struct WorldTarget
{
    GeoPoint Start;
    double SpeedMps = 0;    // 0: stands
    double HeadingRad = 0;  // from the start, clockwise from true north
    double LengthM = 0;     // of the way, above 0 if it walks

    // The place depends on GPS time alone, so that all processes see the target at the same place.
    GeoPoint At(double gpsTimeS) const;
};

// The world that simulated cameras see.
//
// The file is YAML:
//   ground_m: 430                 # height of the ground above mean sea level, -500 to 9000
//   targets:                      # up to 1000
//     - {latitude_deg: 47.3985, longitude_deg: 8.5462}
//     - {latitude_deg: 47.3969, longitude_deg: 8.5421, walk: {speed_mps: 1.2, heading_deg: 60, length_m: 50}}
struct World
{
    double GroundM = 0;
    std::vector<WorldTarget> Targets;

    // Throws WorldError.
    static World Load(const std::string &file);
    // The same of a text; `name` stands for the file in errors.
    static World Parse(const std::string &text, const std::string &name);
};

}  // namespace Swarm
