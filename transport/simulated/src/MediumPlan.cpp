#include "MediumPlan.h"

#include <algorithm>

#include "PartitionMatch.h"

namespace Rabit::Simulated
{

void MediumPlan::Set(const std::string &nodes, const SimulatedMedium &settings)
{
    const auto same = [&](const Entry &entry) { return entry.Nodes == nodes; };
    const auto known = std::find_if(_media.begin(), _media.end(), same);
    if (known != _media.end())
    {
        known->Medium.Set(settings);
        return;
    }
    _media.push_back({nodes, {}});
    _media.back().Medium.Set(settings);
    for (std::size_t i = 0; i < _names.size(); ++i)
    {
        _of[i] = Find(_names[i]);
    }
}

void MediumPlan::AddNode(const std::string &node)
{
    _names.push_back(node);
    _of.push_back(Find(node));
}

Medium *MediumPlan::Find(const std::string &node)
{
    const auto fits = [&](const Entry &entry) { return PatternFits(entry.Nodes, node); };
    const auto found = std::find_if(_media.rbegin(), _media.rend(), fits);
    return found == _media.rend() ? nullptr : &found->Medium;
}

std::size_t MediumPlan::NumberOf(const Medium &medium) const
{
    std::size_t number = 0;
    while (&_media[number].Medium != &medium)
    {
        ++number;
    }
    return number;
}

SimulatedAir MediumPlan::AirOf(const std::string &nodes) const
{
    const auto same = [&](const Entry &entry) { return entry.Nodes == nodes; };
    const auto known = std::find_if(_media.begin(), _media.end(), same);
    return known == _media.end() ? SimulatedAir() : known->Medium.Air();
}

}  // namespace Rabit::Simulated
