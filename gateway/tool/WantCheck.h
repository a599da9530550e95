#pragma once

#include <rabit/gateway/GatewayConfig.h>

#include <string>
#include <vector>

#include "FleetCheck.h"

namespace Rabit::Tool
{

// What one node of a fleet wants of the others, against what these have: messages, queues, and who may send
// to them. By the rules of the gateway: a name or a pattern means each node that fits, `*` whoever has it.
class WantCheck
{
public:
    // All must outlive it. The node itself is among the fleet.
    WantCheck(const GatewayConfig &config, const std::vector<GatewayConfig> &fleet,
              std::vector<FleetCheck::Finding> &findings);

    void Run();

private:
    using Nodes = std::vector<const GatewayConfig *>;

    void CheckSubscription(const SubscribeRule &rule);
    void CheckPublication(const PublishRule &rule);
    void CheckSending(const SendRule &rule);
    void CheckAcceptance(const AcceptRule &rule);

    void Fail(int line, const std::string &text);
    // The others in the domain that fit; tells if a pattern means nobody.
    Nodes Meant(const std::vector<std::string> &patterns, const std::string &what, int line);
    void TellNobody(const std::string &pattern, const std::string &what, int line);

    const GatewayConfig &_config;
    const std::vector<GatewayConfig> &_fleet;
    std::vector<FleetCheck::Finding> &_findings;
    Nodes _others;  // in its domain
};

}  // namespace Rabit::Tool
