// TopicDescription and TopicQos in the vendor's terms.
#pragma once

#include <rabit/transport/Transport.h>

#include "Vendor.h"

namespace Rabit::FastDds
{

TopicNames NamesOf(const TopicDescription &topic);

rtps::WriterAttributes MakeWriterAttributes(const TopicDescription &topic, const TopicQos &qos);
dds::WriterQos MakeWriterQos(const TopicDescription &topic, const TopicQos &qos,
                             const std::vector<std::string> &partitions);

rtps::ReaderAttributes MakeReaderAttributes(const TopicDescription &topic, const TopicQos &qos);
dds::ReaderQos MakeReaderQos(const TopicDescription &topic, const TopicQos &qos,
                             const std::vector<std::string> &partitions);

WriterId ToWriterId(const rtps::GUID_t &guid);

}  // namespace Rabit::FastDds
