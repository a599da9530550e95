#include "FastDdsWriter.h"

#include <algorithm>
#include <chrono>
#include <utility>

#include "EndpointSettings.h"

namespace Rabit::FastDds
{

namespace
{

constexpr std::chrono::milliseconds LongestWait{100};
}  // namespace

FastDdsWriter::FastDdsWriter(std::shared_ptr<SessionCore> core, const TopicDescription &topic,
                             const TopicQos &qos, const std::vector<std::string> &partitions)
    : VendorWriter(std::move(core), topic, qos),
      _pool(std::make_shared<PayloadPool>([] {})),
      _history(qos.Depth, qos.Durability == Durability::TransientLocal, _pool)
{
    auto attributes = MakeWriterAttributes(topic, qos);
    _writer = MakeWriter(_core->Participant(), attributes, _pool, _history, *this);
    if (_writer == nullptr)
    {
        throw TransportError("Fast DDS cannot make a writer of topic " + topic.Name);
    }
    if (!Announce(_core->Participant(), _writer, NamesOf(topic), MakeWriterQos(topic, qos, partitions)))
    {
        rtps::RTPSDomain::removeRTPSWriter(_writer);
        throw TransportError("Fast DDS cannot announce a writer of topic " + topic.Name);
    }
}

FastDdsWriter::~FastDdsWriter()
{
    _history.RemoveWriter(_writer);
}

WriteResult FastDdsWriter::SendTo(const std::string &node, const SampleEncoder &sample,
                                  std::int64_t sourceTime)
{
    static thread_local Targets targets;
    targets.clear();
    _core->VisitParticipantsOf(node, [](const Rtps::GuidPrefix &prefix) { targets.push_back(prefix); });
    return Send(sample, sourceTime, false, &targets);
}

WriteResult FastDdsWriter::Send(const SampleEncoder &sample, std::int64_t sourceTime, bool dispose,
                                const Targets *to)
{
    const std::size_t size = sample.EncodedSize();
    if (const auto refused = Refuse(size))
    {
        return *refused;
    }
    // Encoded before the vendor's lock is taken, so that several threads encode at the same time.
    const auto size32 = static_cast<std::uint32_t>(size);
    const PayloadPool::Buffer buffer = _pool->Acquire(size32);
    KeyHash key{};
    bool encoded = false;
    try
    {
        encoded = sample.Encode({buffer.Data, size});
    }
    catch (...)
    {
        _pool->Release(buffer);
        throw;
    }
    if (!encoded)
    {
        _pool->Release(buffer);
        return Fail("the sample cannot be encoded");
    }
    if (_topic.KeyOf && !_topic.KeyOf({buffer.Data, size}, key))
    {
        _pool->Release(buffer);
        return Fail("the encoded sample has no readable key");
    }
    MarkPadding(buffer.Data, size32);
    return SendEncoded(buffer, size32, key, sourceTime, dispose, to);
}

WriteResult FastDdsWriter::SendEncoded(PayloadPool::Buffer buffer, std::uint32_t size, const KeyHash &key,
                                       std::int64_t sourceTime, bool dispose, const Targets *to)
{
    const auto deadline = std::chrono::steady_clock::now() + LongestWait;
    const std::unique_lock lock(_writer->getMutex(), deadline);
    if (!lock.owns_lock())
    {
        _pool->Release(buffer);
        return TimedOut();
    }
    // Unregistered as well: readers need not keep the instance for this writer.
    rtps::CacheChange_t *change =
        SentHistory::New(*_writer, _history, dispose ? rtps::NOT_ALIVE_DISPOSED_UNREGISTERED : rtps::ALIVE);
    if (change == nullptr)
    {
        _pool->Release(buffer);
        return Fail("Fast DDS has no room for it");
    }
    // A disposal carries the key hash alone.
    _pool->Adopt(buffer, dispose ? 0 : size, *change);
    change->serializedPayload.encapsulation = (buffer.Data[1] & 1u) != 0 ? CDR_LE : CDR_BE;
    if (_topic.KeyOf)
    {
        rtps::octet *handle = change->instanceHandle.value;
        std::copy(key.begin(), key.end(), handle);
    }
    rtps::WriteParams params;
    params.source_timestamp().from_ns(sourceTime);
    _targets = to;
    if (to != nullptr && _writer->reader_data_filter() == nullptr)
    {
        _writer->reader_data_filter(this);
    }
    const bool added = _history.Add(*change, params, deadline);
    _targets = nullptr;
    if (!added)
    {
        SentHistory::Release(*_writer, _history, change);
        return Fail("Fast DDS refused it");
    }
    return WriteResult::Ok;
}

// The vendor calls this on the writing thread, with its lock held, as a sample goes out. There are no
// repetitions, because the writer is best effort.
bool FastDdsWriter::is_relevant(const rtps::CacheChange_t & /*change*/, const rtps::GUID_t &reader) const
{
    const Targets *const targets = _targets;
    const auto isOfReader = [&reader](const Rtps::GuidPrefix &target)
    { return std::equal(target.begin(), target.end(), reader.guidPrefix.value); };
    return targets == nullptr || std::any_of(targets->begin(), targets->end(), isOfReader);
}

int FastDdsWriter::MatchedReaders() const
{
    const std::lock_guard lock(_mutex);
    return static_cast<int>(_matched.size());
}

int FastDdsWriter::Destinations() const
{
    int participants = 0;
    const rtps::GUID_t *last = nullptr;
    const std::lock_guard lock(_mutex);
    for (const rtps::GUID_t &reader : _matched)  // those of a participant follow each other
    {
        participants += last == nullptr || last->guidPrefix != reader.guidPrefix ? 1 : 0;
        last = &reader;
    }
    return _core->HasMulticast() ? std::min(participants, 1) : participants;
}

void FastDdsWriter::OnMatched(rtps::RTPSWriter &writer, const rtps::MatchingInfo &info)
{
    if (_core->IsOwn(info.remoteEndpointGuid.guidPrefix))
    {
        // This version has no setting to ignore the own endpoints, so the match is undone.
        if (info.status == rtps::MATCHED_MATCHING)
        {
            writer.matched_reader_remove(info.remoteEndpointGuid);
        }
        return;
    }
    const std::lock_guard lock(_mutex);
    if (info.status == rtps::MATCHED_MATCHING)
    {
        _matched.insert(info.remoteEndpointGuid);
    }
    else
    {
        _matched.erase(info.remoteEndpointGuid);
    }
}

void FastDdsWriter::OnReceivedByAll(const rtps::CacheChange_t &change)
{
    // Under the writer's mutex, and no other one of ours.
    _history.ReceivedByAll(change);
}

void FastDdsWriter::on_offered_incompatible_qos(rtps::RTPSWriter * /*writer*/, dds::PolicyMask /*qos*/)
{
    _core->Log()->IncompatibleQos(_topic.Name);
}

}  // namespace Rabit::FastDds
