#include "LawnMower.h"

#include <algorithm>
#include <cmath>

namespace Swarm
{

LawnMower::LawnMower(const Uav::SearchArea &area, std::size_t rank, std::size_t aircraft)
    : _middle{area.latitude_deg, area.longitude_deg, area.altitude_m},
      _lanesRunNorth(area.north_m > area.east_m),
      _halfLengthM(std::max(area.north_m, area.east_m) / 2.0),
      _breadthM(std::min(area.north_m, area.east_m)),
      _lanes(static_cast<std::size_t>(std::max(1.0, std::ceil(_breadthM / area.lane_m)))),
      _lane(_lanes * rank / std::max<std::size_t>(aircraft, 1) % _lanes)
{
}

GeoPoint LawnMower::PointOn(double alongM) const
{
    const double across =
        _breadthM * ((static_cast<double>(_lane) + 0.5) / static_cast<double>(_lanes) - 0.5);
    return Moved(_middle, _lanesRunNorth ? Offset{alongM, across, 0} : Offset{across, alongM, 0});
}

double LawnMower::AlongM(const GeoPoint &point) const
{
    const Offset way = Between(_middle, point);
    return _lanesRunNorth ? way.NorthM : way.EastM;
}

// From the end that is nearer to a place so far along it.
void LawnMower::BeginLane(std::size_t lane, double alongM)
{
    _lane = lane;
    _direction = alongM < 0 ? 1 : -1;
    _comeToM = -_direction * _halfLengthM;
    _onLane = false;
}

GeoPoint LawnMower::Next(const GeoPoint &from)
{
    const double along = AlongM(from);
    if (!_chosen)
        BeginLane(_lane, along);
    _chosen = true;
    if (_onLane && along * _direction >= _halfLengthM)
        BeginLane((_lane + 1) % _lanes, along);
    if (!_onLane)
    {
        const GeoPoint place = PointOn(_comeToM);
        const Offset way = Between(from, place);
        if (std::hypot(way.NorthM, way.EastM) > NearM)
            return place;
        _onLane = _begun = true;
    }
    _comeToM = std::clamp(along, -_halfLengthM, _halfLengthM);
    return PointOn(along + _direction * AheadM);
}

void LawnMower::Interrupt()
{
    _onLane = false;  // Next comes to where it was on the lane
}

}  // namespace Swarm
