#pragma once

#include <rabit/gateway/ForeignRule.h>

#include <string>

#include "names/RosNames.h"

namespace Rabit
{

// Return the names that a rule's topic and type have on the wire.
inline std::string WireTopicOf(const ForeignRule &rule)
{
    return rule.Names == ForeignRule::WireNames::Ros2 ? RosTopicName(rule.Topic) : rule.Topic;
}
inline std::string WireTypeOf(const ForeignRule &rule)
{
    return rule.Names == ForeignRule::WireNames::Ros2 ? RosTypeName(rule.Type) : rule.Type;
}

}  // namespace Rabit
