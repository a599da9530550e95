#pragma once

#include <rabit/gateway/GatewayConfig.h>

#include <string_view>
#include <vector>

#include "queues/SendOptions.h"
#include "wire/GatewayTopics.h"

namespace Rabit
{

// The priority of a message or queue in the configuration.
struct Importance
{
    TrafficClass Class = TrafficClass::Command;
    double Weight = 1.0;
};

inline TrafficClass ImportanceOf(const PublishRule &rule)
{
    return rule.Class.value_or(GatewayTopics::ClassOf(rule.Qos));
}

inline Importance ImportanceOf(const std::vector<SendRule> &rules, std::string_view node,
                               std::string_view queue)
{
    const SendRule *rule = FindSendRule(rules, node, queue);
    return rule == nullptr ? Importance{} : Importance{rule->Class, rule->Weight};
}

}  // namespace Rabit
