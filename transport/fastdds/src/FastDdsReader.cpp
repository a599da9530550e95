#include "FastDdsReader.h"

#include <fastdds/rtps/RTPSDomain.h>
#include <fastdds/rtps/common/CacheChange.h>
#include <fastdds/rtps/participant/RTPSParticipant.h>
#include <fastdds/rtps/reader/RTPSReader.h>

#include <algorithm>
#include <utility>

#include "EndpointSettings.h"

namespace Rabit::FastDds
{

namespace rtps = eprosima::fastrtps::rtps;

namespace
{

constexpr std::size_t HeaderSize = 4;

rtps::HistoryAttributes MakeHistoryAttributes()
{
    constexpr int ReservedChanges = 8;
    return {rtps::DYNAMIC_RESERVE_MEMORY_MODE, 0, ReservedChanges, 0};
}

// The payload without the padding that RTPS added. A submessage's length is a multiple of 4, so a payload of
// another length came in fragments, which carry its true length.
SampleBytes WithoutPadding(const rtps::SerializedPayload_t &payload)
{
    std::size_t size = payload.length;
    if (size > HeaderSize && size % 4 == 0)
    {
        size -= std::min<std::size_t>(payload.data[3] & 3u, size - HeaderSize);
    }
    return {payload.data, size};
}

}  // namespace

FastDdsReader::FastDdsReader(std::shared_ptr<SessionCore> core, const TopicDescription &topic,
                             const TopicQos &qos, const std::vector<std::string> &partitions,
                             SampleHandler handler)
    : _core(std::move(core)),
      _topic(topic),
      _use(_core->Topics(), topic),
      _handler(std::move(handler)),
      _gate(_core->Log(), "the reader of " + topic.Name),
      _pool(std::make_shared<PayloadPool>([log = _core->Log(), name = topic.Name]
                                          { log->MalformedSample(name, "it is larger than 64 MiB"); })),
      _history(MakeHistoryAttributes())
{
    auto attributes = MakeReaderAttributes(topic, qos, partitions);
    _reader = rtps::RTPSDomain::createRTPSReader(&_core->Participant(), attributes, _pool, &_history, this);
    if (_reader == nullptr)
    {
        throw TransportError("Fast DDS cannot make a reader of topic " + topic.Name);
    }
    // A sample may be addressed to no reader in particular: this reader accepts only those of matched
    // writers.
    _reader->enableMessagesFromUnkownWriters(false);
    if (!_core->Participant().registerReader(_reader, MakeTopicAttributes(topic),
                                             MakeReaderQos(qos, partitions)))
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

void FastDdsReader::onNewCacheChangeAdded(rtps::RTPSReader *reader, const Change *const change)
{
    if (!_core->IsOwn(change->writerGUID.guidPrefix))
    {
        _gate.Run([&] { HandOver(*change); });
    }
    reader->getHistory()->remove_change(const_cast<Change *>(change));
}

void FastDdsReader::HandOver(const Change &change)
{
    SampleInfo info = InfoFor(change.writerGUID);
    info.SourceTime = change.sourceTimestamp.to_ns();
    info.Sequence = change.sequenceNumber.to64long();
    info.Alive = change.kind == rtps::ALIVE;
    const SampleBytes bytes = WithoutPadding(change.serializedPayload);
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
    if (!info.Alive)
    {
        HandOverEnd(change, info);
        return;
    }
    if (_lastNode != nullptr)
    {
        _lastNode->Hear();
    }
    if (_topic.KeyOf)
    {
        _instances.Alive(info.Key, info.Writer);
    }
    _handler(bytes, info);
}

void FastDdsReader::HandOverEnd(const Change &change, SampleInfo &info)
{
    if (!_topic.KeyOf)
    {
        return;  // a topic without a key has no instance that could end
    }
    if (change.kind == rtps::NOT_ALIVE_UNREGISTERED)
    {
        if (!_instances.Unregistered(info.Key, info.Writer))
        {
            return;  // other writers still have it
        }
        info.SourceTime = 0;
        info.Sequence = 0;
    }
    else
    {
        _instances.Disposed(info.Key);
    }
    _handler({}, info);
}

SampleInfo FastDdsReader::InfoFor(const Guid &writer)
{
    if (_lastWriter != writer || _lastNode == nullptr)
    {
        _lastNode = _core->IdentityOf(writer.guidPrefix);
        _lastWriter = writer;
    }
    SampleInfo info;
    info.Writer = ToWriterId(writer);
    if (_lastNode != nullptr)
    {
        info.Node = _lastNode->Node;
        info.Incarnation = _lastNode->Incarnation;
    }
    return info;
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

void FastDdsReader::onReaderMatched(rtps::RTPSReader *reader, rtps::MatchingInfo &info)
{
    const Guid writer = info.remoteEndpointGuid;
    if (_core->IsOwn(writer.guidPrefix))
    {
        // This version has no setting to ignore the own endpoints, so the match is undone.
        if (info.status == rtps::MATCHED_MATCHING)
        {
            reader->matched_writer_remove(writer);
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
        _gate.Run([&] { WriterGone(writer); });
    }
}

void FastDdsReader::WriterGone(const Guid &writer)
{
    for (const KeyHash &key : _instances.WriterGone(ToWriterId(writer)))
    {
        SampleInfo info = InfoFor(writer);
        info.Alive = false;
        info.Key = key;
        _handler({}, info);
    }
}

void FastDdsReader::on_requested_incompatible_qos(rtps::RTPSReader * /*reader*/,
                                                  eprosima::fastdds::dds::PolicyMask /*qos*/)
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
