#pragma once

#include "../Geo.h"
#include "World.h"
#include "uav.idl.h"

#include <cstdint>
#include <optional>
#include <random>
#include <vector>

namespace Swarm
{

// The rectangle on the ground that a camera sees. Places in the image are fractions: right and forward from
// -1 to 1, where forward is the direction of the aircraft's nose.
struct Footprint
{
    struct Place
    {
        double Right = 0;
        double Forward = 0;

        bool IsInside() const { return Right >= -1 && Right <= 1 && Forward >= -1 && Forward <= 1; }
    };

    GeoPoint Centre;
    double YawRad = 0;
    double HeightM = 0;  // of the camera above it
    double HalfWidthM = 0;
    double HalfDepthM = 0;

    GeoPoint At(const Place &place) const;
    Place Find(const GeoPoint &point) const;
};

// A simulated camera and its image processing. It looks straight down at any bank angle, 60 degrees wide,
// 4:3. It detects most targets in its view, with small errors of position, and now and then gives a false
// alarm. All randomness comes from the seed. Not thread-safe.
class Camera
{
public:
    static constexpr double HalfAngleRad = 0.5235987755982988;  // to the sides
    static constexpr double DepthPerWidth = 0.75;
    static constexpr double LowestM = 5;  // below this height it sees nothing

    static constexpr double SeenShare = 0.85;            // of the targets in view
    static constexpr double FalseAlarmsPerFrame = 0.02;  // on average
    static constexpr double SigmaPerHeight = 0.03;       // one standard deviation, in north and in east

    explicit Camera(std::uint64_t seed) : _random(seed) {}

    // The ground in view from that pose; nothing if it is too low.
    static std::optional<Footprint> LookDown(const Uav::Pose &pose, double groundM);
    // The detections in that view at that time.
    std::vector<Uav::Detection> Detect(const Footprint &view, const World &world, double gpsTimeS);

private:
    Uav::Detection Noisy(const GeoPoint &point, double sigmaM);

    std::mt19937_64 _random;
};

}  // namespace Swarm
