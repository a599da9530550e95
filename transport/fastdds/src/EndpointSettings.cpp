#include "EndpointSettings.h"

#include <algorithm>

#include "common/ParticipantIdentity.h"

namespace Rabit::FastDds
{

namespace
{

rtps::TopicKind_t KindOf(const TopicDescription &topic)
{
    return topic.KeyOf ? rtps::WITH_KEY : rtps::NO_KEY;
}

void Apply(const TopicDescription &topic, const TopicQos &qos, rtps::EndpointAttributes &endpoint)
{
    endpoint.topicKind = KindOf(topic);
    endpoint.reliabilityKind = qos.Reliability == Reliability::Reliable ? rtps::RELIABLE : rtps::BEST_EFFORT;
    endpoint.durabilityKind =
        qos.Durability == Durability::TransientLocal ? rtps::TRANSIENT_LOCAL : rtps::VOLATILE;
}

template <typename EndpointQos>
void ApplyQos(const TopicDescription &topic, const TopicQos &qos, const std::vector<std::string> &partitions,
              EndpointQos &result)
{
    result.m_reliability.kind = qos.Reliability == Reliability::Reliable ? dds::RELIABLE_RELIABILITY_QOS
                                                                         : dds::BEST_EFFORT_RELIABILITY_QOS;
    result.m_durability.kind = qos.Durability == Durability::TransientLocal
                                   ? dds::TRANSIENT_LOCAL_DURABILITY_QOS
                                   : dds::VOLATILE_DURABILITY_QOS;
    // An empty list is written out as the default partition: an empty one would not match another make's `*`.
    std::vector<std::string> names = partitions.empty() ? std::vector<std::string>{""} : partitions;
    result.m_partition.names(names);
    const std::string userData = MakeEndpointUserData(topic.TypeHash);
    result.m_userData.data_vec({userData.begin(), userData.end()});
    result.data_sharing.off();
}

}  // namespace

TopicNames NamesOf(const TopicDescription &topic)
{
    return {.Topic = topic.Name, .Type = topic.TypeName, .HasKey = topic.KeyOf != nullptr};
}

rtps::WriterAttributes MakeWriterAttributes(const TopicDescription &topic, const TopicQos &qos)
{
    rtps::WriterAttributes attributes;
    Apply(topic, qos, attributes.endpoint);
    // The vendor's defaults (3 s, 5 ms) suit a wire that loses nothing: here they would make every repair,
    // and the end of every replay, seconds late.
    SetPace(attributes, WriterPace{.HeartbeatMs = 20, .FirstHeartbeatMs = 5, .NackResponseMs = 1});
    attributes.mode = rtps::SYNCHRONOUS_WRITER;
    return attributes;
}

dds::WriterQos MakeWriterQos(const TopicDescription &topic, const TopicQos &qos,
                             const std::vector<std::string> &partitions)
{
    dds::WriterQos result;
    ApplyQos(topic, qos, partitions, result);
    return result;
}

rtps::ReaderAttributes MakeReaderAttributes(const TopicDescription &topic, const TopicQos &qos)
{
    rtps::ReaderAttributes attributes;
    Apply(topic, qos, attributes.endpoint);
    SetPace(attributes, ReaderPace{.HeartbeatResponseMs = 1, .FirstAcknowledgementMs = 10});
    return attributes;
}

dds::ReaderQos MakeReaderQos(const TopicDescription &topic, const TopicQos &qos,
                             const std::vector<std::string> &partitions)
{
    dds::ReaderQos result;
    ApplyQos(topic, qos, partitions, result);
    return result;
}

WriterId ToWriterId(const rtps::GUID_t &guid)
{
    WriterId id;
    const auto next = std::copy_n(guid.guidPrefix.value, rtps::GuidPrefix_t::size, id.begin());
    std::copy_n(guid.entityId.value, rtps::EntityId_t::size, next);
    return id;
}

}  // namespace Rabit::FastDds
