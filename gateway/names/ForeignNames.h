#pragma once

#include <rabit/gateway/ForeignRule.h>
#include <rabit/idl/MessageType.h>

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

// The hash of the type that this node announces for the topic; empty: none.
inline std::string WireHashOf(const ForeignRule &rule, const MessageType &type)
{
    return rule.Names == ForeignRule::WireNames::Ros2 ? type.RosTypeHash() : "";
}

}  // namespace Rabit
