#pragma once

#include "../Geo.h"
#include "uav.idl.h"

#include <cstddef>

namespace Swarm
{

// Where to fly to search an area in lanes, along its longer side, each begun at the end that is nearer. It
// goes on around for ever, and comes back to the place where it was interrupted.
//
// Each of several aircraft begins at another lane and goes on through all of them, so that losing one leaves
// no part of the area out.
class LawnMower
{
public:
    // An aircraft on a lane aims at a point so far ahead, and counts as having come to a place when it is so
    // near: about its turning circle.
    static constexpr double AheadM = 90;
    static constexpr double NearM = 60;
    // Room to turn at both ends of a lane, outside the area.
    static constexpr double TurnM = 50;
    // An aircraft beside the lane aims at a point so much farther to its other side.
    static constexpr double Counter = 2;

    // A valid area, and which of how many aircraft this one is, counted from 0.
    LawnMower(const Uav::SearchArea &area, std::size_t rank, std::size_t aircraft);

    // Where to fly to from there. Moves on to the next lane at the end of one.
    GeoPoint Next(const GeoPoint &from);
    // The aircraft is led away: the next call of Next leads it back.
    void Interrupt();
    // Whether it has come to its first lane.
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
    bool _chosen = false;  // which end of the first lane to begin at
};

}  // namespace Swarm
