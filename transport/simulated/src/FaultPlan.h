#pragma once

#include <rabit/simulated/SimulatedNetwork.h>

#include <cstdint>
#include <optional>
#include <string>
#include <unordered_map>
#include <vector>

#include "Random.h"

namespace Rabit::Simulated
{

// The faults between two nodes. Nodes have numbers here, so that a look-up compares no strings.
class FaultPlan
{
public:
    void Set(const std::string &from, const std::string &to, const SimulatedFaults &faults);
    void Clear();
    // The number of a node's name; assigned at the first call.
    std::uint32_t NumberOf(const std::string &node);
    // The number of a node's name; empty if none was assigned.
    std::optional<std::uint32_t> Find(const std::string &node) const;
    const SimulatedFaults &Between(std::uint32_t from, std::uint32_t to) { return FlowOf(from, to).Faults; }
    // True if the next datagram of that direction is lost, or cut off.
    bool Loses(std::uint32_t from, std::uint32_t to, Random &random);

private:
    struct Flow
    {
        SimulatedFaults Faults;
        bool IsInBurst = false;
    };
    Flow &FlowOf(std::uint32_t from, std::uint32_t to);

    struct Rule
    {
        std::string From;
        std::string To;
        SimulatedFaults Faults;
    };
    std::vector<Rule> _rules;
    std::vector<std::string> _names;
    std::unordered_map<std::string, std::uint32_t> _numbers;
    std::unordered_map<std::uint64_t, Flow> _found;  // by pair of numbers; emptied when rules change
};

}  // namespace Rabit::Simulated
