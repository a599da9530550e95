#pragma once

#include <rabit/transport/Transport.h>

namespace Rabit
{

// The topics of the queue links.
enum class LinkTopic
{
    Data,
    Ack,
    Hello
};

// The topic with its type, and its DDS settings.
TopicDescription DescribeLinkTopic(LinkTopic topic);
TopicQos LinkTopicQos(LinkTopic topic);

}  // namespace Rabit
