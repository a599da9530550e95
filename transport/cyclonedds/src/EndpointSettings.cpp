#include "EndpointSettings.h"

#include "OpaqueType.h"
#include "common/ParticipantIdentity.h"

namespace Rabit::Cyclone
{

namespace
{

// Longest time that Write waits for room in the writer's history.
constexpr dds_duration_t LongestWait = DDS_MSECS(100);

Qos MakeEndpointQos(const TopicDescription &topic, const TopicQos &qos,
                    const std::vector<std::string> &partitions)
{
    Qos result = MakeQos();
    dds_qset_reliability(
        result.get(),
        qos.Reliability == Reliability::Reliable ? DDS_RELIABILITY_RELIABLE : DDS_RELIABILITY_BEST_EFFORT,
        LongestWait);
    dds_qset_durability(result.get(), qos.Durability == Durability::TransientLocal
                                          ? DDS_DURABILITY_TRANSIENT_LOCAL
                                          : DDS_DURABILITY_VOLATILE);
    dds_qset_history(result.get(), DDS_HISTORY_KEEP_LAST, qos.Depth);
    dds_qset_ignorelocal(result.get(), DDS_IGNORELOCAL_PARTICIPANT);
    const dds_data_representation_id_t representation = DDS_DATA_REPRESENTATION_XCDR1;
    dds_qset_data_representation(result.get(), 1, &representation);
    const std::string userData = MakeEndpointUserData(topic.TypeHash);
    dds_qset_userdata(result.get(), userData.data(), userData.size());
    // An empty list is written out as the default partition: an empty one would not match another make's `*`.
    std::vector<const char *> names;
    for (const auto &name : partitions)
    {
        names.push_back(name.c_str());
    }
    if (names.empty())
    {
        names.push_back("");
    }
    dds_qset_partition(result.get(), static_cast<std::uint32_t>(names.size()), names.data());
    return result;
}

}  // namespace

Qos MakeWriterQos(const TopicDescription &topic, const TopicQos &qos,
                  const std::vector<std::string> &partitions)
{
    Qos result = MakeEndpointQos(topic, qos, partitions);
    dds_qset_durability_service(result.get(), 0, DDS_HISTORY_KEEP_LAST, qos.Depth, DDS_LENGTH_UNLIMITED,
                                DDS_LENGTH_UNLIMITED, DDS_LENGTH_UNLIMITED);
    dds_qset_writer_data_lifecycle(result.get(), false);
    return result;
}

Qos MakeReaderQos(const TopicDescription &topic, const TopicQos &qos,
                  const std::vector<std::string> &partitions)
{
    return MakeEndpointQos(topic, qos, partitions);
}

Entity MakeTopic(const SessionCore &core, const TopicDescription &topic, const ddsi_sertype *&type)
{
    ddsi_sertype *made = NewType(topic, core.Log());
    const dds_entity_t entity =
        dds_create_topic_sertype(core.Participant(), topic.Name.c_str(), &made, nullptr, nullptr, nullptr);
    if (entity < 0)
    {
        ddsi_sertype_unref(made);
    }
    type = made;
    return {entity, "make topic " + topic.Name};
}

}  // namespace Rabit::Cyclone
