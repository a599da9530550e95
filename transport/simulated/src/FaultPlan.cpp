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

FaultPlan::Flow &FaultPlan::FlowOf(std::uint32_t from, std::uint32_t to)
{
    const auto [entry, isNew] = _found.try_emplace(std::uint64_t{from} << 32 | to);
    if (isNew)
    {
        const auto fits = [&](const Rule &rule)
        { return PatternFits(rule.From, _names[from]) && PatternFits(rule.To, _names[to]); };
        const auto rule = std::find_if(_rules.rbegin(), _rules.rend(), fits);
        if (rule != _rules.rend())
        {
            entry->second.Faults = rule->Faults;
        }
    }
    return entry->second;
}

// In the long run the share `Loss` is lost. A loss near 1 makes the bursts longer, since a good link does not
// last less than a datagram.
bool FaultPlan::Loses(std::uint32_t from, std::uint32_t to, Random &random)
{
    Flow &flow = FlowOf(from, to);
    const double loss = flow.Faults.Loss;
    if (flow.Faults.Cut || loss <= 0 || loss >= 1 || flow.Faults.Burst <= 1)
    {
        return flow.Faults.Cut || random.Happens(loss);
    }
    const double burst = std::max(flow.Faults.Burst, loss / (1 - loss));
    if (random.Happens(flow.IsInBurst ? 1 / burst : loss / ((1 - loss) * burst)))
    {
        flow.IsInBurst = !flow.IsInBurst;
    }
    return flow.IsInBurst;
}

}  // namespace Rabit::Simulated
