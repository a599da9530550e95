#pragma once

#include <rabit/RabitWorkspace.h>
#include <rabit/gateway/GatewayConfig.h>
#include <rabit/transport/Transport.h>

#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "gateway.idl.h"
#include "mirrors/Reception.h"
#include "mirrors/TopicSubscriber.h"
#include "presence/OriginTable.h"
#include "presence/PeerTable.h"

namespace Rabit
{

// All messages that this node wants of others. A rule that names no QoS profile takes what the publishers
// announce: its reader is opened when the first announcement that fits arrives. Gateway's thread only.
class Subscriptions
{
public:
    // The rules, origins and workspace must outlive the object.
    Subscriptions(const std::vector<SubscribeRule> &rules, const OriginTable &origins,
                  RabitWorkspace &workspace);

    // Opens what needs no announcement. Throws TransportError.
    void Open(TransportSession &session);
    void Close();
    // Opens what has become known to be needed.
    void OnOffers(const PeerTable &peers);

    void Forget(const std::string &node);
    // Samples dropped because they came from a node beyond those that are kept.
    std::uint64_t CrowdedOut() const;
    void Report(Gateway::Fleet &fleet) const;
    const std::vector<SubscribeRule> &Rules() const { return _rules; }
    // The rule must be one of Rules().
    Reception ReceptionFrom(const std::string &node, const SubscribeRule &rule) const;

private:
    using Key = std::pair<const SubscribeRule *, QosProfile>;

    void OpenOne(const SubscribeRule &rule, QosProfile profile);

    const std::vector<SubscribeRule> &_rules;
    const OriginTable &_origins;
    RabitWorkspace &_workspace;
    TransportSession *_session = nullptr;
    std::map<Key, std::unique_ptr<TopicSubscriber>> _subscribers;
};

}  // namespace Rabit
