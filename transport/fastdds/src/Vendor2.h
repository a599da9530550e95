// Included by Vendor.h, for Fast DDS 2.
#pragma once

namespace Rabit::FastDds
{

class ParticipantEvents : public rtps::RTPSParticipantListener
{
protected:
    virtual void OnParticipant(const ParticipantNews &news) = 0;
    virtual void OnEndpoint(const EndpointNews &news) = 0;

private:
    void onParticipantDiscovery(rtps::RTPSParticipant * /*participant*/,
                                rtps::ParticipantDiscoveryInfo &&info) override
    {
        using Info = rtps::ParticipantDiscoveryInfo;
        const auto &peer = info.info;
        OnParticipant({.Change = info.status == Info::REMOVED_PARTICIPANT   ? ParticipantChange::Left
                                 : info.status == Info::DROPPED_PARTICIPANT ? ParticipantChange::Lost
                                                                            : ParticipantChange::Present,
                       .Prefix = peer.m_guid.guidPrefix,
                       .Name = peer.m_participantName.to_string(),
                       .UserData = peer.m_userData.data_vec(),
                       .Discovery = peer.metatraffic_locators,
                       .Samples = peer.default_locators});
    }
    void onReaderDiscovery(rtps::RTPSParticipant * /*participant*/, rtps::ReaderDiscoveryInfo &&info) override
    {
        Tell(info.info, info.status == rtps::ReaderDiscoveryInfo::REMOVED_READER);
    }
    void onWriterDiscovery(rtps::RTPSParticipant * /*participant*/, rtps::WriterDiscoveryInfo &&info) override
    {
        Tell(info.info, info.status == rtps::WriterDiscoveryInfo::REMOVED_WRITER);
    }
    template <typename Proxy>
    void Tell(const Proxy &proxy, bool isRemoved)
    {
        const auto &qos = proxy.m_qos;
        OnEndpoint({.Guid = proxy.guid(),
                    .IsWriter = std::is_same_v<Proxy, rtps::WriterProxyData>,
                    .IsRemoved = isRemoved,
                    .Topic = proxy.topicName().to_string(),
                    .Type = proxy.typeName().to_string(),
                    .Reliability = qos.m_reliability.kind,
                    .Durability = qos.m_durability.kind,
                    .Partitions = qos.m_partition.getNames(),
                    .HasDeadline = !qos.m_deadline.period.is_infinite(),
                    .HasLiveliness = qos.m_liveliness.kind != dds::AUTOMATIC_LIVELINESS_QOS ||
                                     !qos.m_liveliness.lease_duration.is_infinite(),
                    .IsExclusive = qos.m_ownership.kind == dds::EXCLUSIVE_OWNERSHIP_QOS});
    }
};

class ReaderEvents : public rtps::ReaderListener
{
protected:
    virtual void OnSample(rtps::RTPSReader &reader, const rtps::CacheChange_t &change) = 0;
    virtual void OnMatched(rtps::RTPSReader &reader, const rtps::MatchingInfo &info) = 0;

private:
    void onNewCacheChangeAdded(rtps::RTPSReader *reader, const rtps::CacheChange_t *const change) override
    {
        OnSample(*reader, *change);
    }
    void onReaderMatched(rtps::RTPSReader *reader, rtps::MatchingInfo &info) override
    {
        OnMatched(*reader, info);
    }
};

class WriterEvents : public rtps::WriterListener
{
protected:
    virtual void OnMatched(rtps::RTPSWriter &writer, const rtps::MatchingInfo &info) = 0;
    virtual void OnReceivedByAll(const rtps::CacheChange_t &change) = 0;

private:
    void onWriterMatched(rtps::RTPSWriter *writer, rtps::MatchingInfo &info) override
    {
        OnMatched(*writer, info);
    }
    void onWriterChangeReceivedByAll(rtps::RTPSWriter * /*writer*/, rtps::CacheChange_t *change) override
    {
        OnReceivedByAll(*change);
    }
};

// A pool of payloads.
class Buffers : public rtps::IPayloadPool
{
public:
    bool get_payload(std::uint32_t size, rtps::CacheChange_t &change) final
    {
        if (!Take(size, change.serializedPayload))
        {
            return false;
        }
        change.payload_owner(this);
        return true;
    }
    bool get_payload(rtps::SerializedPayload_t &data, rtps::IPayloadPool *& /*owner*/,
                     rtps::CacheChange_t &change) final
    {
        if (!TakeCopy(data, change.serializedPayload))
        {
            return false;
        }
        change.payload_owner(this);
        return true;
    }
    bool release_payload(rtps::CacheChange_t &change) final
    {
        GiveBack(change.serializedPayload);
        change.payload_owner(nullptr);
        return true;
    }

protected:
    virtual bool Take(std::uint32_t size, rtps::SerializedPayload_t &payload) = 0;
    virtual bool TakeCopy(const rtps::SerializedPayload_t &data, rtps::SerializedPayload_t &payload) = 0;
    virtual void GiveBack(rtps::SerializedPayload_t &payload) = 0;
    void Own(rtps::CacheChange_t &change) { change.payload_owner(this); }
};

// A writer's history.
class SentHistory : public rtps::WriterHistory
{
public:
    SentHistory(const rtps::HistoryAttributes &attributes, std::shared_ptr<rtps::IPayloadPool> /*pool*/)
        : WriterHistory(attributes)
    {
    }
    // A sample without a payload; nullptr if there is no room.
    static rtps::CacheChange_t *New(rtps::RTPSWriter &writer, rtps::WriterHistory & /*history*/,
                                    rtps::ChangeKind_t kind)
    {
        return writer.new_change(kind);
    }
    static void Release(rtps::RTPSWriter &writer, rtps::WriterHistory & /*history*/,
                        rtps::CacheChange_t *change)
    {
        writer.release_change(change);
    }
    iterator remove_change_nts(const_iterator removal, bool release = true) final
    {
        if (removal != m_changes.end())
        {
            OnRemoval(**removal);
        }
        return WriterHistory::remove_change_nts(removal, release);
    }

protected:
    // Before each removal of a sample.
    virtual void OnRemoval(const rtps::CacheChange_t &change) = 0;
};

// A transport on top of UDP that sees each datagram.
class ChainedUdp : public rtps::ChainingTransport
{
public:
    using ChainingTransport::ChainingTransport;

