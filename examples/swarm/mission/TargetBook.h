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

// The targets that this aircraft found, and their findings. Not thread-safe.
class TargetBook
{
public:
    static constexpr double NearM = 25;  // two targets of two aircraft nearer than this may be the same
    static constexpr double FreshS = 5;  // its own camera has seen a new target within this time
    static constexpr double AgainAfterS = 120;  // a rejected target that is seen again gets another chance
    static constexpr std::size_t MaxFindings = 64;

    // The inputs to judge a target.
    struct Knowledge
    {
        double GpsTimeS = 0;
        const Uav::Targets &Targets;  // of this aircraft's own sensor fusion
        const std::map<std::string, Uav::Findings> &OthersFindings;
        const std::set<std::string> &Others;  // the aircraft present now
    };

    explicit TargetBook(std::string aircraft) : _aircraft(std::move(aircraft)) {}

    // Updates positions and names of the findings from the targets. If two findings turn out to be one
    // target, the one that got farther is kept, under the number of the pursued one.
    void Follow(const Uav::Targets &targets, std::uint32_t pursued);
    // Takes up a target for this aircraft to pursue. Its camera must see it now, and it must have seen it
    // first (or the first aircraft is absent). No aircraft may pursue it or have finished it. Returns its
    // number, 0 if there is none.
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

// Name and place of a target, as one of the aircraft knows it.
struct SpokenOf
{
    const Uav::TargetName &Name;
    GeoPoint Place;
};
// True if both are one target. Decides by the names if sensor fusion knows them, also as former names;
// otherwise by the places, as aircraft that have not met use different names.
bool IsSame(const SpokenOf &a, const SpokenOf &b, const Uav::Targets &targets);

// Where it is, at no height.
template <typename Seen>
GeoPoint PlaceOf(const Seen &seen)
{
    return {seen.latitude_deg, seen.longitude_deg, 0};
}
// Level distance in metres.
double LevelDistanceM(const GeoPoint &a, const GeoPoint &b);

}  // namespace Swarm
