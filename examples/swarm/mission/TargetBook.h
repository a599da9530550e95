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
    static constexpr double NearM = 25;  // nearer than this what another aircraft speaks of may be meant
    static constexpr double FreshS = 5;  // its own camera has seen a new target within this time
    static constexpr double AgainAfterS = 120;  // a rejected target that is seen again gets another chance
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

    // Moves the findings along with the targets, and calls them what the fleet calls them now. Of two that
    // turn out to be one target the one that got farther is kept, under the number of the one that is
    // pursued.
    void Follow(const Uav::Targets &targets, std::uint32_t pursued);
    // Takes up a target that this aircraft is to pursue: one that its camera sees now, that it was the first
    // to see (or the first did not live to pursue it), and that neither it nor another aircraft pursues or
    // has done with. Returns its number, 0 if there is none.
    std::uint32_t TakeUp(const Knowledge &known);
    // The finding of that number; null if there is none. Valid until the next TakeUp or Drop.
    Uav::Finding *Find(std::uint32_t number);
    const Uav::Finding *Find(std::uint32_t number) const;
    void Reject(std::uint32_t number, double gpsTimeS);
    void Drop(std::uint32_t number);

    std::vector<Uav::Finding> Report() const;

private:
    struct Entry
    {
        Uav::Finding Finding;
        double RejectedS = 0;
    };

    static bool IsOthers(const Uav::Target &target, const Knowledge &known);
    void MergeThoseOfOneName(std::uint32_t pursued);
    Entry *FindSame(const Uav::Target &target, const Uav::Targets &targets);
    std::uint32_t Add(const Uav::Target &target);

    const std::string _aircraft;
    std::vector<Entry> _entries;
};

// A target, as one of the aircraft speaks of it.
struct SpokenOf
{
    const Uav::TargetName &Name;
    GeoPoint Place;
};
// Whether both mean one target: by their names if sensor fusion knows them, now or formerly, else by their
// places, as the names of aircraft that have not met yet say nothing.
bool IsSame(const SpokenOf &a, const SpokenOf &b, const Uav::Targets &targets);

// Where it is, at no height.
GeoPoint PlaceOf(const Uav::Finding &finding);
GeoPoint PlaceOf(const Uav::Target &target);
GeoPoint PlaceOf(const Uav::TargetReport &report);
// Level distance in metres.
double LevelDistanceM(const GeoPoint &a, const GeoPoint &b);

}  // namespace Swarm
