// Included by Vendor.h, for Fast DDS 3.
#pragma once

namespace Rabit::FastDds
{

class ParticipantEvents : public rtps::RTPSParticipantListener
{
protected:
    virtual void OnParticipant(const ParticipantNews &news) = 0;
    virtual void OnEndpoint(const EndpointNews &news) = 0;

private:
    void on_participant_discovery(rtps::RTPSParticipant * /*participant*/,
                                  rtps::ParticipantDiscoveryStatus status,
                                  const rtps::ParticipantBuiltinTopicData &info, bool &ignore) override
    {
        using Status = rtps::ParticipantDiscoveryStatus;
        ignore = false;
        OnParticipant({.Change = status == Status::REMOVED_PARTICIPANT   ? ParticipantChange::Left
                                 : status == Status::DROPPED_PARTICIPANT ? ParticipantChange::Lost
                                                                         : ParticipantChange::Present,
                       .Prefix = info.guid.guidPrefix,
                       .Name = info.participant_name.to_string(),
                       .UserData = info.user_data.data_vec(),
                       .Discovery = info.metatraffic_locators,
                       .Samples = info.default_locators});
    }
    void on_reader_discovery(rtps::RTPSParticipant * /*participant*/, rtps::ReaderDiscoveryStatus status,
                             const rtps::SubscriptionBuiltinTopicData &info, bool &ignore) override
    {
        ignore = false;
        Tell(info, status == rtps::ReaderDiscoveryStatus::REMOVED_READER);
    }
    void on_writer_discovery(rtps::RTPSParticipant * /*participant*/, rtps::WriterDiscoveryStatus status,
                             const rtps::PublicationBuiltinTopicData &info, bool &ignore) override
    {
        ignore = false;
        Tell(info, status == rtps::WriterDiscoveryStatus::REMOVED_WRITER);
    }
    template <typename Info>
    void Tell(const Info &info, bool isRemoved)
    {
        OnEndpoint({.Guid = info.guid,
                    .IsWriter = std::is_same_v<Info, rtps::PublicationBuiltinTopicData>,
                    .IsRemoved = isRemoved,
                    .Topic = info.topic_name.to_string(),
                    .Type = info.type_name.to_string(),
                    .Reliability = info.reliability.kind,
                    .Durability = info.durability.kind,
                    .Partitions = info.partition.getNames(),
                    .HasDeadline = !info.deadline.period.is_infinite(),
                    .HasLiveliness = info.liveliness.kind != dds::AUTOMATIC_LIVELINESS_QOS ||
                                     !info.liveliness.lease_duration.is_infinite(),
                    .IsExclusive = info.ownership.kind == dds::EXCLUSIVE_OWNERSHIP_QOS});
    }
};

class ReaderEvents : public rtps::ReaderListener
{
protected:
    virtual void OnSample(rtps::RTPSReader &reader, const rtps::CacheChange_t &change) = 0;
    virtual void OnMatched(rtps::RTPSReader &reader, const rtps::MatchingInfo &info) = 0;

private:
    void on_new_cache_change_added(rtps::RTPSReader *reader, const rtps::CacheChange_t *const change) override
    {
        OnSample(*reader, *change);
    }
    void on_reader_matched(rtps::RTPSReader *reader, const rtps::MatchingInfo &info) override
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
    void on_writer_matched(rtps::RTPSWriter *writer, const rtps::MatchingInfo &info) override
    {
        OnMatched(*writer, info);
    }
    void on_writer_change_received_by_all(rtps::RTPSWriter * /*writer*/, rtps::CacheChange_t *change) override
    {
        OnReceivedByAll(*change);
    }
};

// A pool of payloads. The vendor does not copy a sample into the datagrams that it sends: it takes the
// payload out of the pool a second time, and returns it when the datagram is sent, maybe after the sample is
// gone.
class Buffers : public rtps::IPayloadPool
{
public:
    bool get_payload(std::uint32_t size, rtps::SerializedPayload_t &payload) final
    {
        if (!Take(size, payload))
        {
            return false;
        }
        payload.payload_owner = this;
        return true;
    }
    bool get_payload(const rtps::SerializedPayload_t &data, rtps::SerializedPayload_t &payload) final
    {
        if (data.payload_owner == this)
        {
            Share(data, payload);
        }
        else if (!TakeCopy(data, payload))
        {
            return false;
        }
        payload.payload_owner = this;
        return true;
    }
    bool release_payload(rtps::SerializedPayload_t &payload) final
    {
        if (IsLast(payload.data))
        {
            GiveBack(payload);
        }
        payload.data = nullptr;
        payload.max_size = 0;
        payload.length = 0;
        payload.pos = 0;
        payload.payload_owner = nullptr;
        return true;
    }
    // As with version 2.
    bool get_payload(std::uint32_t size, rtps::CacheChange_t &change)
    {
        return get_payload(size, change.serializedPayload);
    }
    bool release_payload(rtps::CacheChange_t &change) { return release_payload(change.serializedPayload); }

protected:
    virtual bool Take(std::uint32_t size, rtps::SerializedPayload_t &payload) = 0;
    virtual bool TakeCopy(const rtps::SerializedPayload_t &data, rtps::SerializedPayload_t &payload) = 0;
    virtual void GiveBack(rtps::SerializedPayload_t &payload) = 0;
    void Own(rtps::CacheChange_t &change) { change.serializedPayload.payload_owner = this; }

private:
    struct Shared
    {
        const rtps::octet *Data;
        std::size_t Others;  // payloads with this data, but for one
    };

