#include "mirrors/Subscriptions.h"

#include <rabit/gateway/NamePattern.h>
#include <rabit/gateway/QosProfileWords.h>
#include <rabit/idl/MessageTypeRegistry.h>

#include <algorithm>
#include <numeric>
#include <utility>

#include "names/TypeDefinition.h"
#include "wire/Announcements.h"
#include "wire/Offers.h"

namespace Rabit
{
namespace
{

std::uint64_t HashOfType(const SubscribeRule &rule)
{
    return DefinitionHash(*MessageTypeRegistry::Find(rule.Type));
}

}  // namespace

Subscriptions::Subscriptions(const std::vector<SubscribeRule> &rules, const OriginTable &origins,
                             RabitWorkspace &workspace, RabitHandlerThread *handlers,
                             std::shared_ptr<GatewayTap> tap)
    : _rules(rules.begin(), rules.end()),
      _origins(origins),
      _workspace(workspace),
      _handlers(handlers),
      _tap(std::move(tap))
{
}

void Subscriptions::Open(TransportSession &session)
{
    _sessions.push_back(&session);
    for (std::size_t i = 0; i < _rules.size(); ++i)
    {
        if (i == _subscriptions.size())
        {
            _subscriptions.push_back({&_rules[i], Make(_rules[i]), HashOfType(_rules[i])});
        }
        _subscriptions[i].Subscriber->Open(session);
    }
}

std::unique_ptr<TopicSubscriber> Subscriptions::Make(const SubscribeRule &rule) const
{
    auto subscriber = std::make_unique<TopicSubscriber>(rule, *MessageTypeRegistry::Find(rule.Type), _origins,
                                                        _workspace, _handlers, _tap);
    if (_expected > 1)
    {
        subscriber->ExpectSeveral();
    }
    return subscriber;
}

std::unique_ptr<TopicSubscriber> Subscriptions::MakeOpen(const SubscribeRule &rule) const
{
    auto subscriber = Make(rule);
    for (TransportSession *session : _sessions)
    {
        subscriber->Open(*session);
    }
    return subscriber;
}

bool Subscriptions::Add(const SubscribeRule &rule)
{
    const auto known =
        std::find_if(_rules.begin(), _rules.end(),
                     [&rule](const SubscribeRule &other) { return other.Message == rule.Message; });
    if (known != _rules.end())
    {
        return Widen(static_cast<std::size_t>(known - _rules.begin()), rule);
    }
    _rules.push_back(rule);
    try
    {
        _subscriptions.push_back({&_rules.back(), MakeOpen(_rules.back()), HashOfType(rule)});
    }
    catch (...)
    {
        _rules.pop_back();
        throw;
    }
    _known.clear();
    return true;
}

bool Subscriptions::Widen(std::size_t place, const SubscribeRule &rule)
{
    SubscribeRule wider = _rules[place];
    for (const std::string &pattern : rule.From)
    {
        if (std::none_of(wider.From.begin(), wider.From.end(),
                         [&pattern](const std::string &other) { return CoversPattern(other, pattern); }))
        {
            wider.From.push_back(pattern);
        }
    }
    if (wider.Type != rule.Type || wider.From.size() == _rules[place].From.size())
    {
        return false;
    }
    // A reader has its nodes from the beginning, so another one takes its place. States come anew.
    _subscriptions[place].Subscriber = MakeOpen(wider);
    _rules[place] = std::move(wider);
    _known.clear();
    return true;
}

void Subscriptions::Close()
{
    _subscriptions.clear();
    _sessions.clear();
    _known.clear();
}

Subscriptions::Offer Subscriptions::OfferFor(const Subscription &subscription, const PeerTable::Peer &peer)
{
    const SubscribeRule &rule = *subscription.Rule;
    if (!peer.HasPresentOffers() || !MatchesAny(rule.From, peer.Node))
    {
        return {};
    }
    const Gateway::PublishedMessage *offer = Offers::Find(*peer.Offers, rule.Message);
    if (offer == nullptr || offer->type != rule.Type)
    {
        return {};
    }
    if (offer->definition != subscription.Definition)
    {
        return {std::nullopt, true};
    }
    return {ProfileOf(offer->qos).value_or(QosProfile::State), false};
}

std::vector<const PeerTable::Peer *> Subscriptions::OnOffers(const PeersOverPaths &peers)
{
    std::vector<const PeerTable::Peer *> changed;
    for (const PeerTable::Peer *peer : peers.Heard())
    {
        const Known now{peer->Incarnation, peer->Offers ? std::optional(peer->OffersDigest) : std::nullopt};
        Known &known = _known[peer->Node];
        if (known == now)
        {
            continue;
        }
        known = now;
        changed.push_back(peer);
        for (const Subscription &subscription : _subscriptions)
        {
            const Offer offer = OfferFor(subscription, *peer);
            subscription.Subscriber->SetOffer(peer->Node, offer.Profile, offer.IsOtherVersion);
        }
    }
    return changed;
}

std::vector<StateRepair::Wanted> Subscriptions::StatesWanted(const PeerTable::Peer &peer) const
{
    std::vector<StateRepair::Wanted> wanted;
    for (std::size_t i = 0; i < _subscriptions.size(); ++i)
    {
        if (OfferFor(_subscriptions[i], peer).Profile == QosProfile::State)
        {
            wanted.push_back(
                {.State = *Announcements::StateIndexOf(*peer.Offers, _rules[i].Message), .Subscription = i});
        }
    }
    return wanted;
}

std::optional<std::int64_t> Subscriptions::TakenIn(std::size_t rule, const std::string &node,
                                                   std::uint64_t incarnation) const
{
    return rule < _subscriptions.size() ? _subscriptions[rule].Subscriber->TakenIn(node, incarnation)
                                        : std::nullopt;
}

void Subscriptions::Forget(const std::string &node)
{
    _known.erase(node);
    for (const Subscription &subscription : _subscriptions)
    {
        subscription.Subscriber->Forget(node);
    }
}

std::uint64_t Subscriptions::CrowdedOut() const
{
    return std::accumulate(_subscriptions.begin(), _subscriptions.end(), std::uint64_t{0},
                           [](std::uint64_t sum, const Subscription &subscription)
                           { return sum + subscription.Subscriber->CrowdedOut(); });
}

void Subscriptions::Report(Gateway::Fleet &fleet) const
{
    for (const Subscription &subscription : _subscriptions)
    {
        const auto status = subscription.Subscriber->Status();
        fleet.topics.insert(fleet.topics.end(), status.begin(), status.end());
    }
}

Reception Subscriptions::ReceptionFrom(const std::string &node, const SubscribeRule &rule) const
{
    Reception reception;
    for (const Subscription &subscription : _subscriptions)
    {
        if (subscription.Rule == &rule)
        {
            reception.PostedOf = subscription.Subscriber->PostedOf(node);
            reception.MatchedWriters = subscription.Subscriber->MatchedWriters();
            reception.LocalProblem = subscription.Subscriber->LocalProblem(node);
        }
    }
    return reception;
}

}  // namespace Rabit
