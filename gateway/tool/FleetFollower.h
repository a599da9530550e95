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

// Subscribes to all messages of the fleet that match patterns, as nodes announce them, and requests their
// types from the nodes. Main thread only.
class FleetFollower
{
public:
    // `what`: `uav1/Pose`, `*/Pose`, `uav1/*`; `except`, likewise, is left out. Adds each subscription to
    // config.Subscribe. Adds `node/message` to `except` if the type cannot be read, or another definition of
    // it is in use. All arguments must outlive the object.
    FleetFollower(FleetSession &session, const std::vector<std::string> &what, GatewayConfig &config,
                  std::vector<std::string> &except);

    // Returns the nodes (or patterns) whose announcements are needed for `what`.
    static std::vector<std::string> NodesOf(const std::vector<std::string> &what);

    // Looks at new announcements; waits at most two seconds for each missing type. Returns the messages that
    // it has begun to follow, as `uav1/Pose`.
    std::vector<std::string> FollowNew();
    // Once the announcements have come that can: reports each wanted message that nobody publishes.
    void TellOfMissing();
    // Number of messages subscribed to.
    std::size_t Messages() const { return _followed.size(); }

private:
    struct Pattern
    {
        std::string Node;
        std::string Message;
        bool IsChecked = false;  // by TellOfMissing
    };
    struct Followed
    {
        std::string Type;
        std::uint64_t Definition = 0;
    };

    bool IsWanted(const std::string &node, const std::string &message) const;
    // Returns the node patterns for which that message is wanted.
    std::vector<std::string> From(const std::string &message) const;
    bool Follow(const std::string &node, const Gateway::PublishedMessage &published);
    void LeaveOut(const std::string &node, const std::string &message, const std::string &reason);

    FleetSession &_session;
    GatewayConfig &_config;
    std::vector<std::string> &_except;
    std::vector<Pattern> _patterns;
    std::map<std::string, Followed> _followed;  // by message
    std::set<std::string> _seen;                // node/message
    std::map<std::string, double> _notBefore;  // node/message whose type did not come: seconds of the session
};

}  // namespace Rabit::Tool
