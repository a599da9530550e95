#pragma once

#include "../Geo.h"
#include "uav.idl.h"

#include <cstdint>
#include <map>
#include <set>
#include <string>
#include <vector>

namespace Swarm
{

// The targets that this aircraft found, and what it has done about them. Not thread-safe.
class TargetBook
{
public:
    static constexpr double NearM = 25;         // nearer than this it is the same target
    static constexpr double FreshS = 5;         // its own camera has seen a new target within this time
    static constexpr double AgainAfterS = 120;  // a rejected target that is seen again gets another chance
    static constexpr double FarthestStepM = 100;
    static constexpr std::size_t MaxFindings = 64;

    // What is known when a target is judged.
    struct Knowledge
    {
        double GpsTimeS = 0;
        const Uav::Targets &Targets;  // of this aircraft's own sensor fusion
        const std::map<std::string, Uav::Findings> &OthersFindings;
        const std::set<std::string> &Others;  // who is there now
    };

    explicit TargetBook(std::string aircraft) : _aircraft(std::move(aircraft)) {}

    // Moves the findings along with the targets.
    void Follow(const Uav::Targets &targets);
    // Takes up a target that this aircraft is to pursue: one that its camera sees now, that it was the first
    // to see (or the first did not live to pursue it), and that neither it nor another aircraft pursues or
    // has done with. Returns its number, 0 if there is none.
    std::uint32_t TakeUp(const Knowledge &known);
    // The finding of that number; null if there is none. Valid until the next TakeUp or Drop.
    Uav::Finding *Find(std::uint32_t number);
    void Reject(std::uint32_t number, double gpsTimeS);
    void Drop(std::uint32_t number);

    std::vector<Uav::Finding> Report() const;

private:
    struct Entry
    {
        Uav::Finding Finding;
        double RejectedS = 0;
    };

    bool IsOthers(const GeoPoint &place, const Knowledge &known) const;
    Entry *NearestTo(const GeoPoint &place);
    std::uint32_t Add(const Uav::Target &target);

    const std::string _aircraft;
    std::vector<Entry> _entries;
};

// Where it is, at no height.
GeoPoint PlaceOf(const Uav::Finding &finding);
GeoPoint PlaceOf(const Uav::Target &target);
GeoPoint PlaceOf(const Uav::TargetReport &report);
// Level distance in metres.
double LevelDistanceM(const GeoPoint &a, const GeoPoint &b);

}  // namespace Swarm
