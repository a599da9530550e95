#pragma once

#include <rabit/gateway/GatewayConfig.h>
#include <rabit/transport/FleetMember.h>
#include <rabit/transport/Transport.h>

#include <ctime>
#include <map>
#include <memory>
#include <set>
#include <string>
#include <vector>

#include "keys/Access.h"

namespace Rabit
{

// The topics that a gateway with this configuration writes and reads, no more and no less.
Keys::Access AccessOf(const GatewayConfig &config);

// The memberships of one node: one for each folder of keys (keys/README.md), which all paths of the node
// share, and those that the configuration has. Not thread-safe.
class NodeMembers
{
public:
    // Returns the configuration's member, or the one with the keys in the configuration's folder. Newer
    // bulletins go to that folder, or, if it cannot be written, to `<node>.bulletin` in the configuration's
    // `state_dir`. Throws KeysError.
    std::shared_ptr<FleetMember> Of(const GatewayConfig &config);
    // The problems of all members, and certificates of this node that end within 30 days.
    std::vector<SettingsProblem> Problems(std::time_t now) const;

private:
    struct Known
    {
        std::shared_ptr<FleetMember> Member;
        std::time_t EndsAt = 0;
    };
    std::map<std::string, Known> _known;  // by folder
    std::set<std::shared_ptr<FleetMember>> _given;
};

// Checks that the keys are for this node and allow what its configuration needs, and puts the member that
// they make into the settings, which `members` keeps. Without GatewayConfig::Security it does nothing. Throws
// TransportError, of the setting `security`, with what to do.
void AddSecurity(const GatewayConfig &config, TransportSettings &settings, NodeMembers &members);

}  // namespace Rabit
