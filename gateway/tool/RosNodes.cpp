#include "RosNodes.h"

#include <rabit/PublishSubscribeMessage.h>
#include <rabit/RabitEvent.h>
#include <rabit/idl/MessageTypeRegistry.h>

#include "RosParticipant.h"

namespace Rabit::Tool
{
namespace
{

constexpr std::size_t PrefixDigits = 24;

}  // namespace

void RosNodes::AddTo(GatewayConfig &config)
{
    if (SomePathHasKeys(config))
    {
        return;
    }
    MessageTypeRegistry::Add(RosParticipant::IdlType());
    ForeignRule rule;
    rule.Topic = Topic;
    rule.Type = RosParticipant::TypeName;
    rule.Local = Topic;
    // As rmw writes it. A participant announced itself before this program came.
    rule.Reliability = Reliability::Reliable;
    rule.Durability = Durability::TransientLocal;
    config.Foreign.push_back(rule);
}

void RosNodes::Attach(RabitWorkspace &workspace)
{
    const auto message = std::make_shared<RosParticipant>();
    if (!workspace.AddPublishSubscribeMessage(Topic, message))
    {
        return;
    }
    const auto global = message->GetGlobalPublishSubscribeMessageRef();
    // One post comes after the other. A quick handler runs within each post, so it sees every value.
    global->ConnectSomethingPublished(RabitQuickHandler(
        [known = _known, weak = std::weak_ptr(global), fetched = std::make_shared<RosParticipant>()]
        {
            const auto posted = weak.lock();
            if (!posted || !posted->FetchMessage(fetched.get()))
            {
                return;
            }
            const std::lock_guard lock(known->Mutex);
            if (known->ByPrefix.size() < MostParticipants || known->ByPrefix.contains(fetched->Prefix))
            {
                known->ByPrefix[fetched->Prefix] = fetched->Nodes;
            }
        }));
}

RosNodes::Names RosNodes::Of(const Gateway::Fleet &fleet) const
{
    Names names;
    const std::lock_guard lock(_known->Mutex);
    for (const Gateway::ForeignTopic &topic : fleet.foreign)
    {
        if (topic.topic != Topic)
        {
            continue;
        }
        for (const Gateway::ForeignWriter &writer : topic.writers)
        {
            const std::string prefix = writer.id.substr(0, PrefixDigits);
            const auto found = _known->ByPrefix.find(prefix);
            names[prefix] = found == _known->ByPrefix.end() ? std::vector<std::string>() : found->second;
        }
    }
    return names;
}

}  // namespace Rabit::Tool
