#pragma once

#include <rabit/gateway/GatewayConfig.h>
#include <rabit/transport/FleetMember.h>
#include <rabit/transport/Transport.h>

#include <ctime>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "gateway.idl.h"
#include "keys/Access.h"

namespace Rabit
{

// The topics and partitions that a gateway with this configuration writes and reads, no more and no less.
Keys::Access AccessOf(const GatewayConfig &config);

// The memberships of one node: one for each folder of keys of the new format (keys/README.md), which all
// paths of the node share. Not thread-safe.
class NodeMembers
{
public:
    // Returns the member with the keys in the configuration's folder. Newer bulletins go to that folder, or,
    // if it cannot be written, to `<node>.bulletin` in the configuration's `state_dir`. Throws KeysError.
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
};

// Checks that the keys are valid now for this node over that transport, and puts GatewayConfig::Security into
// the settings: as Member, which `members` keeps, if the folder has the new format, else as Security. Throws
// TransportError, of the setting `security`, with what to do. Returns when keys of the former format end;
// nothing without security, and with the new format.
std::optional<std::time_t> AddSecurity(const GatewayConfig &config, const std::string &transport,
                                       TransportSettings &settings, NodeMembers &members);

// The problem that keys of the former format end within 30 days, or have ended.
std::optional<Gateway::Problem> KeysProblem(std::optional<std::time_t> endsAt, std::time_t now);

}  // namespace Rabit
