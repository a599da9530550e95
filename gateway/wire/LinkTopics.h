#pragma once

#include <rabit/gateway/GatewayConfig.h>
#include <rabit/transport/Transport.h>

#include <cstddef>

namespace Rabit
{

// The topic of the queue links with its type, and its DDS settings.
TopicDescription DescribeLinkTopic();
TopicQos LinkTopicQos();

// Bytes of a sample beside its frame: encapsulation and length.
inline constexpr std::size_t LinkSampleOverhead = 8;
// Bytes of a frame that goes in one datagram of so many bytes over every backend. Less than the headers leave
// room for: the vendors cut a sample in two sooner, Fast DDS one that is less than 176 bytes smaller than the
// largest datagram, Cyclone DDS 100.
// With keys, the seal takes some of it (transport/envelope/README.md).
std::size_t LargestLinkFrame(std::size_t maxDatagram, bool secured = false);
// The same over all paths of a gateway, each with or without keys: one frame may go by any of them.
std::size_t LargestLinkFrameOf(const GatewayConfig &config);

}  // namespace Rabit
