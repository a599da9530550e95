#pragma once

#include <rabit/simulated/SimulatedNetwork.h>

#include <cstddef>
#include <deque>
#include <string>
#include <vector>

#include "Medium.h"

namespace Rabit::Simulated
{

// Assigns media to nodes. Nodes have the numbers of the fault plan, given out one after the other.
class MediumPlan
{
public:
    // Makes a medium for the nodes that fit the pattern, or changes the one made for it.
    void Set(const std::string &nodes, const SimulatedMedium &settings);
    // Adds a node that has no number yet; it gets the next one.
    void AddNode(const std::string &node);
    // The medium made last that the node fits; nullptr if there is none.
    Medium *Of(std::uint32_t node) { return _of[node]; }
    const Medium *Of(std::uint32_t node) const { return _of[node]; }
    std::size_t NumberOf(const Medium &medium) const;
    Medium &ByNumber(std::size_t number) { return _media[number].Medium; }
    // Statistics of the medium of that pattern; zeros if none was made.
    SimulatedAir AirOf(const std::string &nodes) const;

private:
    struct Entry
    {
        std::string Nodes;
        Simulated::Medium Medium;
    };

    Medium *Find(const std::string &node);

    std::deque<Entry> _media;  // elements keep their addresses
    std::vector<std::string> _names;
    std::vector<Medium *> _of;  // by node
};

}  // namespace Rabit::Simulated
