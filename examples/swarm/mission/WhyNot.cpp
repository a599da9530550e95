#include "WhyNot.h"

#include <cmath>

namespace Swarm
{
namespace
{
// All written so that a NaN is refused as well.
std::string OfPlace(double latitudeDeg, double longitudeDeg)
{
    if (!(std::abs(latitudeDeg) <= 90))
        return "latitude_deg is not between -90 and 90";
    if (!(std::abs(longitudeDeg) <= 180))
        return "longitude_deg is not between -180 and 180";
    return "";
}

std::string OfFlight(double altitudeM, float speedMps)
{
    if (!(altitudeM >= -500 && altitudeM <= 10000))
        return "altitude_m is not between -500 and 10000";
    if (!(speedMps > 0 && speedMps <= 50))
        return "speed_mps is not above 0 and up to 50";
    return "";
}
}  // namespace

std::string WhyNot(const Uav::Goto &command)
{
    const std::string place = OfPlace(command.latitude_deg, command.longitude_deg);
    return place.empty() ? OfFlight(command.altitude_m, command.speed_mps) : place;
}

std::string WhyNot(const Uav::SearchArea &area)
{
    std::string problem = OfPlace(area.latitude_deg, area.longitude_deg);
    if (problem.empty())
        problem = OfFlight(area.altitude_m, area.speed_mps);
    if (!problem.empty())
        return problem;
    if (!(area.north_m >= 10 && area.north_m <= 20000))
        return "north_m is not between 10 and 20000";
    if (!(area.east_m >= 10 && area.east_m <= 20000))
        return "east_m is not between 10 and 20000";
    if (!(area.lane_m >= 5 && area.lane_m <= 1000))
        return "lane_m is not between 5 and 1000";
    return "";
}

std::string WhyNot(const Uav::TargetReport &report)
{
    if (report.seen_by.empty())
        return "seen_by is empty";
    if (!(report.sigma_m >= 0 && report.sigma_m <= 1000))
        return "sigma_m is not between 0 and 1000";
    return OfPlace(report.latitude_deg, report.longitude_deg);
}

}  // namespace Swarm
