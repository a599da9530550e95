#include "LawnMower.h"

#include <algorithm>
#include <cmath>

namespace Swarm
{

LawnMower::LawnMower(const Uav::SearchArea &area, std::size_t rank, std::size_t aircraft)
    : _middle{area.latitude_deg, area.longitude_deg, area.altitude_m},
      _lanesRunNorth(area.north_m > area.east_m),
      _halfLengthM(std::max(area.north_m, area.east_m) / 2.0 + TurnM),
      _breadthM(std::min(area.north_m, area.east_m)),
      _lanes(static_cast<std::size_t>(std::max(1.0, std::ceil(_breadthM / area.lane_m)))),
      _lane(_lanes * rank / std::max<std::size_t>(aircraft, 1) % _lanes)
{
}

// The offset of the lane, across from the middle of the area.
double LawnMower::LaneM() const
{
    return _breadthM * ((static_cast<double>(_lane) + 0.5) / static_cast<double>(_lanes) - 0.5);
}

GeoPoint LawnMower::PointAt(const Place &place) const
{
    const double across = LaneM() + place.BesideM;
    return Moved(_middle, _lanesRunNorth ? Offset{place.AlongM, across, 0} : Offset{across, place.AlongM, 0});
}

LawnMower::Place LawnMower::PlaceOf(const GeoPoint &point) const
{
    const Offset way = Between(_middle, point);
    return _lanesRunNorth ? Place{way.NorthM, way.EastM - LaneM()} : Place{way.EastM, way.NorthM - LaneM()};
}

// Begins the lane at the end that is nearer to a place at `alongM`.
void LawnMower::BeginLane(std::size_t lane, double alongM)
{
    _lane = lane;
    _direction = alongM < 0 ? 1 : -1;
    _comeToM = -_direction * _halfLengthM;
    _onLane = false;
}

GeoPoint LawnMower::Next(const GeoPoint &from)
{
    Place place = PlaceOf(from);
    if (!_chosen)
        BeginLane(_lane, place.AlongM);
    _chosen = true;
    if (_onLane && place.AlongM * _direction >= _halfLengthM)
    {
        BeginLane((_lane + 1) % _lanes, place.AlongM);
        place = PlaceOf(from);
    }
    if (!_onLane)
    {
        if (std::hypot(place.AlongM - _comeToM, place.BesideM) > NearM)
            return PointAt({_comeToM, 0});
        _onLane = _begun = true;
    }
    _comeToM = std::clamp(place.AlongM, -_halfLengthM, _halfLengthM);
    return PointAt({place.AlongM + _direction * AheadM, -Counter * place.BesideM});
}

void LawnMower::Interrupt()
{
    _onLane = false;  // Next leads back to its place on the lane
}

}  // namespace Swarm
