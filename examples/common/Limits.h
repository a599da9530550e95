// The allowed ranges of the numbers of a search area and of a point to fly to. Senders and receivers both
// use them, so that they cannot disagree.
#pragma once

#include <string>

namespace Common
{

struct Range
{
    double Lowest;
    double Highest;

    // Both ends belong to it. False for a NaN.
    constexpr bool Contains(double value) const { return value >= Lowest && value <= Highest; }
};

inline constexpr Range LatitudeDeg{-90, 90};
inline constexpr Range LongitudeDeg{-180, 180};
inline constexpr Range AltitudeM{-500, 10'000};
inline constexpr Range SpeedMps{0.1, 50};
inline constexpr Range SideM{10, 20'000};
inline constexpr Range LaneM{5, 1000};

// Empty if the range contains the value, otherwise one line for a person: `north_m must be from 10 to
// 20000, not 5`.
std::string WhyNot(const std::string &name, double value, const Range &range);
std::string WhyNot(const std::string &name, float value, const Range &range);

// Calls visit(name, number, range) for each number of a Uav::SearchArea that a person chooses, in the order
// of the IDL. A double within its range stays in it when it is converted to float, as some members are.
template <typename Area, typename Visit>
void ForEachNumberOfArea(Area &area, Visit visit)
{
    visit("latitude_deg", area.latitude_deg, LatitudeDeg);
    visit("longitude_deg", area.longitude_deg, LongitudeDeg);
    visit("north_m", area.north_m, SideM);
    visit("east_m", area.east_m, SideM);
    visit("altitude_m", area.altitude_m, AltitudeM);
    visit("speed_mps", area.speed_mps, SpeedMps);
    visit("lane_m", area.lane_m, LaneM);
}

// The same for the point of a command and the speed on the way there: Uav::Goto, Ground::Order.
template <typename Command, typename Visit>
void ForEachNumberOfGoto(Command &command, Visit visit)
{
    visit("latitude_deg", command.latitude_deg, LatitudeDeg);
    visit("longitude_deg", command.longitude_deg, LongitudeDeg);
    visit("altitude_m", command.altitude_m, AltitudeM);
    visit("speed_mps", command.speed_mps, SpeedMps);
}

}  // namespace Common
