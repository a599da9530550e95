#include "TrackingScore.h"

#include "TargetName.h"
#include "vision/Assignment.h"

#include <algorithm>
#include <cmath>
#include <tuple>

namespace SwarmTest
{
using Common::TextOf;

void TrackingScore::Sample(const TrackingFleet &fleet, const std::vector<Ground::ListedTarget> &list)
{
    const double now = TrackingFleet::StartS + fleet.TimeS();
    const auto &targets = fleet.World().Targets;
    std::vector<std::tuple<double, std::size_t, std::size_t>> pairs;
    for (std::size_t i = 0; i < list.size(); ++i)
    {
        if (list[i].Target->seen_gps_time_s < now - FreshS)
            continue;
        ++_fresh;
        for (std::size_t t = 0; t < targets.size(); ++t)
        {
            const Swarm::Offset way = Swarm::Between(
                targets[t].At(now), {list[i].Target->latitude_deg, list[i].Target->longitude_deg, 0});
            if (const double distance = std::hypot(way.NorthM, way.EastM); distance < MatchM)
                pairs.emplace_back(distance, i, t);
        }
    }
    std::sort(pairs.begin(), pairs.end());
    std::set<std::size_t> lines;
    std::set<std::size_t> found;
    for (const auto &[distance, i, t] : pairs)
    {
        if (lines.contains(i) || found.contains(t))
            continue;
        lines.insert(i);
        found.insert(t);
        ++_matched;
        _owners[TextOf(list[i].Name)].insert(t);
        const auto [known, isNew] = _nameOf.try_emplace(t, TextOf(list[i].Name));
        if (!isNew && known->second != TextOf(list[i].Name))
            ++_switches;
        known->second = TextOf(list[i].Name);
    }
    _doubled += static_cast<double>(NamesTooMany(list));
    _named += static_cast<double>(_nameOf.size());
    for (std::size_t t = 0; t < targets.size(); ++t)
        if (fleet.TimesSeen(t, VisibleS) >= VisibleFrames)
        {
            ++_visible;
            _recalled += found.contains(t) ? 1 : 0;
        }
    _targetHours += static_cast<double>(targets.size()) / 3600;
}

std::size_t TrackingScore::NamesTooMany(const std::vector<Ground::ListedTarget> &list) const
{
    std::vector<const std::set<std::size_t> *> owners;
    for (const Ground::ListedTarget &line : list)
        if (const auto known = _owners.find(TextOf(line.Name)); known != _owners.end())
            owners.push_back(&known->second);
    std::size_t tooMany = list.size() - owners.size();
    if (owners.empty())
        return tooMany;
    const auto names = static_cast<Eigen::Index>(owners.size());
    Eigen::MatrixXd costs =
        Eigen::MatrixXd::Ones(names, std::max(names, static_cast<Eigen::Index>(_nameOf.rbegin()->first + 1)));
    for (Eigen::Index i = 0; i < names; ++i)
        for (const std::size_t target : *owners[static_cast<std::size_t>(i)])
            costs(i, static_cast<Eigen::Index>(target)) = 0;
    const std::vector<int> targetOf = Swarm::Assign(costs);
    for (Eigen::Index i = 0; i < names; ++i)
        tooMany += costs(i, targetOf[static_cast<std::size_t>(i)]) > 0 ? 1 : 0;
    return tooMany;
}

void TrackingScore::Add(const TrackingScore &other)
{
    _matched += other._matched;
    _fresh += other._fresh;
    _recalled += other._recalled;
    _visible += other._visible;
    _doubled += other._doubled;
    _named += other._named;
    _targetHours += other._targetHours;
    _switches += other._switches;
}

}  // namespace SwarmTest
