#pragma once

#include "../Geo.h"
#include "uav.idl.h"

#include <cstddef>

namespace Swarm
{

// Plans the search of an area in lanes along its longer side. Each lane begins at its nearer end. The
// search repeats endlessly, and after an interruption goes on at the same place.
//
// Each of several aircraft begins at another lane and goes on through all lanes. So the loss of an aircraft
// leaves no part of the area out.
class LawnMower
{
public:
    // An aircraft on a lane aims at a point this far ahead, and has reached a place when it is this near:
    // about the size of its turning circle.
    static constexpr double AheadM = 90;
    static constexpr double NearM = 60;
    // Room to turn at both ends of a lane, outside the area.
    static constexpr double TurnM = 50;
    // An aircraft beside the lane aims at the other side of the lane, at this multiple of its distance.
    static constexpr double Counter = 2;

    // The area must be valid. `rank` is the place of this aircraft among `aircraft` aircraft, counted from
    // 0.
    LawnMower(const Uav::SearchArea &area, std::size_t rank, std::size_t aircraft);

    // The next point to fly to from there. Moves on to the next lane at the end of one.
    GeoPoint Next(const GeoPoint &from);
    // The aircraft is led away: the next call of Next leads it back.
    void Interrupt();
    // True if the aircraft has reached its first lane.
    bool HasBegun() const { return _begun; }
    std::size_t Lane() const { return _lane; }
    std::size_t Lanes() const { return _lanes; }

private:
    struct Place
    {
        double AlongM = 0;
        double BesideM = 0;  // the lane
    };

    GeoPoint PointAt(const Place &place) const;
    Place PlaceOf(const GeoPoint &point) const;
    double LaneM() const;
    void BeginLane(std::size_t lane, double alongM);

    GeoPoint _middle;
    bool _lanesRunNorth;
    double _halfLengthM;
    double _breadthM;
    std::size_t _lanes;
    std::size_t _lane;
    double _direction = 1;  // along the lane
    double _comeToM = 0;    // the place on the lane to fly it from
    bool _onLane = false;
    bool _begun = false;
    bool _chosen = false;  // the end of the first lane to begin at is chosen
};

}  // namespace Swarm