    void Share(const rtps::SerializedPayload_t &data, rtps::SerializedPayload_t &payload)
    {
        payload.encapsulation = data.encapsulation;
        payload.data = data.data;
        payload.length = data.length;
        payload.max_size = data.max_size;
        payload.pos = data.pos;
        const std::lock_guard lock(_sharing);
        const auto found = std::ranges::find(_shared, data.data, &Shared::Data);
        if (found != _shared.end())
        {
            ++found->Others;
        }
        else
        {
            _shared.push_back({data.data, 1});
        }
    }
    // True if no other payload has the data. One fewer has it afterwards.
    bool IsLast(const rtps::octet *data)
    {
        const std::lock_guard lock(_sharing);
        const auto found = std::ranges::find(_shared, data, &Shared::Data);
        if (found == _shared.end())
        {
            return true;
        }
        if (--found->Others == 0)
        {
            *found = _shared.back();
            _shared.pop_back();
        }
        return false;
    }

    std::mutex _sharing;
    std::vector<Shared> _shared;  // guarded by _sharing
};

// A writer's history.
class SentHistory : public rtps::WriterHistory
{
public:
    SentHistory(const rtps::HistoryAttributes &attributes, const std::shared_ptr<rtps::IPayloadPool> &pool)
        : WriterHistory(attributes, pool)
    {
    }
    // A sample without a payload; nullptr if there is no room.
    static rtps::CacheChange_t *New(rtps::RTPSWriter & /*writer*/, rtps::WriterHistory &history,
                                    rtps::ChangeKind_t kind)
    {
        return history.create_change(kind);
    }
    static void Release(rtps::RTPSWriter & /*writer*/, rtps::WriterHistory &history,
                        rtps::CacheChange_t *change)
    {
        history.release_change(change);
    }
    iterator remove_change_nts(const_iterator removal, bool release = true) final
    {
        constexpr std::chrono::hours Patience{24};
        return remove_change_nts(removal, std::chrono::steady_clock::now() + Patience, release);
    }
    iterator remove_change_nts(const_iterator removal, const std::chrono::steady_clock::time_point &deadline,
                               bool release = true) final
    {
        if (removal != m_changes.end())
        {
            OnRemoval(**removal);
        }
        return WriterHistory::remove_change_nts(removal, deadline, release);
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

    // This version hands a datagram over in pieces.
    bool send(rtps::SenderResource *sender, const std::vector<rtps::NetworkBuffer> &pieces,
              std::uint32_t size, rtps::LocatorsIterator *begin, rtps::LocatorsIterator *end,
              const std::chrono::steady_clock::time_point &timeout) final
    {
        thread_local std::vector<std::uint8_t> datagram;
        datagram.clear();
        datagram.reserve(size);
        for (const rtps::NetworkBuffer &piece : pieces)
        {
            const auto *const bytes = static_cast<const std::uint8_t *>(piece.buffer);
            datagram.insert(datagram.end(), bytes, bytes + piece.size);
        }
        return Send(*sender, datagram, *begin, *end, timeout);
    }

    bool transform_remote_locator(const rtps::Locator_t &remote, rtps::Locator_t &result) const final
    {
        return MaySendTo(remote) && ChainingTransport::transform_remote_locator(remote, result);
    }
    bool transform_remote_locator(const rtps::Locator_t &remote, rtps::Locator_t &result,
                                  bool remoteTakesLocalhost, bool localhostAllowed) const final
    {
        return MaySendTo(remote) && ChainingTransport::transform_remote_locator(
                                        remote, result, remoteTakesLocalhost, localhostAllowed);
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
        const auto size = static_cast<std::uint32_t>(datagram.size());
        thread_local std::vector<rtps::NetworkBuffer> pieces(1);
        pieces.front() = rtps::NetworkBuffer(datagram.data(), size);
        return sender.send(pieces, size, &begin, &end, timeout);
    }
};

// A setting with which this version behaves as version 2 and Cyclone DDS do.
inline void AddProperties(rtps::PropertyPolicy &properties)
{
    // Its service of types has endpoints of its own in each participant. Nodes do not use it.
    properties.properties().emplace_back("fastdds.type_propagation", "disabled");
}

// The heartbeat period, the first heartbeat's delay, and the delays of repair.
inline auto TimesOf(rtps::WriterAttributes &attributes)
{
    auto &times = attributes.times;
    return std::tie(times.heartbeat_period, times.initial_heartbeat_delay, times.nack_response_delay,
                    times.nack_supression_duration);
}

// The delays of an answer to a heartbeat, and of the first acknowledgement.
inline auto TimesOf(rtps::ReaderAttributes &attributes)
{
    return std::tie(attributes.times.heartbeat_response_delay, attributes.times.initial_acknack_delay);
}

// See Vendor2.h. This version stops the timer before it frees samples.
inline void RemoveSamples(rtps::RTPSWriter & /*writer*/) {}

inline rtps::RTPSWriter *MakeWriter(rtps::RTPSParticipant &participant, rtps::WriterAttributes &attributes,
                                    const std::shared_ptr<rtps::IPayloadPool> & /*pool*/,
                                    rtps::WriterHistory &history, rtps::WriterListener &listener)
{
    return rtps::RTPSDomain::createRTPSWriter(&participant, attributes, &history, &listener);
}

// The reader accepts only samples of matched writers, also of those that are addressed to no reader in
// particular.
inline rtps::RTPSReader *MakeReader(rtps::RTPSParticipant &participant, rtps::ReaderAttributes &attributes,
                                    const std::shared_ptr<rtps::IPayloadPool> &pool,
                                    rtps::ReaderHistory &history, rtps::ReaderListener &listener)
{
    attributes.accept_messages_from_unkown_writers = false;
    return rtps::RTPSDomain::createRTPSReader(&participant, attributes, pool, &history, &listener);
}

inline rtps::TopicDescription ToTopic(const TopicNames &names)
{
    rtps::TopicDescription topic;
    topic.topic_name = names.Topic;
    topic.type_name = names.Type;
    return topic;
}

inline bool Announce(rtps::RTPSParticipant &participant, rtps::RTPSWriter *writer, const TopicNames &names,
                     const dds::WriterQos &qos)
{
    return participant.register_writer(writer, ToTopic(names), qos);
}

inline bool Announce(rtps::RTPSParticipant &participant, rtps::RTPSReader *reader, const TopicNames &names,
                     const dds::ReaderQos &qos)
{
    return participant.register_reader(reader, ToTopic(names), qos);
}

inline rtps::ReaderHistory &HistoryOf(rtps::RTPSReader &reader)
{
    return *reader.get_history();
}

}  // namespace Rabit::FastDds
