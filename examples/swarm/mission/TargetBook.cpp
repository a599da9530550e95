#include "TargetBook.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace Swarm
{

GeoPoint PlaceOf(const Uav::Finding &finding)
{
    return {finding.latitude_deg, finding.longitude_deg, 0};
}

GeoPoint PlaceOf(const Uav::Target &target)
{
    return {target.latitude_deg, target.longitude_deg, 0};
}

GeoPoint PlaceOf(const Uav::TargetReport &report)
{
    return {report.latitude_deg, report.longitude_deg, 0};
}

double LevelDistanceM(const GeoPoint &a, const GeoPoint &b)
{
    const Offset way = Between(a, b);
    return std::hypot(way.NorthM, way.EastM);
}

// A number whose target is suddenly elsewhere is another target: sensor fusion has begun anew.
void TargetBook::Follow(const Uav::Targets &targets)
{
    for (Entry &entry : _entries)
        for (const Uav::Target &target : targets.items)
            if (target.number == entry.Finding.target &&
                LevelDistanceM(PlaceOf(target), PlaceOf(entry.Finding)) < FarthestStepM)
            {
                entry.Finding.latitude_deg = target.latitude_deg;
                entry.Finding.longitude_deg = target.longitude_deg;
            }
}

std::uint32_t TargetBook::TakeUp(const Knowledge &known)
{
    for (const Uav::Target &target : known.Targets.items)
    {
        const bool seenNow = target.own_detections > 0 && target.own_gps_time_s > known.GpsTimeS - FreshS;
        const bool isOurs = target.found_by == _aircraft || !known.Others.contains(target.found_by);
        if (!seenNow || !isOurs || IsOthers(PlaceOf(target), known))
            continue;
        Entry *old = NearestTo(PlaceOf(target));
        if (!old)
            return Add(target);
        const bool again = old->Finding.stage == Uav::TargetStage::TARGET_FOUND ||
                           (old->Finding.stage == Uav::TargetStage::TARGET_REJECTED &&
                            known.GpsTimeS - old->RejectedS > AgainAfterS);
        if (again)
            return old->Finding.target;
    }
    return 0;
}

// What an aircraft that is gone had not come to the end of is nobody's.
bool TargetBook::IsOthers(const GeoPoint &place, const Knowledge &known) const
{
    for (const auto &[aircraft, findings] : known.OthersFindings)
        for (const Uav::Finding &finding : findings.items)
        {
            const bool hasEnd = finding.stage == Uav::TargetStage::TARGET_VALIDATED ||
                                finding.stage == Uav::TargetStage::TARGET_TRACKED;
            if ((hasEnd || known.Others.contains(aircraft)) &&
                LevelDistanceM(place, PlaceOf(finding)) < NearM)
                return true;
        }
    return false;
}

TargetBook::Entry *TargetBook::NearestTo(const GeoPoint &place)
{
    Entry *nearest = nullptr;
    double nearestM = NearM;
    for (Entry &entry : _entries)
        if (const double distance = LevelDistanceM(place, PlaceOf(entry.Finding)); distance < nearestM)
        {
            nearest = &entry;
            nearestM = distance;
        }
    return nearest;
}

// Under the number that sensor fusion gave it, unless that was another target's before.
std::uint32_t TargetBook::Add(const Uav::Target &target)
{
    if (_entries.size() == MaxFindings)
    {
        const auto rejected = std::find_if(
            _entries.begin(), _entries.end(),
            [](const Entry &entry) { return entry.Finding.stage == Uav::TargetStage::TARGET_REJECTED; });
        _entries.erase(rejected == _entries.end() ? _entries.begin() : rejected);
    }
    Entry entry;
    entry.Finding.target = target.number;
    while (Find(entry.Finding.target))
        ++entry.Finding.target;
    entry.Finding.latitude_deg = target.latitude_deg;
    entry.Finding.longitude_deg = target.longitude_deg;
    _entries.push_back(entry);
    return entry.Finding.target;
}

Uav::Finding *TargetBook::Find(std::uint32_t number)
{
    for (Entry &entry : _entries)
        if (entry.Finding.target == number)
            return &entry.Finding;
    return nullptr;
}

void TargetBook::Reject(std::uint32_t number, double gpsTimeS)
{
    for (Entry &entry : _entries)
        if (entry.Finding.target == number)
        {
            entry.Finding.stage = Uav::TargetStage::TARGET_REJECTED;
            entry.RejectedS = gpsTimeS;
        }
}

void TargetBook::Drop(std::uint32_t number)
{
    std::erase_if(_entries, [&](const Entry &entry) { return entry.Finding.target == number; });
}

std::vector<Uav::Finding> TargetBook::Report() const
{
    std::vector<Uav::Finding> findings;
    for (const Entry &entry : _entries)
        findings.push_back(entry.Finding);
    return findings;
}

}  // namespace Swarm
