#pragma once

#include <rabit/gateway/GatewayConfig.h>

#include <cstdint>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "FleetSession.h"

namespace Rabit::Tool
{

// Subscribes to all messages of the fleet that fit patterns, as nodes announce them; the types are had from
// the nodes. Main thread only.
class FleetFollower
{
public:
    // `what`: `uav1/Pose`, `*/Pose`, `uav1/*`; `except`, likewise, is left out. What is subscribed to is noted
    // in config.Subscribe; of nodes that were built with another definition of a type nothing is taken, and so
    // they are added to `except`. All must outlive it.
    FleetFollower(FleetSession &session, const std::vector<std::string> &what, GatewayConfig &config,
                  std::vector<std::string> &except);

    // Whose announcements are needed for that.
    static std::vector<std::string> NodesOf(const std::vector<std::string> &what);

    // Looks at what has been announced meanwhile; waits for a type that is lacking, for two seconds at most.
    void FollowNew();
    // How many messages are subscribed to.
    std::size_t Messages() const { return _followed.size(); }

private:
    struct Pattern
    {
        std::string Node;
        std::string Message;
    };
    struct Followed
    {
        std::string Type;
        std::uint64_t Definition = 0;
    };

    bool IsWanted(const std::string &node, const std::string &message) const;
    // The patterns of nodes of which that message is wanted.
    std::vector<std::string> From(const std::string &message) const;
    bool Follow(const std::string &node, const Gateway::PublishedMessage &published);
    void LeaveOut(const std::string &node, const std::string &message, const std::string &reason);

    FleetSession &_session;
    GatewayConfig &_config;
    std::vector<std::string> &_except;
    std::vector<Pattern> _patterns;
    std::map<std::string, Followed> _followed;  // by message
    std::set<std::string> _seen;                // node/message
    std::map<std::string, double> _notBefore;   // node/message of which no type came: seconds of the session
};

}  // namespace Rabit::Tool
