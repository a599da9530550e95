#include "CycloneWriter.h"

#include <string>
#include <utility>
#include <vector>

#include "EndpointSettings.h"
#include "Guid.h"
#include "OpaqueType.h"
#include "VendorTraffic.h"

namespace Rabit::Cyclone
{

namespace
{

struct Unref
{
    void operator()(OpaqueSample *sample) const { ddsi_serdata_unref(&sample->Header); }
};

// The key in place of a sample. The vendor writes the key hash beside it only if there is such a payload. The
// payload repeats the hash, which is the serialized key in big-endian CDR if that has up to 16 bytes. For
// larger keys, readers of this make that ignore the key hash do not learn of the disposal.
OpaqueSample *MakeKey(const ddsi_sertype *type, const KeyHash &key)
{
    constexpr std::size_t header = 4;
    OpaqueSample *sample = NewSample(type, SDK_KEY, header + key.size());
    std::fill_n(sample->Data(), header, std::uint8_t{0});
    std::copy(key.begin(), key.end(), sample->Data() + header);
    return sample;
}

}  // namespace

CycloneWriter::CycloneWriter(std::shared_ptr<SessionCore> core, const TopicDescription &topic,
                             const TopicQos &qos, const std::vector<std::string> &partitions)
    : VendorWriter(std::move(core), topic, qos),
      _entityTopic(MakeTopic(*_core, topic, _type)),
      _instance(_type, topic)
{
    const Listener listener = MakeListener(this);
    dds_lset_offered_incompatible_qos(
        listener.get(),
        [](dds_entity_t, const dds_offered_incompatible_qos_status_t status, void *self)
        {
            // Different partitions are not incompatible (OMG DDS 1.4, 2.2.3.13), but the vendor reports them
            // too.
            if (status.last_policy_id != DDS_PARTITION_QOS_POLICY_ID)
            {
                const auto *writer = static_cast<CycloneWriter *>(self);
                writer->_core->Log()->IncompatibleQos(writer->_topic.Name);
            }
        });
    _writer = Entity(dds_create_writer(_core->Participant(), _entityTopic.Get(),
                                       MakeWriterQos(topic, qos, partitions).get(), listener.get()),
                     "make a writer of topic " + topic.Name);
}

WriteResult CycloneWriter::SendTo(const std::string &node, const SampleEncoder &sample,
                                  std::int64_t sourceTime)
{
    // Directs all datagrams that the vendor sends on this thread until the end of the scope.
    class Direction
    {
    public:
        Direction(const ddsi_sertype *type, const ddsi_guid_t &writer,
                  const std::vector<ddsi_guid_t> &participants)
        {
            RabitCycloneWriteTo(type, &writer, participants.data(), participants.size());
        }
        ~Direction() { RabitCycloneWriteToAll(); }
        Direction(const Direction &) = delete;
        Direction &operator=(const Direction &) = delete;
    };
    static thread_local std::vector<ddsi_guid_t> participants;
    participants.clear();
    _core->VisitParticipantsOf(
        node, [](const Rtps::GuidPrefix &prefix) { participants.push_back(ParticipantOf(prefix)); });
    const Direction direction(_type, VendorGuid(), participants);
    return Send(sample, sourceTime, false);
}

int CycloneWriter::MatchedReaders() const
{
    dds_publication_matched_status_t status{};
    dds_get_publication_matched_status(_writer.Get(), &status);
    return static_cast<int>(status.current_count);
}

int CycloneWriter::Destinations() const
{
    const ddsi_guid_t known = VendorGuid();
    return MatchedReaders() == 0 ? 0 : RabitCycloneDestinations(_type, &known);
}

// The writer's GUID; all zero, which no writer has, if the session is closed.
ddsi_guid_t CycloneWriter::VendorGuid() const
{
    dds_guid_t guid{};
    dds_get_guid(_writer.Get(), &guid);
    return ToVendorGuid(ToWriterId(guid));
}

WriteResult CycloneWriter::Send(const SampleEncoder &encoder, std::int64_t sourceTime, bool dispose)
{
    const std::size_t size = encoder.EncodedSize();
    if (const auto refused = Refuse(size))
    {
        return *refused;
    }
    std::unique_ptr<OpaqueSample, Unref> sample(NewSample(_type, SDK_DATA, size));
    if (!encoder.Encode({sample->Data(), size}))
    {
        return Fail("the sample cannot be encoded");
    }
    KeyHash key{};
    if (_topic.KeyOf && !_topic.KeyOf({sample->Data(), size}, key))
    {
        return Fail("the encoded sample has no readable key");
    }
    if (dispose)
    {
        sample.reset(MakeKey(_type, key));
    }
    else
    {
        MarkPadding(sample->Data(), size);
    }
    if (_topic.KeyOf)
    {
        sample->SetKey(key);
    }
    sample->Header.timestamp.v = sourceTime;
    // Unregistered as well: the vendor keeps nothing of such an instance once its readers know, not even for
    // late ones. Readers need not keep it for this writer either.
    sample->Header.statusinfo = dispose ? StatusDisposed | StatusUnregistered : 0u;
    const dds_return_t result = dds_forwardcdr(_writer.Get(), &sample.release()->Header);
    if (result == DDS_RETCODE_TIMEOUT)
    {
        return TimedOut();
    }
    return result == DDS_RETCODE_OK ? WriteResult::Ok : Fail(dds_strretcode(result));
}

}  // namespace Rabit::Cyclone
