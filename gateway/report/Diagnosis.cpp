#include "report/Diagnosis.h"

#include <rabit/base/ListedNames.h>
#include <rabit/gateway/Fleet.h>
#include <rabit/gateway/NamePattern.h>
#include <rabit/gateway/QosProfileWords.h>
#include <rabit/idl/MessageTypeRegistry.h>

#include <algorithm>

#include "mirrors/Subscriptions.h"
#include "names/TypeDefinition.h"
#include "wire/Offers.h"

namespace Rabit::Diagnosis
{
namespace
{

// Returns the node's announcement of that message; null if there is none.
const Gateway::PublishedMessage *OfferOf(const std::string &message, const PeerTable::Peer &peer)
{
    return peer.Offers ? Offers::Find(*peer.Offers, message) : nullptr;
}

// True if the rule has that name itself, not by a pattern.
bool Names(const SubscribeRule &rule, const std::string &name)
{
    return std::find(rule.From.begin(), rule.From.end(), name) != rule.From.end();
}

// True if nodes may lack the message. `*` in `from` means every node that has it: once one node announces
// it, the others need not.
bool MayLack(const SubscribeRule &rule, const PeersOverPaths &peers)
{
    if (!Names(rule, "*"))
    {
        return false;
    }
    const auto heard = peers.Heard();
    return std::any_of(heard.begin(), heard.end(),
                       [&rule](const PeerTable::Peer *peer)
                       { return OfferOf(rule.Message, *peer) != nullptr; });
}

// True if the node publishes the message with another definition of its type. Waiting does not change that.
bool IsOtherVersion(const Wanted &wanted, const PeerTable::Peer &peer)
{
    const Gateway::PublishedMessage *found = OfferOf(wanted.Rule->Message, peer);
    return found != nullptr && found->type == wanted.Rule->Type && found->definition != wanted.Definition;
}

std::string WhyNoMatch(const SubscribeRule &rule, std::uint64_t definition, const PeerTable::Peer &peer)
{
    const Gateway::PublishedMessage *found = OfferOf(rule.Message, peer);
    if (found == nullptr)
    {
        const auto &offered = peer.Offers->publishes;
        return peer.Node + " does not publish `" + rule.Message + "`; it publishes " +
               (offered.empty()
                    ? std::string("nothing")
                    : ListedNames(offered, [](const auto &published) { return published.message; }));
    }
    if (found->type != rule.Type)
    {
        return peer.Node + " publishes `" + rule.Message + "` as `" + found->type + "`, this node wants `" +
               rule.Type + "`";
    }
    if (found->definition != definition)
    {
        return peer.Node + " was built with another definition of `" + rule.Type + "`";
    }
    if (rule.Qos == QosProfile::State && ProfileOf(found->qos) == QosProfile::Telemetry)
    {
        return peer.Node + " publishes `" + rule.Message + "` with qos " + found->qos +
               ", this node wants qos state";
    }
    return "";
}

std::string WhyNoData(const Wanted &wanted, const PeerTable::Peer &peer, std::chrono::nanoseconds now)
{
    if (!peer.Offers)
    {
        return now - peer.FirstHeard < Patience ? "" : "no announcement of " + peer.Node + " has arrived yet";
    }
    const std::string mismatch = WhyNoMatch(*wanted.Rule, wanted.Definition, peer);
    if (!mismatch.empty())
    {
        return mismatch;
    }
    const Reception reception = wanted.ReceptionFrom(peer.Node);
    if (!reception.LocalProblem.empty())
    {
        return reception.LocalProblem;
    }
    // Samples of a former incarnation do not show that those of the present one come.
    if (reception.PostedOf == peer.Incarnation || now - peer.OffersSince < Patience ||
        now - peer.FirstHeard < Patience)
    {
        return "";
    }
    if (reception.MatchedWriters == 0)
    {
        return peer.Node + " announces `" + wanted.Rule->Message +
               "`, but its writer has not been discovered";
    }
    return "nothing has been received: " + peer.Node + " has posted no `" + wanted.Rule->Message +
           "` yet, or its samples do not get through";
}

// Returns the messages that this node has of a LOST node, or would have.
std::vector<std::string> MessagesOf(const PeerTable::Peer &peer, const std::deque<SubscribeRule> &subscribe)
{
    std::vector<std::string> messages;
    for (const SubscribeRule &rule : subscribe)
    {
        const bool isMeant = peer.Reason != PeerTable::Left && MatchesAny(rule.From, peer.Node);
        const bool lacks = Names(rule, "*") && peer.Offers && OfferOf(rule.Message, peer) == nullptr;
        if (Names(rule, peer.Node) || (isMeant && !lacks))
        {
            messages.push_back(rule.Message);
        }
    }
    return messages;
}

}  // namespace

std::vector<Gateway::Problem> OfLostNodes(const std::deque<SubscribeRule> &subscribe,
                                          const std::vector<SendRule> &send, const Gateway::Fleet &fleet,
                                          const PeersOverPaths &peers)
{
    std::vector<Gateway::Problem> problems;
    for (const PeerTable::Peer *peer : peers.Heard())
    {
        if (peer->State != Gateway::NodeState::LOST)
        {
            continue;
        }
        std::string wants;
        const std::vector<std::string> messages = MessagesOf(*peer, subscribe);
        if (!messages.empty())
        {
            wants += "; this node subscribes to its " + ListedNames(messages);
        }
        const Gateway::NodeStatus *const row = Gateway::FindNode(fleet, peer->Node);
        if (row != nullptr && row->outbox > 0)
        {
            wants += "; messages for it wait";
        }
        else if (std::any_of(send.begin(), send.end(),
                             [peer](const SendRule &rule) { return rule.To == peer->Node; }))
        {
            wants += "; this node sends to it";
        }
        if (!wants.empty())
        {
            problems.push_back({"node " + peer->Node, peer->Node, "it is LOST: " + peer->Reason + wants});
        }
    }
    return problems;
}

std::vector<Gateway::Problem> OfSubscription(const Wanted &wanted, const PeersOverPaths &peers,
                                             std::chrono::nanoseconds sinceStart,
                                             std::chrono::nanoseconds now)
{
    std::vector<Gateway::Problem> problems;
    const auto add = [&problems, &wanted](const std::string &node, const std::string &reason, bool certain) {
        problems.push_back({"subscribe " + wanted.Rule->Message, node, reason, certain});
    };
    const bool mayLack = MayLack(*wanted.Rule, peers);
    bool anyNode = false;
    for (const PeerTable::Peer *peer : peers.Heard())
    {
        if (!MatchesAny(wanted.Rule->From, peer->Node))
        {
            continue;
        }
        anyNode = true;
        if (peer->State == Gateway::NodeState::LOST)
        {
            continue;  // OfLostNodes says so
        }
        if (mayLack && peer->Offers && OfferOf(wanted.Rule->Message, *peer) == nullptr)
        {
            continue;
        }
        const std::string reason = WhyNoData(wanted, *peer, now);
        if (!reason.empty())
        {
            add(peer->Node, reason, IsOtherVersion(wanted, *peer));
        }
    }
    if (!anyNode && sinceStart >= Patience)
    {
        add("", "no node named " + ListedNames(wanted.Rule->From) + " has been heard", false);
    }
    return problems;
}

std::vector<Gateway::Problem> OfSubscriptions(const Subscriptions &subscriptions, const PeersOverPaths &peers,
                                              std::chrono::nanoseconds sinceStart,
                                              std::chrono::nanoseconds now)
{
    std::vector<Gateway::Problem> problems;
    for (const SubscribeRule &rule : subscriptions.Rules())
    {
        Wanted wanted;
        wanted.Rule = &rule;
        wanted.Definition = DefinitionHash(*MessageTypeRegistry::Find(rule.Type));
        wanted.ReceptionFrom = [&subscriptions, &rule](const std::string &node)
        { return subscriptions.ReceptionFrom(node, rule); };
        const auto found = OfSubscription(wanted, peers, sinceStart, now);
        problems.insert(problems.end(), found.begin(), found.end());
    }
    return problems;
}

}  // namespace Rabit::Diagnosis
