#include "wire/LinkTopics.h"

#include <algorithm>

#include "gateway.idl.h"
#include "wire/GatewayTopics.h"

namespace Rabit
{

TopicDescription DescribeLinkTopic()
{
    return GatewayTopics::Describe(GatewayTopics::Link, GatewayTopics::TypeOf<Gateway::LinkSample>());
}

// The links retransmit lost parts, one at a time and at the pace of the path. Ordered retransmission by DDS
// would hold up later parts, and its heartbeats and acknowledgements would be a multiple of the data on a
// thin radio.
TopicQos LinkTopicQos()
{
    TopicQos qos;
    qos.Reliability = Reliability::BestEffort;
    qos.Durability = Durability::Volatile;
    qos.Depth = 64;
    return qos;
}

std::size_t LargestLinkFrame(std::size_t maxDatagram, bool secured)
{
    constexpr std::size_t vendors = 176;
    constexpr std::size_t seal = 99;  // by which backends make their datagrams smaller (envelope/Sealer.h)
    return std::max(maxDatagram, TransportSettings::SmallestDatagram) - vendors - (secured ? seal : 0) -
           LinkSampleOverhead;
}

std::size_t LargestLinkFrameOf(const GatewayConfig &config)
{
    return LargestLinkFrame(config.MaxDatagram, SomePathHasKeys(config));
}

}  // namespace Rabit
