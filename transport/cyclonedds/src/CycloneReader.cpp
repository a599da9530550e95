#include "CycloneReader.h"

#include <algorithm>
#include <utility>

#include "EndpointSettings.h"
#include "InStep.h"

namespace Rabit::Cyclone
{

CycloneReader::CycloneReader(std::shared_ptr<SessionCore> core, const TopicDescription &topic,
                             const TopicQos &qos, const std::vector<std::string> &partitions,
                             SampleHandler handler)
    : VendorReader(std::move(core), topic, std::move(handler)),
      _entityTopic(MakeTopic(*_core, topic, _type)),
      _instance(_type, topic)
{
    _cache.Base.common.ops = &CacheOps();
    _cache.Owner = this;
    const Listener listener = MakeListener(this);
    dds_lset_requested_incompatible_qos(
        listener.get(),
        [](dds_entity_t, const dds_requested_incompatible_qos_status_t status, void *self)
        {
            // Different partitions are not incompatible (OMG DDS 1.4, 2.2.3.13), but the vendor reports them
            // too.
            if (status.last_policy_id != DDS_PARTITION_QOS_POLICY_ID)
            {
                const auto *reader = static_cast<CycloneReader *>(self);
                reader->_core->Log()->IncompatibleQos(reader->_topic.Name);
            }
        });
    dds_lset_sample_lost(listener.get(),
                         [](dds_entity_t, const dds_sample_lost_status_t status, void *self)
                         {
                             static_cast<CycloneReader *>(self)->_core->Log()->SamplesLost(
                                 static_cast<std::uint64_t>(status.total_count_change));
                         });
    _reader = Entity(
        dds_create_reader_rhc(_core->Participant(), _entityTopic.Get(),
                              MakeReaderQos(topic, qos, partitions).get(), listener.get(), &_cache.Base),
        "make a reader of topic " + topic.Name);
}

CycloneReader::~CycloneReader()
{
    _gate.Close();
}

int CycloneReader::MatchedWriters() const
{
    dds_subscription_matched_status_t status{};
    dds_get_subscription_matched_status(_reader.Get(), &status);
    return static_cast<int>(status.current_count);
}

CycloneReader &CycloneReader::OwnerOf(ddsi_rhc *cache)
{
    return *reinterpret_cast<Cache *>(cache)->Owner;
}

const dds_rhc_ops &CycloneReader::CacheOps()
{
    static const dds_rhc_ops ops = []
    {
        dds_rhc_ops o{};
        o.rhc_ops.store =
            [](ddsi_rhc *cache, const ddsi_writer_info *writer, ddsi_serdata *sample, ddsi_tkmap_instance *)
        {
            auto &reader = OwnerOf(cache);
            reader._gate.Run(
                [&] {
                    reader.HandOver(*reinterpret_cast<const OpaqueSample *>(sample),
                                    ToWriterId(writer->guid));
                });
            return true;
        };
        o.rhc_ops.unregister_wr = [](ddsi_rhc *cache, const ddsi_writer_info *writer)
        {
            auto &reader = OwnerOf(cache);
            reader._gate.Run(
                [&]
                {
                    const WriterId gone = ToWriterId(writer->guid);
                    reader._inStep.erase(gone);
                    reader.DeliverEndsOf(gone);
                });
        };
        o.rhc_ops.relinquish_ownership = [](ddsi_rhc *, std::uint64_t) {};
        o.rhc_ops.set_qos = [](ddsi_rhc *, const dds_qos *) {};
        o.rhc_ops.free = [](ddsi_rhc *) {};  // it is part of the reader
        o.read = o.take = [](dds_rhc *, bool, void **, dds_sample_info_t *, std::uint32_t, std::uint32_t,
                             dds_instance_handle_t, dds_readcond *) -> std::int32_t { return 0; };
        o.readcdr = o.takecdr = [](dds_rhc *, bool, ddsi_serdata **, dds_sample_info_t *, std::uint32_t,
                                   std::uint32_t, std::uint32_t, std::uint32_t,
                                   dds_instance_handle_t) -> std::int32_t { return 0; };
        o.add_readcondition = [](dds_rhc *, dds_readcond *) { return false; };
        o.remove_readcondition = [](dds_rhc *, dds_readcond *) {};
        o.lock_samples = [](dds_rhc *) -> std::uint32_t { return 0; };
        o.associate = [](dds_rhc *, dds_reader *, const ddsi_sertype *, ddsi_tkmap *) -> dds_return_t
        { return DDS_RETCODE_OK; };
        return o;
    }();
    return ops;
}

void CycloneReader::HandOver(const OpaqueSample &sample, const WriterId &writer)
{
    Follow(writer);
    SampleInfo info = InfoFor(writer);
    info.SourceTime = sample.Header.timestamp.v;
    info.Sequence = sample.Sequence;
    info.Key = sample.Key;
    info.Alive = (sample.Header.statusinfo & (StatusDisposed | StatusUnregistered)) == 0;
    if (info.Alive)
    {
        Deliver(WithoutPadding({sample.Data(), sample.Size}), info);
    }
    else
    {
        DeliverEnd(info, (sample.Header.statusinfo & StatusDisposed) != 0);
    }
}

void CycloneReader::Follow(const WriterId &writer)
{
    if (_inStep.contains(writer))
    {
        return;
    }
    const ddsi_guid_t guid = ToVendorGuid(writer);
    if (RabitCycloneFollow(&guid))
    {
        _inStep.insert(writer);
    }
}

}  // namespace Rabit::Cyclone
