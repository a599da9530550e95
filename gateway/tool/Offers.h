#pragma once

#include <rabit/base/NaturalOrder.h>

#include <cstdint>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "FleetSession.h"

// The announcements of the nodes, grouped by messages and types.
namespace Rabit::Tool::Offers
{

// One message name with one type in one definition.
struct Message
{
    std::string Name;
    std::string Type;
    std::string Qos;
    std::uint64_t Definition = 0;
    std::vector<std::string> Publishers;  // nodes
};
std::vector<Message> MessagesOf(const std::vector<FleetSession::Node> &nodes);

// For each type name, which nodes have which definition of it; published or accepted.
using Definitions = std::map<std::uint64_t, std::set<std::string, NaturalOrder>>;
std::map<std::string, Definitions> TypesOf(const std::vector<FleetSession::Node> &nodes);

// A line for each type of which there is more than one definition.
std::vector<std::string> Differences(const std::vector<FleetSession::Node> &nodes);

// True if every node that is not LOST has announced itself.
bool AreComplete(const std::vector<FleetSession::Node> &nodes);

// True if a live node is there, and all live nodes told that they hear the nodes that this program hears, and
// no others.
bool DoAllHearTheSame(const std::vector<FleetSession::Node> &nodes);

// Seconds from the start of a session in which every node beats: 1.5, or twice the longest period that the
// nodes announce which were heard. Nodes with a budget beat seldom, and a beat may be lost.
double SecondsToHearEverybody(const std::vector<FleetSession::Node> &nodes);

// True if no announcement can come any more from the nodes that `pattern` means: the one node of that name
// has announced itself, or `isEverybodyHeard`, nodes were heard, and each node that matches and is not LOST
// has.
bool AreAllThere(const std::vector<FleetSession::Node> &nodes, const std::string &pattern,
                 bool isEverybodyHeard);

// Returns the line for a node that is LOST, or was not heard within `seconds`. It proposes a similar name,
// else it lists the live nodes. A name with other digits is never proposed: `uav1` is no typo of `uav2`, but
// another aircraft.
std::string NoSuchNode(const std::string &name, const std::vector<FleetSession::Node> &nodes, double seconds);

// Returns sixteen hexadecimal digits.
std::string HashText(std::uint64_t definition);

}  // namespace Rabit::Tool::Offers