    bool send(rtps::SenderResource *sender, const rtps::octet *buffer, std::uint32_t size,
              rtps::LocatorsIterator *begin, rtps::LocatorsIterator *end,
              const std::chrono::steady_clock::time_point &timeout) final
    {
        return Send(*sender, {buffer, size}, *begin, *end, timeout);
    }

    bool transform_remote_locator(const rtps::Locator_t &remote, rtps::Locator_t &result) const final
    {
        return MaySendTo(remote) && ChainingTransport::transform_remote_locator(remote, result);
    }

    // False: the vendor does not use that address of a peer.
    virtual bool MaySendTo(const rtps::Locator_t &remote) const = 0;
    virtual bool Send(rtps::SenderResource &sender, std::span<const std::uint8_t> datagram,
                      rtps::LocatorsIterator &begin, rtps::LocatorsIterator &end,
                      const std::chrono::steady_clock::time_point &timeout) = 0;

    static bool SendOn(rtps::SenderResource &sender, std::span<const std::uint8_t> datagram,
                       rtps::LocatorsIterator &begin, rtps::LocatorsIterator &end,
                       const std::chrono::steady_clock::time_point &timeout)
    {
        return sender.send(datagram.data(), static_cast<std::uint32_t>(datagram.size()), &begin, &end,
                           timeout);
    }
};

inline void AddProperties(rtps::PropertyPolicy & /*properties*/) {}

// The heartbeat period, the first heartbeat's delay, and the delays of repair.
inline auto TimesOf(rtps::WriterAttributes &attributes)
{
    auto &times = attributes.times;
    return std::tie(times.heartbeatPeriod, times.initialHeartbeatDelay, times.nackResponseDelay,
                    times.nackSupressionDuration);
}

// The delays of an answer to a heartbeat, and of the first acknowledgement.
inline auto TimesOf(rtps::ReaderAttributes &attributes)
{
    return std::tie(attributes.times.heartbeatResponseDelay, attributes.times.initialAcknackDelay);
}

// Removes all samples of a writer, also of one whose history the vendor has.
inline void RemoveSamples(rtps::RTPSWriter &writer)
{
    writer.remove_older_changes();
}

inline rtps::RTPSWriter *MakeWriter(rtps::RTPSParticipant &participant, rtps::WriterAttributes &attributes,
                                    const std::shared_ptr<rtps::IPayloadPool> &pool,
                                    rtps::WriterHistory &history, rtps::WriterListener &listener)
{
    return rtps::RTPSDomain::createRTPSWriter(&participant, attributes, pool, &history, &listener);
}

// The reader accepts only samples of matched writers, also of those that are addressed to no reader in
// particular.
inline rtps::RTPSReader *MakeReader(rtps::RTPSParticipant &participant, rtps::ReaderAttributes &attributes,
                                    const std::shared_ptr<rtps::IPayloadPool> &pool,
                                    rtps::ReaderHistory &history, rtps::ReaderListener &listener)
{
    rtps::RTPSReader *const reader =
        rtps::RTPSDomain::createRTPSReader(&participant, attributes, pool, &history, &listener);
    if (reader != nullptr)
    {
        reader->enableMessagesFromUnkownWriters(false);
    }
    return reader;
}

inline eprosima::fastrtps::TopicAttributes ToTopic(const TopicNames &names)
{
    eprosima::fastrtps::TopicAttributes topic(names.Topic.c_str(), names.Type.c_str(),
                                              names.HasKey ? rtps::WITH_KEY : rtps::NO_KEY);
    topic.auto_fill_type_object = false;
    topic.auto_fill_type_information = false;
    return topic;
}

inline bool Announce(rtps::RTPSParticipant &participant, rtps::RTPSWriter *writer, const TopicNames &names,
                     const dds::WriterQos &qos)
{
    return participant.registerWriter(writer, ToTopic(names), qos);
}

inline bool Announce(rtps::RTPSParticipant &participant, rtps::RTPSReader *reader, const TopicNames &names,
                     const dds::ReaderQos &qos)
{
    return participant.registerReader(reader, ToTopic(names), qos);
}

inline rtps::ReaderHistory &HistoryOf(rtps::RTPSReader &reader)
{
    return *reader.getHistory();
}

}  // namespace Rabit::FastDds
