#include "mirrors/Subscriptions.h"

#include <rabit/RabitLog.h>
#include <rabit/idl/MessageTypeRegistry.h>

#include <algorithm>

#include "names/NamePattern.h"
#include "wire/GatewayTopics.h"

namespace Rabit
{

Subscriptions::Subscriptions(const std::vector<SubscribeRule> &rules, const OriginTable &origins,
                             RabitWorkspace &workspace)
    : _rules(rules), _origins(origins), _workspace(workspace)
{
}

void Subscriptions::Open(TransportSession &session)
{
    _session = &session;
    for (const SubscribeRule &rule : _rules)
    {
        if (rule.Qos)
        {
            OpenOne(rule, *rule.Qos);
        }
    }
}

void Subscriptions::Close()
{
    _subscribers.clear();
    _session = nullptr;
}

void Subscriptions::OpenOne(const SubscribeRule &rule, QosProfile profile)
{
    std::unique_ptr<TopicSubscriber> &subscriber = _subscribers[{&rule, profile}];
    if (!subscriber)
    {
        auto made = std::make_unique<TopicSubscriber>(rule, profile, *MessageTypeRegistry::Find(rule.Type),
                                                      _origins, _workspace);
        made->Open(*_session);
        subscriber = std::move(made);
    }
}

void Subscriptions::OnOffers(const PeerTable &peers)
{
    if (_session == nullptr)
    {
        return;
    }
    for (const SubscribeRule &rule : _rules)
    {
        for (const PeerTable::Peer *peer : peers.Heard())
        {
            if (rule.Qos || !peer->Offers || !MatchesAny(rule.From, peer->Node))
            {
                continue;
            }
            for (const Gateway::PublishedMessage &offer : peer->Offers->publishes)
            {
                if (offer.message == rule.Message && offer.type == rule.Type)
                {
                    OpenOne(rule, offer.qos == GatewayTopics::NameOf(QosProfile::Telemetry)
                                      ? QosProfile::Telemetry
                                      : QosProfile::State);
                }
            }
        }
    }
}

void Subscriptions::Forget(const std::string &node)
{
    for (const auto &[key, subscriber] : _subscribers)
    {
        if (subscriber)
        {
            subscriber->Forget(node);
        }
    }
}

std::uint64_t Subscriptions::CrowdedOut() const
{
    std::uint64_t sum = 0;
    for (const auto &[key, subscriber] : _subscribers)
    {
        sum += subscriber ? subscriber->CrowdedOut() : 0;
    }
    return sum;
}

void Subscriptions::Report(Gateway::Fleet &fleet) const
{
    for (const auto &[key, subscriber] : _subscribers)
    {
        if (subscriber)
        {
            const auto status = subscriber->Status();
            fleet.topics.insert(fleet.topics.end(), status.begin(), status.end());
        }
    }
}

Reception Subscriptions::ReceptionFrom(const std::string &node, const SubscribeRule &rule) const
{
    Reception reception;
    for (const auto &[key, subscriber] : _subscribers)
    {
        if (key.first == &rule && subscriber)
        {
            reception.Received += subscriber->ReceivedFrom(node);
            reception.MatchedWriters += subscriber->MatchedWriters();
            reception.LocalProblem += subscriber->LocalProblem(node);
        }
    }
    return reception;
}

}  // namespace Rabit
