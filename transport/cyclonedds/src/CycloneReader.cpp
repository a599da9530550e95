#include "CycloneReader.h"

#include <algorithm>
#include <utility>

#include "EndpointSettings.h"
#include "InStep.h"

namespace Rabit::Cyclone
{

namespace
{

constexpr std::size_t HeaderSize = 4;

// The sample without the padding that RTPS added. A submessage's length is a multiple of 4, so a sample of
// another length came in fragments, which carry its true length.
SampleBytes WithoutPadding(const OpaqueSample &sample)
{
    std::size_t size = sample.Size;
    if (size > HeaderSize && size % 4 == 0)
    {
        size -= std::min<std::size_t>(sample.Data()[3] & 3u, size - HeaderSize);
    }
    return {sample.Data(), size};
}

}  // namespace

CycloneReader::CycloneReader(std::shared_ptr<SessionCore> core, const TopicDescription &topic,
                             const TopicQos &qos, const std::vector<std::string> &partitions,
                             SampleHandler handler)
    : _core(std::move(core)),
      _topic(topic),
      _use(_core->Topics(), topic),
      _handler(std::move(handler)),
      _gate(_core->Log(), "the reader of " + topic.Name),
      _entityTopic(MakeTopic(*_core, topic, _type))
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
    _reader =
        Entity(dds_create_reader_rhc(_core->Participant(), _entityTopic.Get(),
                                     MakeReaderQos(qos, partitions).get(), listener.get(), &_cache.Base),
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
            reader._gate.Run([&] { reader.WriterGone(ToWriterId(writer->guid)); });
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
    if (!info.Alive)
    {
        HandOverEnd(sample, info);
        return;
    }
    if (_lastNode != nullptr)
    {
        _lastNode->Hear();
    }
    if (_topic.KeyOf)
    {
        _instances.Alive(info.Key, writer);
    }
    _handler(WithoutPadding(sample), info);
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

void CycloneReader::HandOverEnd(const OpaqueSample &sample, SampleInfo &info)
{
    if (!_topic.KeyOf)
    {
        return;  // a topic without a key has no instance that could end
    }
    if ((sample.Header.statusinfo & StatusDisposed) != 0)
    {
        _instances.Disposed(info.Key);
    }
    else if (_instances.Unregistered(info.Key, info.Writer))
    {
        info.SourceTime = 0;
        info.Sequence = 0;
    }
    else
    {
        return;  // other writers still have it
    }
    _handler({}, info);
}

void CycloneReader::WriterGone(const WriterId &writer)
{
    _inStep.erase(writer);
    for (const KeyHash &key : _instances.WriterGone(writer))
    {
        SampleInfo info = InfoFor(writer);
        info.Alive = false;
        info.Key = key;
        _handler({}, info);
    }
}

SampleInfo CycloneReader::InfoFor(const WriterId &writer)
{
    if (_lastWriter != writer || _lastNode == nullptr)
    {
        _lastNode = _core->IdentityOf(writer);
        _lastWriter = writer;
    }
    SampleInfo info;
    info.Writer = writer;
    if (_lastNode != nullptr)
    {
        info.Node = _lastNode->Node;
        info.Incarnation = _lastNode->Incarnation;
    }
    return info;
}

}  // namespace Rabit::Cyclone
