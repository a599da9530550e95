#include "TargetBook.h"

#include "FindingProgress.h"
#include "TargetName.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace Swarm
{

double LevelDistanceM(const GeoPoint &a, const GeoPoint &b)
{
    const Offset way = Between(a, b);
    return std::hypot(way.NorthM, way.EastM);
}

bool IsSame(const SpokenOf &a, const SpokenOf &b, const Uav::Targets &targets)
{
    const auto find = [&](const Uav::TargetName &name)
    {
        return std::find_if(targets.items.begin(), targets.items.end(),
                            [&](const Uav::Target &target) { return Common::IsCalled(target, name); });
    };
    const auto first = find(a.Name);
    const auto second = find(b.Name);
    if (first != targets.items.end() && second != targets.items.end())
        return first == second;
    return (a.Name == b.Name && Common::MakesSense(a.Name)) ||
           LevelDistanceM(a.Place, b.Place) < TargetBook::NearM;
}

void TargetBook::Follow(const Uav::Targets &targets, std::uint32_t pursued)
{
    for (Entry &entry : _entries)
        for (const Uav::Target &target : targets.items)
            if (Common::IsCalled(target, entry.Finding.name))
            {
                entry.Finding.name = target.name;
                entry.Finding.latitude_deg = target.latitude_deg;
                entry.Finding.longitude_deg = target.longitude_deg;
            }
    MergeThoseOfOneName(pursued);
}

void TargetBook::MergeThoseOfOneName(std::uint32_t pursued)
{
    for (std::size_t i = 0; i < _entries.size(); ++i)
        for (std::size_t j = _entries.size() - 1; j > i; --j)
        {
            Entry &kept = _entries[i];
            const Entry &other = _entries[j];
            if (!(kept.Finding.name == other.Finding.name) || !Common::MakesSense(kept.Finding.name))
                continue;
            const std::uint32_t number = other.Finding.target == pursued ? pursued : kept.Finding.target;
            if (Common::ProgressOf(other.Finding) > Common::ProgressOf(kept.Finding))
                kept = other;
            kept.Finding.target = number;
            _entries.erase(_entries.begin() + static_cast<std::ptrdiff_t>(j));
        }
}

std::uint32_t TargetBook::TakeUp(const Knowledge &known)
{
    for (const Uav::Target &target : known.Targets.items)
    {
        const bool seenNow = target.own_detections > 0 && target.own_gps_time_s > known.GpsTimeS - FreshS;
        const bool isOurs = target.found_by == _aircraft || !known.Others.contains(target.found_by);
        if (!seenNow || !isOurs || IsOthers(target, known))
            continue;
        Entry *old = FindSame(target, known.Targets);
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

// True if another aircraft has the target. Unfinished targets of an absent aircraft do not count.
bool TargetBook::IsOthers(const Uav::Target &target, const Knowledge &known)
{
    for (const auto &[aircraft, findings] : known.OthersFindings)
        for (const Uav::Finding &finding : findings.items)
        {
            const bool hasEnd = finding.stage == Uav::TargetStage::TARGET_VALIDATED ||
                                finding.stage == Uav::TargetStage::TARGET_TRACKED;
            if ((hasEnd || known.Others.contains(aircraft)) &&
                IsSame({target.name, PlaceOf(target)}, {finding.name, PlaceOf(finding)}, known.Targets))
                return true;
        }
    return false;
}

TargetBook::Entry *TargetBook::FindSame(const Uav::Target &target, const Uav::Targets &targets)
{
    const auto same = std::find_if(_entries.begin(), _entries.end(),
                                   [&](const Entry &entry) {
                                       return IsSame({target.name, PlaceOf(target)},
                                                     {entry.Finding.name, PlaceOf(entry.Finding)}, targets);
                                   });
    return same == _entries.end() ? nullptr : &*same;
}

// Adds the target under the number of its name, or the next free one.
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
    entry.Finding.target = std::max<std::uint32_t>(target.name.number, 1);  // 0 is none
    entry.Finding.name = target.name;
    while (Find(entry.Finding.target))
        ++entry.Finding.target;
    entry.Finding.latitude_deg = target.latitude_deg;
    entry.Finding.longitude_deg = target.longitude_deg;
    _entries.push_back(entry);
    return entry.Finding.target;
}

Uav::Finding *TargetBook::Find(std::uint32_t number)
{
    return const_cast<Uav::Finding *>(std::as_const(*this).Find(number));
}

const Uav::Finding *TargetBook::Find(std::uint32_t number) const
{
    for (const Entry &entry : _entries)
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
