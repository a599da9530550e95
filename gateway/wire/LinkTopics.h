#pragma once

#include <rabit/transport/Transport.h>

namespace Rabit
{

// The topic of the queue links with its type, and its DDS settings.
TopicDescription DescribeLinkTopic();
TopicQos LinkTopicQos();

}  // namespace Rabit
