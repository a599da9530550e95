#include "wire/LinkTopics.h"

#include "gateway.idl.h"
#include "wire/GatewayTopics.h"

namespace Rabit
{

TopicDescription DescribeLinkTopic(LinkTopic topic)
{
    switch (topic)
    {
        case LinkTopic::Data:
            return GatewayTopics::Describe(GatewayTopics::LinkData,
                                           GatewayTopics::TypeOf<Gateway::LinkDataSample>());
        case LinkTopic::Ack:
            return GatewayTopics::Describe(GatewayTopics::LinkAck,
                                           GatewayTopics::TypeOf<Gateway::LinkAckSample>());
        case LinkTopic::Hello:
            break;
    }
    return GatewayTopics::Describe(GatewayTopics::LinkHello,
                                   GatewayTopics::TypeOf<Gateway::LinkHelloSample>());
}

// The links do not rely on DDS's reliability, but its repair is the quicker one. A hello is soon followed by
// the next.
TopicQos LinkTopicQos(LinkTopic topic)
{
    TopicQos qos;
    qos.Reliability = topic == LinkTopic::Hello ? Reliability::BestEffort : Reliability::Reliable;
    qos.Durability = Durability::Volatile;
    qos.Depth = topic == LinkTopic::Data ? 256 : topic == LinkTopic::Ack ? 16 : 1;
    return qos;
}

}  // namespace Rabit
