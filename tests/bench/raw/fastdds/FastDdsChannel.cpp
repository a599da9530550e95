// A plain Fast DDS program on the vendor's DDS layer, with a listener, written as its manual shows.
#include "../RawChannel.h"

#include "SampleType.h"

#include <fastdds/rtps/transport/UDPv4TransportDescriptor.h>
#include <fastdds/dds/domain/DomainParticipant.hpp>
#include <fastdds/dds/domain/DomainParticipantFactory.hpp>
#include <fastdds/dds/publisher/DataWriter.hpp>
#include <fastdds/dds/publisher/Publisher.hpp>
#include <fastdds/dds/subscriber/DataReader.hpp>
#include <fastdds/dds/subscriber/DataReaderListener.hpp>
#include <fastdds/dds/subscriber/SampleInfo.hpp>
#include <fastdds/dds/subscriber/Subscriber.hpp>
#include <fastdds/dds/topic/TypeSupport.hpp>

#include <atomic>
#include <stdexcept>
#include <utility>

namespace Rabit::Bench
{
namespace
{

namespace dds = eprosima::fastdds::dds;
using eprosima::fastdds::rtps::UDPv4TransportDescriptor;

constexpr std::uint32_t Milliseconds = 1000 * 1000;  // in the nanoseconds of the vendor's durations

template <typename T>
T *Check(T *made, const char *what)
{
    if (made == nullptr)
    {
        throw std::runtime_error(std::string("Fast DDS made no ") + what);
    }
    return made;
}

// The settings of transport/fastdds/src/ParticipantSettings.cpp.
dds::DomainParticipantQos ParticipantQos(const BenchOptions &options)
{
    constexpr std::uint32_t SocketBuffer = 4u << 20;
    auto udp = std::make_shared<UDPv4TransportDescriptor>();
    udp->sendBufferSize = SocketBuffer;
    udp->receiveBufferSize = SocketBuffer;
    udp->maxMessageSize = static_cast<std::uint32_t>(options.Datagram);
    udp->non_blocking_send = true;
    udp->interfaceWhiteList = {options.Interface};
    dds::DomainParticipantQos qos = dds::PARTICIPANT_QOS_DEFAULT;
    qos.transport().use_builtin_transports = false;
    qos.transport().user_transports.push_back(udp);
    auto &builtin = qos.wire_protocol().builtin;
    builtin.avoid_builtin_multicast = true;
    builtin.discovery_config.leaseDuration = {3, 0};
    builtin.discovery_config.leaseDuration_announcementperiod = {1, 0};
    builtin.discovery_config.initial_announcements.count = 5;
    builtin.discovery_config.initial_announcements.period = {0, 100 * Milliseconds};
    return qos;
}

// The QoS that writer and reader share.
template <typename Qos>
void Apply(Carriage how, Qos &qos)
{
    qos.reliability().kind =
        how == Carriage::Telemetry ? dds::BEST_EFFORT_RELIABILITY_QOS : dds::RELIABLE_RELIABILITY_QOS;
    qos.durability().kind =
        how == Carriage::State ? dds::TRANSIENT_LOCAL_DURABILITY_QOS : dds::VOLATILE_DURABILITY_QOS;
    qos.history().kind = how == Carriage::Queue ? dds::KEEP_ALL_HISTORY_QOS : dds::KEEP_LAST_HISTORY_QOS;
    qos.history().depth = 1;
    qos.endpoint().history_memory_policy = eprosima::fastrtps::rtps::PREALLOCATED_WITH_REALLOC_MEMORY_MODE;
    qos.data_sharing().off();
}

dds::DataWriterQos WriterQos(Carriage how)
{
    dds::DataWriterQos qos = dds::DATAWRITER_QOS_DEFAULT;
    Apply(how, qos);
    qos.reliability().max_blocking_time = {5, 0};
    qos.publish_mode().kind = dds::SYNCHRONOUS_PUBLISH_MODE;
    auto &times = qos.reliable_writer_qos().times;
    times.heartbeatPeriod = {0, 20 * Milliseconds};
    times.initialHeartbeatDelay = {0, 5 * Milliseconds};
    times.nackResponseDelay = {0, 1 * Milliseconds};
    times.nackSupressionDuration = {0, 0};
    return qos;
}

dds::DataReaderQos ReaderQos(const BenchOptions &options)
{
    dds::DataReaderQos qos = dds::DATAREADER_QOS_DEFAULT;
    Apply(options.How, qos);
    if (options.Role == "member")
    {
        // If several programs write the same topic, there is room for one sample of each.
        qos.history().depth = static_cast<std::int32_t>(options.Members);
    }
    auto &times = qos.reliable_reader_qos().times;
    times.heartbeatResponseDelay = {0, 1 * Milliseconds};
    times.initialAcknackDelay = {0, 10 * Milliseconds};
    return qos;
}

class FastDdsChannel final : public RawChannel, private dds::DataReaderListener
{
public:
    FastDdsChannel(const BenchOptions &options, const std::string &writes, const std::string &reads,
                   std::function<void()> onData)
        : _onData(std::move(onData)), _type(new SampleType(options.Payload))
    {
        auto *factory = dds::DomainParticipantFactory::get_instance();
        _participant = Check(
            factory->create_participant(static_cast<std::uint32_t>(options.Domain), ParticipantQos(options)),
            "participant");
        _type.register_type(_participant);
        const auto topic = [this](const std::string &name) {
            return Check(_participant->create_topic(name, _type.get_type_name(), dds::TOPIC_QOS_DEFAULT),
                         "topic");
        };
        auto *publisher = Check(_participant->create_publisher(dds::PUBLISHER_QOS_DEFAULT), "publisher");
        auto *subscriber = Check(_participant->create_subscriber(dds::SUBSCRIBER_QOS_DEFAULT), "subscriber");
        dds::Topic *written = topic(writes);
        dds::Topic *read = reads == writes ? written : topic(reads);
        _writer = Check(publisher->create_datawriter(written, WriterQos(options.How)), "writer");
        // No sample may come before the reader is known.
        _reader = Check(subscriber->create_datareader(read, ReaderQos(options)), "reader");
        _reader->set_listener(this, dds::StatusMask::data_available());
    }

