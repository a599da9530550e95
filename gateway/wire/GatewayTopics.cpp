#include "wire/GatewayTopics.h"

#include <rabit/idl/MessageTypeRegistry.h>

#include <stdexcept>
#include <typeinfo>

namespace Rabit::GatewayTopics
{

const MessageType &TypeOf(const RabitMessage &message)
{
    const MessageType *type = MessageTypeRegistry::Of(message);
    if (type == nullptr)
    {
        throw std::logic_error(std::string("not an IDL message: ") + typeid(message).name());
    }
    return *type;
}

TopicDescription Describe(const std::string &topic, const MessageType &type)
{
    TopicDescription description;
    description.Name = topic;
    description.TypeName = type.Name();
    if (type.HasKey())
    {
        description.KeyOf = [&type](SampleBytes bytes, KeyHash &key) { return type.KeyHashOf(bytes, key); };
    }
    return description;
}

TopicQos QosOf(QosProfile profile)
{
    TopicQos qos;
    qos.Depth = 1;
    qos.Reliability = profile == QosProfile::State ? Reliability::Reliable : Reliability::BestEffort;
    qos.Durability = profile == QosProfile::State ? Durability::TransientLocal : Durability::Volatile;
    return qos;
}

TrafficClass ClassOf(QosProfile profile)
{
    return profile == QosProfile::State ? TrafficClass::State : TrafficClass::Telemetry;
}

}  // namespace Rabit::GatewayTopics
