#pragma once

#include <rabit/gateway/GatewayConfig.h>
#include <rabit/idl/MessageType.h>
#include <rabit/transport/Transport.h>

#include <string>

namespace Rabit::GatewayTopics
{

// The topics that gateways use among themselves. Messages cannot take these names: they contain a slash.
inline constexpr const char *Beat = "rabit/Beat";
inline constexpr const char *Link = "rabit/Link";

// The type of a message. Throws std::logic_error if it was not made from IDL.
const MessageType &TypeOf(const RabitMessage &message);
template <typename Message>
const MessageType &TypeOf()
{
    static const MessageType *const type = &TypeOf(Message());  // of the class, not of this object
    return *type;
}

// The topic of a message.
TopicDescription Describe(const std::string &topic, const MessageType &type);

// The DDS settings of a profile.
TopicQos QosOf(QosProfile profile);
// The priority of messages of that profile whose rule has no class.
TrafficClass ClassOf(QosProfile profile);

}  // namespace Rabit::GatewayTopics
