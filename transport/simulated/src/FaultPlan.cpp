#include "FaultPlan.h"

#include <algorithm>

#include "PartitionMatch.h"

namespace Rabit::Simulated
{

void FaultPlan::Set(const std::string &from, const std::string &to, const SimulatedFaults &faults)
{
    std::erase_if(_rules, [&](const Rule &rule) { return rule.From == from && rule.To == to; });
    _rules.push_back({from, to, faults});
    _found.clear();
}

void FaultPlan::Clear()
{
    _rules.clear();
    _found.clear();
}

std::uint32_t FaultPlan::NumberOf(const std::string &node)
{
    const auto [entry, isNew] = _numbers.try_emplace(node, static_cast<std::uint32_t>(_names.size()));
    if (isNew)
    {
        _names.push_back(node);
    }
    return entry->second;
}

std::optional<std::uint32_t> FaultPlan::Find(const std::string &node) const
{
    const auto found = _numbers.find(node);
    return found == _numbers.end() ? std::nullopt : std::optional(found->second);
}

const SimulatedFaults &FaultPlan::Between(std::uint32_t from, std::uint32_t to)
{
    const auto [entry, isNew] = _found.try_emplace(std::uint64_t{from} << 32 | to);
    if (isNew)
    {
        const auto fits = [&](const Rule &rule)
        { return PatternFits(rule.From, _names[from]) && PatternFits(rule.To, _names[to]); };
        const auto rule = std::find_if(_rules.rbegin(), _rules.rend(), fits);
        if (rule != _rules.rend())
        {
            entry->second = rule->Faults;
        }
    }
    return entry->second;
}

}  // namespace Rabit::Simulated
