#pragma once

#include <rabit/transport/Transport.h>

#include <string>
#include <vector>

#include "Entity.h"
#include "SessionCore.h"

namespace Rabit::Cyclone
{

// Larger samples are neither sent nor accepted.
constexpr std::size_t MaxSample = LargestSample;

Qos MakeWriterQos(const TopicDescription &topic, const TopicQos &qos,
                  const std::vector<std::string> &partitions);
Qos MakeReaderQos(const TopicDescription &topic, const TopicQos &qos,
                  const std::vector<std::string> &partitions);

// Makes a topic of opaque samples, for one writer or reader. `type` is set to the vendor's type, which lives
// as long as the topic. Throws TransportError.
Entity MakeTopic(const SessionCore &core, const TopicDescription &topic, const ddsi_sertype *&type);

}  // namespace Rabit::Cyclone