    ~FastDdsChannel() override
    {
        _participant->delete_contained_entities();
        dds::DomainParticipantFactory::get_instance()->delete_participant(_participant);
    }

    bool Write(const RawSample &sample) override { return _writer->write(const_cast<RawSample *>(&sample)); }

    void Take(const std::function<void(const RawSample &)> &handler) override
    {
        dds::SampleInfo info;
        while (_reader->take_next_sample(&_taken, &info) ==
               eprosima::fastrtps::types::ReturnCode_t::RETCODE_OK)
        {
            if (info.valid_data)
            {
                handler({_taken.Number, _taken.SentAt, _taken.Padding});
            }
        }
    }

    bool IsMatched() const override
    {
        dds::PublicationMatchedStatus published;
        dds::SubscriptionMatchedStatus subscribed;
        _writer->get_publication_matched_status(published);
        _reader->get_subscription_matched_status(subscribed);
        return published.current_count > 0 && subscribed.current_count > 0;
    }

    void WaitForAcknowledgements() override
    {
        if (_writer->wait_for_acknowledgments({60, 0}) != eprosima::fastrtps::types::ReturnCode_t::RETCODE_OK)
        {
            throw std::runtime_error("not acknowledged within 60 s");
        }
    }

private:
    void on_data_available(dds::DataReader *) override { _onData(); }

    const std::function<void()> _onData;
    dds::TypeSupport _type;
    TakenSample _taken;
    dds::DomainParticipant *_participant = nullptr;
    dds::DataWriter *_writer = nullptr;
    dds::DataReader *_reader = nullptr;
};

}  // namespace

std::unique_ptr<RawChannel> OpenRawChannel(const BenchOptions &options, const std::string &writes,
                                           const std::string &reads, std::function<void()> onData)
{
    return std::make_unique<FastDdsChannel>(options, writes, reads, std::move(onData));
}

}  // namespace Rabit::Bench
