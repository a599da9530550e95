#pragma once

#include <rabit/gateway/GatewayConfig.h>

#include <string>
#include <vector>

#include "FleetCheck.h"

namespace Rabit::Tool
{

// Checks the wishes of one node of a fleet against the other nodes: messages, queues, and permitted senders.
// By the rules of the gateway a name or a pattern means each node that matches, and `*` any node that has the
// message.
class WantCheck
{
public:
    // All arguments must outlive the object. The node itself is in `fleet`.
    WantCheck(const GatewayConfig &config, const std::vector<GatewayConfig> &fleet,
              std::vector<FleetCheck::Finding> &findings);

    void Run();

private:
    using Nodes = std::vector<const GatewayConfig *>;
    // The program that a name may be of. A tool sends to queues, and has no file among those of the fleet.
    enum class MayBe
    {
        NodeAlone,
        Tool
    };

    void CheckSubscription(const SubscribeRule &rule);
    void CheckPublication(const PublishRule &rule);
    void CheckSending(const SendRule &rule);
    void CheckAcceptance(const AcceptRule &rule);

    void Fail(int line, const std::string &text);
    // Returns the other nodes in the domain that match; reports patterns without a match.
    Nodes Meant(const std::vector<std::string> &patterns, const std::string &what, int line,
                MayBe mayBe = MayBe::NodeAlone);
    void TellNobody(const std::string &pattern, const std::string &what, int line, MayBe mayBe);

    const GatewayConfig &_config;
    const std::vector<GatewayConfig> &_fleet;
    std::vector<FleetCheck::Finding> &_findings;
    Nodes _others;  // in its domain
};

}  // namespace Rabit::Tool
