#pragma once

#include <cstddef>
#include <cstdlib>
#include <string>
#include <utility>

namespace Swarm
{

// The names of an aircraft's messages, queues and managers in this process.
//
// An aircraft is two nodes: `uav1` flies, `uav1.vision` has the camera. Names of the local node are plain
// (`Pose`); those of every other node are full (`uav1/Pose`), and the gateway serves them. If no node is
// local, all names are full: then any number of whole aircraft share one workspace, without a gateway.
//
// Immutable; may be used from any thread.
class Names
{
public:
    // `localNode` is the node whose names are plain here; empty for none.
    Names(std::string aircraft, std::string localNode)
        : _aircraft(std::move(aircraft)), _localNode(std::move(localNode))
    {
    }

    const std::string &Aircraft() const { return _aircraft; }
    // The number at the end of the last three characters of an aircraft's name; 0 if there is none.
    static int NumberOf(const std::string &aircraft)
    {
        const std::string end = aircraft.size() > 3 ? aircraft.substr(aircraft.size() - 3) : aircraft;
        const std::size_t last = end.find_last_not_of("0123456789");
        return std::atoi(end.substr(last == std::string::npos ? 0 : last + 1).c_str());
    }
    static std::string VisionOf(const std::string &aircraft) { return aircraft + ".vision"; }

    // The name here of a message, queue or manager of any node.
    std::string Of(const std::string &node, const std::string &name) const
    {
        return node == _localNode ? name : node + "/" + name;
    }
    // Of this aircraft's own two nodes.
    std::string Own(const std::string &name) const { return Of(_aircraft, name); }
    std::string OwnVision(const std::string &name) const { return Of(VisionOf(_aircraft), name); }

private:
    std::string _aircraft;
    std::string _localNode;
};

}  // namespace Swarm
