#pragma once

#include "FleetPlan.h"

#include <ostream>
#include <string>
#include <vector>

namespace Rabit::Sim
{

// One run of one node's process, numbered over all nodes of a run.
struct Life
{
    std::size_t Node = 0;
    bool Leaving = false;  // its gateway is closing: what waits has no future
    bool Ended = false;
    Time EndedAt{0};  // true time
};

// The shared state of a run: the true time, the live processes, and the first violation.
struct FleetWorld
{
    const FleetPlan &Plan;
    std::ostream *Trace = nullptr;
    Time Now{0};
    std::vector<Life> Lives;
    std::string Failure{};
    // The last time that a node came or went, an outage ended, or a medium changed its rate.
    Time DisturbedAt{0};

    // The numbers are those of the list in tests/simulation/README.md.
    void Fail(int invariant, const std::string &what)
    {
        if (Failure.empty())
        {
            Failure = "invariant " + std::to_string(invariant) + ": " + what + ", at " +
                      std::to_string(static_cast<double>(Now.count()) / 1e9) + " s";
        }
    }

    void Say(const std::string &what) const
    {
        if (Trace != nullptr)
        {
            *Trace << std::to_string(static_cast<double>(Now.count()) / 1e9) << "  " << what << '\n';
        }
    }

    const std::string &NameOf(std::size_t node) const { return Plan.Machines[node].Name; }
};

}  // namespace Rabit::Sim
