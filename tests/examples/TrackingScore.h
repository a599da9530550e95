// Compares a fleet's reports of its targets with the truth.
#pragma once

#include "FleetTargets.h"
#include "TrackingFleet.h"

#include <cstddef>
#include <map>
#include <set>
#include <string>
#include <vector>

namespace SwarmTest
{

// Sums over samples. Not thread-safe.
//
// A listed target that was seen within FreshS is compared with the true places: pairs nearer than MatchM, the
// nearest first, each once.
//
// The list has names too many if the names outnumber the true targets with which they were ever matched. Each
// name is given a true target of its own from among these; the names that get none are too many. A name that
// moves from one target to another is not one too many: that is an identity switch.
// time. A name that goes from one target to another is not one too many; that is an identity switch.
class TrackingScore
{
public:
    static constexpr double FreshS = 3;
    static constexpr double MatchM = 12;
    static constexpr double VisibleS = 4;    // a target counts as visible when it was in view
    static constexpr int VisibleFrames = 8;  // of so many frames of the last seconds

    void Sample(const TrackingFleet &fleet, const std::vector<Ground::ListedTarget> &list);

    double Precision() const { return Share(_matched, _fresh); }
    double Recall() const { return Share(_recalled, _visible); }
    // Share of the time for which targets have names in which they have one too many.
    double Duplicates() const { return _named > 0 ? _doubled / _named : 0; }
    // How often a target was matched with another name than before, for each target and hour.
    double SwitchesPerHour() const { return _targetHours > 0 ? _switches / _targetHours : 0; }
    void Add(const TrackingScore &other);

private:
    static double Share(double part, double all) { return all > 0 ? part / all : 1; }

    std::size_t NamesTooMany(const std::vector<Ground::ListedTarget> &list) const;

    std::map<std::string, std::set<std::size_t>> _owners;  // of each name
    std::map<std::size_t, std::string> _nameOf;
    double _matched = 0, _fresh = 0, _recalled = 0, _visible = 0, _doubled = 0, _named = 0, _targetHours = 0;
    int _switches = 0;
};

}  // namespace SwarmTest
