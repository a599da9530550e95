#pragma once

#include <rabit/RabitWorkspace.h>
#include <rabit/gateway/Fleet.h>
#include <rabit/gateway/GatewayConfig.h>

#include <cstddef>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

namespace Rabit::Tool
{

// The names of ROS 2 nodes, which each participant of ROS 2 announces on one topic. Any thread.
class RosNodes
{
public:
    static constexpr const char *Topic = "ros_discovery_info";
    // The subject of a problem of this topic. Programs of ROS 2 need not be there, so it is no problem of a
    // tool.
    static constexpr const char *Problem = "foreign ros_discovery_info";
    // Participants of which names are kept. Those of further ones are ignored.
    static constexpr std::size_t MostParticipants = 256;

    // Names of nodes by the GUID prefix of their participant, as 24 hexadecimal digits.
    using Names = std::map<std::string, std::vector<std::string>>;

    // Has the tool read the topic, unless it has keys: then it hears no program of ROS 2.
    static void AddTo(GatewayConfig &config);
    // Takes what is announced from now on. To be called before the network is joined.
    void Attach(RabitWorkspace &workspace);
    // The participants of ROS 2 that are there, by the writers of the topic in `fleet`, whose number is
    // bounded by discovery. Without names: none have come, or the participant has no nodes.
    Names Of(const Gateway::Fleet &fleet) const;

private:
    struct Known
    {
        std::mutex Mutex;
        Names ByPrefix;  // guarded
    };
    const std::shared_ptr<Known> _known = std::make_shared<Known>();
};

}  // namespace Rabit::Tool
