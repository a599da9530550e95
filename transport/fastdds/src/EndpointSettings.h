// TopicDescription and TopicQos in the vendor's terms.
#pragma once

#include <fastdds/rtps/attributes/ReaderAttributes.h>
#include <fastdds/rtps/attributes/WriterAttributes.h>
#include <fastdds/rtps/common/Guid.h>
#include <fastrtps/attributes/TopicAttributes.h>
#include <fastrtps/qos/ReaderQos.h>
#include <fastrtps/qos/WriterQos.h>
#include <rabit/transport/Transport.h>

namespace Rabit::FastDds
{

eprosima::fastrtps::TopicAttributes MakeTopicAttributes(const TopicDescription &topic);

eprosima::fastrtps::rtps::WriterAttributes MakeWriterAttributes(const TopicDescription &topic,
                                                                const TopicQos &qos,
                                                                const std::vector<std::string> &partitions);
eprosima::fastrtps::WriterQos MakeWriterQos(const TopicQos &qos, const std::vector<std::string> &partitions);

eprosima::fastrtps::rtps::ReaderAttributes MakeReaderAttributes(const TopicDescription &topic,
                                                                const TopicQos &qos,
                                                                const std::vector<std::string> &partitions);
eprosima::fastrtps::ReaderQos MakeReaderQos(const TopicQos &qos, const std::vector<std::string> &partitions);

WriterId ToWriterId(const eprosima::fastrtps::rtps::GUID_t &guid);

}  // namespace Rabit::FastDds
