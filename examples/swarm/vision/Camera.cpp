#include "Camera.h"

#include <cmath>

namespace Swarm
{

GeoPoint Footprint::At(const Place &place) const
{
    const double right = place.Right * HalfWidthM;
    const double forward = place.Forward * HalfDepthM;
    return Moved(Centre, {forward * std::cos(YawRad) - right * std::sin(YawRad),
                          forward * std::sin(YawRad) + right * std::cos(YawRad), 0});
}

Footprint::Place Footprint::Find(const GeoPoint &point) const
{
    const Offset way = Between(Centre, point);
    return {(way.EastM * std::cos(YawRad) - way.NorthM * std::sin(YawRad)) / HalfWidthM,
            (way.NorthM * std::cos(YawRad) + way.EastM * std::sin(YawRad)) / HalfDepthM};
}

std::optional<Footprint> Camera::LookDown(const Uav::Pose &pose, double groundM)
{
    const double height = pose.altitude_m - groundM;
    if (!(height >= LowestM))
        return std::nullopt;
    Footprint view;
    view.Centre = {pose.latitude_deg, pose.longitude_deg, groundM};
    view.YawRad = pose.yaw_rad;
    view.HeightM = height;
    view.HalfWidthM = height * std::tan(HalfAngleRad);
    view.HalfDepthM = view.HalfWidthM * DepthPerWidth;
    return view;
}

std::vector<Uav::Detection> Camera::Detect(const Footprint &view, const World &world, double gpsTimeS)
{
    constexpr std::size_t maxDetections = 64;  // the bound of Uav::Detections
    const double sigma = SigmaPerHeight * view.HeightM;
    std::bernoulli_distribution isSeen(SeenShare);
    std::vector<Uav::Detection> seen;
    for (const WorldTarget &target : world.Targets)
    {
        const GeoPoint place = target.At(gpsTimeS);
        if (view.Find(place).IsInside() && isSeen(_random) && seen.size() < maxDetections)
            seen.push_back(Noisy(place, sigma));
    }
    std::uniform_real_distribution<double> anywhere(-1, 1);
    for (int alarms = std::poisson_distribution<int>(FalseAlarmsPerFrame)(_random);
         alarms > 0 && seen.size() < maxDetections; --alarms)
    {
        const double right = anywhere(_random);
        seen.push_back(Noisy(view.At({right, anywhere(_random)}), sigma));
    }
    return seen;
}

Uav::Detection Camera::Noisy(const GeoPoint &point, double sigmaM)
{
    std::normal_distribution<double> error(0, sigmaM);
    const double north = error(_random);
    const GeoPoint place = Moved(point, {north, error(_random), 0});
    Uav::Detection detection;
    detection.latitude_deg = place.LatitudeDeg;
    detection.longitude_deg = place.LongitudeDeg;
    detection.sigma_m = static_cast<float>(sigmaM);
    return detection;
}

}  // namespace Swarm
