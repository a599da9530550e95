#pragma once

#include <rabit/RabitHandlerThread.h>
#include <rabit/RabitWorkspace.h>
#include <rabit/gateway/GatewayConfig.h>
#include <rabit/transport/Transport.h>

#include <cstddef>
#include <cstdint>
#include <deque>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "gateway.idl.h"
#include "mirrors/Reception.h"
#include "mirrors/StateRepair.h"
#include "mirrors/TopicSubscriber.h"
#include "paths/PeersOverPaths.h"
#include "presence/OriginTable.h"
#include "presence/PeerTable.h"

namespace Rabit
{

// All subscriptions of this node: one reader for each rule. Gateway's thread only.
class Subscriptions
{
public:
    // Origins, workspace and handlers must outlive the object. Null handlers, and the tap: see
    // TopicSubscriber.
    Subscriptions(const std::vector<SubscribeRule> &rules, const OriginTable &origins,
                  RabitWorkspace &workspace, RabitHandlerThread *handlers = nullptr,
                  std::shared_ptr<GatewayTap> tap = nullptr);

    // The number of sessions for which Open will be called. Before the first.
    void SetSessions(std::size_t sessions) { _expected = sessions; }
    // Reads from that session as well, and keeps it until Close. Throws TransportError.
    void Open(TransportSession &session);
    void Close();
    // Adds a rule while open. A message that is subscribed to already is then read from the nodes of both
    // rules. False if that changes nothing, or the types differ. Throws TransportError. OnOffers then returns
    // all nodes once more.
    bool Add(const SubscribeRule &rule);
    // Processes new announcements and incarnations. Returns the nodes that have one.
    std::vector<const PeerTable::Peer *> OnOffers(const PeersOverPaths &peers);
    // The States of that node that are wanted, and by which of Rules().
    std::vector<StateRepair::Wanted> StatesWanted(const PeerTable::Peer &peer) const;
    // As TopicSubscriber::TakenIn, of the reader of one of Rules().
    std::optional<std::int64_t> TakenIn(std::size_t rule, const std::string &node,
                                        std::uint64_t incarnation) const;

    void Forget(const std::string &node);
    // Samples dropped because they came from a node beyond those that are kept.
    std::uint64_t CrowdedOut() const;
    void Report(Gateway::Fleet &fleet) const;
    const std::deque<SubscribeRule> &Rules() const { return _rules; }
    // The rule must be one of Rules().
    Reception ReceptionFrom(const std::string &node, const SubscribeRule &rule) const;

private:
    struct Subscription
    {
        const SubscribeRule *Rule = nullptr;
        std::unique_ptr<TopicSubscriber> Subscriber;
        std::uint64_t Definition = 0;  // hash of the type's IDL here
    };

    // How a node announces the message and type of a subscription.
    struct Offer
    {
        std::optional<QosProfile> Profile;  // empty: it does not, or with another definition of the type
        bool IsOtherVersion = false;
    };

    // The announcement of a node that was processed last.
    struct Known
    {
        std::uint64_t Incarnation = 0;
        std::optional<std::uint32_t> Digest;  // empty: none

        bool operator==(const Known &) const = default;
    };

    std::unique_ptr<TopicSubscriber> Make(const SubscribeRule &rule) const;
    std::unique_ptr<TopicSubscriber> MakeOpen(const SubscribeRule &rule) const;
    // Has the reader of that rule read from the nodes of the other rule, too. False if that changes nothing.
    bool Widen(std::size_t place, const SubscribeRule &rule);
    static Offer OfferFor(const Subscription &subscription, const PeerTable::Peer &peer);

    std::deque<SubscribeRule> _rules;  // they stay where they are
    const OriginTable &_origins;
    RabitWorkspace &_workspace;
    RabitHandlerThread *const _handlers;
    const std::shared_ptr<GatewayTap> _tap;
    std::vector<Subscription> _subscriptions;  // of each rule, in their order, while open
    std::size_t _expected = 1;
    std::vector<TransportSession *> _sessions;
    std::map<std::string, Known> _known;
};

}  // namespace Rabit
