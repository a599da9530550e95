#include "FastDdsReader.h"

#include <algorithm>
#include <utility>

#include "EndpointSettings.h"

namespace Rabit::FastDds
{

namespace
{

rtps::HistoryAttributes MakeHistoryAttributes()
{
    constexpr int ReservedChanges = 8;
    return {rtps::DYNAMIC_REUSABLE_MEMORY_MODE, 0, ReservedChanges, 0};
}

}  // namespace

FastDdsReader::FastDdsReader(std::shared_ptr<SessionCore> core, const TopicDescription &topic,
                             const TopicQos &qos, const std::vector<std::string> &partitions,
                             SampleHandler handler)
    : VendorReader(std::move(core), topic, std::move(handler)),
      _pool(std::make_shared<PayloadPool>([log = _core->Log(), name = topic.Name]
                                          { log->MalformedSample(name, "it is larger than 64 MiB"); })),
      _history(MakeHistoryAttributes())
{
    auto attributes = MakeReaderAttributes(topic, qos);
    _reader = MakeReader(_core->Participant(), attributes, _pool, _history, *this);
    if (_reader == nullptr)
    {
        throw TransportError("Fast DDS cannot make a reader of topic " + topic.Name);
    }
    if (!Announce(_core->Participant(), _reader, NamesOf(topic), MakeReaderQos(topic, qos, partitions)))
    {
        rtps::RTPSDomain::removeRTPSReader(_reader);
        throw TransportError("Fast DDS cannot announce a reader of topic " + topic.Name);
    }
}

FastDdsReader::~FastDdsReader()
{
    _gate.Close();
    rtps::RTPSDomain::removeRTPSReader(_reader);
}

int FastDdsReader::MatchedWriters() const
{
    const std::lock_guard lock(_mutex);
    return static_cast<int>(_matched.size());
}

void FastDdsReader::OnSample(rtps::RTPSReader &reader, const Change &change)
{
    if (!_core->IsOwn(change.writerGUID.guidPrefix))
    {
        _gate.Run([&] { HandOver(change); });
    }
    HistoryOf(reader).remove_change(const_cast<Change *>(&change));
}

void FastDdsReader::HandOver(const Change &change)
{
    SampleInfo info = InfoFor(ToWriterId(change.writerGUID));
    info.SourceTime = change.sourceTimestamp.to_ns();
    info.Sequence = change.sequenceNumber.to64long();
    info.Alive = change.kind == rtps::ALIVE;
    const SampleBytes bytes =
        WithoutPadding({change.serializedPayload.data, change.serializedPayload.length});
    if (info.Alive && bytes.size() < HeaderSize)
    {
        _core->Log()->MalformedSample(_topic.Name, "it is shorter than its header");
        return;
    }
    if (_topic.KeyOf && !KeyFrom(change, bytes, info.Key))
    {
        _core->Log()->MalformedSample(_topic.Name, "it has no readable key");
        return;
    }
    if (info.Alive)
    {
        Deliver(bytes, info);
    }
    else
    {
        DeliverEnd(info, change.kind != rtps::NOT_ALIVE_UNREGISTERED);
    }
}

bool FastDdsReader::KeyFrom(const Change &change, SampleBytes bytes, KeyHash &key) const
{
    if (change.instanceHandle.isDefined())
    {
        const rtps::octet *handle = change.instanceHandle.value;
        std::copy_n(handle, key.size(), key.begin());
        return true;
    }
    return bytes.size() >= HeaderSize && _topic.KeyOf(bytes, key);
}

void FastDdsReader::OnMatched(rtps::RTPSReader &reader, const rtps::MatchingInfo &info)
{
    const Guid writer = info.remoteEndpointGuid;
    if (_core->IsOwn(writer.guidPrefix))
    {
        // This version has no setting to ignore the own endpoints, so the match is undone.
        if (info.status == rtps::MATCHED_MATCHING)
        {
            reader.matched_writer_remove(writer);
        }
        return;
    }
    {
        const std::lock_guard lock(_mutex);
        if (info.status == rtps::MATCHED_MATCHING)
        {
            _matched.insert(writer);
        }
        else
        {
            _matched.erase(writer);
        }
    }
    if (info.status == rtps::REMOVED_MATCHING && _topic.KeyOf)
    {
        _gate.Run([&] { DeliverEndsOf(ToWriterId(writer)); });
    }
}

void FastDdsReader::on_requested_incompatible_qos(rtps::RTPSReader * /*reader*/, dds::PolicyMask /*qos*/)
{
    _core->Log()->IncompatibleQos(_topic.Name);
}

void FastDdsReader::on_sample_lost(rtps::RTPSReader * /*reader*/, std::int32_t count)
{
    if (count > 0)
    {
        _core->Log()->SamplesLost(static_cast<std::uint64_t>(count));
    }
}

}  // namespace Rabit::FastDds
