// The same with Fast DDS and its dynamic types; see plain_cyclone.c.
#include <fastrtps/types/DynamicDataFactory.h>
#include <fastrtps/types/DynamicDataPtr.h>
#include <fastrtps/types/DynamicPubSubType.h>
#include <fastrtps/types/DynamicTypeBuilderFactory.h>
#include <fastrtps/types/DynamicTypeBuilderPtr.h>
#include <fastdds/dds/domain/DomainParticipant.hpp>
#include <fastdds/dds/domain/DomainParticipantFactory.hpp>
#include <fastdds/dds/publisher/DataWriter.hpp>
#include <fastdds/dds/publisher/Publisher.hpp>
#include <fastdds/dds/subscriber/DataReader.hpp>
#include <fastdds/dds/subscriber/SampleInfo.hpp>
#include <fastdds/dds/subscriber/Subscriber.hpp>
#include <fastdds/dds/topic/Topic.hpp>

#include <chrono>
#include <csignal>
#include <cstdlib>
#include <iostream>
#include <sstream>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

namespace
{

namespace dds = eprosima::fastdds::dds;
namespace types = eprosima::fastrtps::types;

volatile std::sig_atomic_t ended = 0;

types::DynamicType_ptr StringType()
{
    auto *factory = types::DynamicTypeBuilderFactory::get_instance();
    types::DynamicTypeBuilder_ptr type = factory->create_struct_builder();
    type->add_member(0, "data", factory->create_string_type());
    type->set_name("std_msgs::msg::dds_::String_");
    return type->build();
}

types::DynamicType_ptr SetpointType()
{
    auto *factory = types::DynamicTypeBuilderFactory::get_instance();
    types::DynamicTypeBuilder_ptr type = factory->create_struct_builder();
    const std::vector<std::uint32_t> three{3};
    type->add_member(0, "timestamp", factory->create_uint64_type());
    types::MemberId id = 1;
    for (const char *name : {"position", "velocity", "acceleration", "jerk"})
    {
        type->add_member(id++, name, factory->create_array_builder(factory->create_float32_type(), three));
    }
    type->add_member(id++, "yaw", factory->create_float32_type());
    type->add_member(id++, "yawspeed", factory->create_float32_type());
    type->set_name("px4_msgs::msg::dds_::TrajectorySetpoint_");
    return type->build();
}

struct Endpoint
{
    std::string Topic;
    bool IsSetpoint = false;
    types::DynamicData_ptr Data;
    dds::DataWriter *Writer = nullptr;
    dds::DataReader *Reader = nullptr;
};

Endpoint Open(dds::DomainParticipant &participant, dds::Publisher &publisher, dds::Subscriber &subscriber,
              const std::string &description)
{
    std::istringstream words(description);
    std::string way;
    std::string type;
    std::string reliability;
    std::string durability;
    Endpoint endpoint;
    for (std::string *word : {&way, &endpoint.Topic, &type, &reliability, &durability})
    {
        if (!std::getline(words, *word, ':'))
        {
            throw std::runtime_error("not enough of a topic: " + description);
        }
    }
    endpoint.IsSetpoint = type == "setpoint";
    const types::DynamicType_ptr dynamic = endpoint.IsSetpoint ? SetpointType() : StringType();
    endpoint.Data = types::DynamicDataFactory::get_instance()->create_data(dynamic);
    dds::TypeSupport support(new types::DynamicPubSubType(dynamic));
    support.register_type(&participant);
    dds::Topic *topic =
        participant.create_topic(endpoint.Topic, support.get_type_name(), dds::TOPIC_QOS_DEFAULT);
    const auto set = [&](auto &qos)
    {
        qos.reliability().kind =
            reliability == "reliable" ? dds::RELIABLE_RELIABILITY_QOS : dds::BEST_EFFORT_RELIABILITY_QOS;
        qos.durability().kind = durability == "transient_local" ? dds::TRANSIENT_LOCAL_DURABILITY_QOS
                                                                : dds::VOLATILE_DURABILITY_QOS;
        qos.history().kind = dds::KEEP_LAST_HISTORY_QOS;
        qos.history().depth = 10;
    };
    if (way == "write")
    {
        dds::DataWriterQos qos;
        set(qos);
        endpoint.Writer = publisher.create_datawriter(topic, qos);
    }
    else
    {
        dds::DataReaderQos qos;
        set(qos);
        endpoint.Reader = subscriber.create_datareader(topic, qos);
    }
    if (endpoint.Writer == nullptr && endpoint.Reader == nullptr)
    {
        throw std::runtime_error("cannot make an endpoint of " + description);
    }
    return endpoint;
}

void Write(Endpoint &endpoint, unsigned long number)
{
    if (endpoint.IsSetpoint)
    {
        endpoint.Data->set_uint64_value(number, 0);
        types::DynamicData *position = endpoint.Data->loan_value(1);
        position->set_float32_value(-5.0F, 2);
        endpoint.Data->return_loaned_value(position);
    }
    else
    {
        endpoint.Data->set_string_value(std::to_string(number), 0);
    }
    endpoint.Writer->write(endpoint.Data.get());
}

void Read(Endpoint &endpoint)
{
    dds::SampleInfo info;
    while (endpoint.Reader->take_next_sample(endpoint.Data.get(), &info) ==
           eprosima::fastrtps::types::ReturnCode_t::RETCODE_OK)
    {
        if (!info.valid_data)
        {
            continue;
        }
        std::cout << "got " << endpoint.Topic << ' ';
        if (endpoint.IsSetpoint)
        {
            types::DynamicData *position = endpoint.Data->loan_value(1);
            std::cout << endpoint.Data->get_uint64_value(0) << ' ' << position->get_float32_value(2)
                      << std::endl;
            endpoint.Data->return_loaned_value(position);
        }
        else
        {
            std::cout << endpoint.Data->get_string_value(0) << std::endl;
        }
    }
}

void Run(int argc, char **argv)
{
    dds::DomainParticipantQos qos;
    // The other program of a test may share the network namespace without sharing the process.
    qos.transport().use_builtin_transports = true;
    // Only its goodbye tells that the program has ended.
    qos.wire_protocol().builtin.discovery_config.leaseDuration = eprosima::fastrtps::Duration_t{3600, 0};
    dds::DomainParticipant *participant = dds::DomainParticipantFactory::get_instance()->create_participant(
        static_cast<dds::DomainId_t>(std::atoi(argv[1])), qos);
    dds::Publisher *publisher = participant->create_publisher(dds::PUBLISHER_QOS_DEFAULT);
    dds::Subscriber *subscriber = participant->create_subscriber(dds::SUBSCRIBER_QOS_DEFAULT);
    std::vector<Endpoint> endpoints;
    for (int i = 2; i < argc; ++i)
    {
        endpoints.push_back(Open(*participant, *publisher, *subscriber, argv[i]));
    }
    std::cout << "ready" << std::endl;
    for (unsigned long number = 1; ended == 0; ++number)
    {
        for (Endpoint &endpoint : endpoints)
        {
            if (endpoint.Writer != nullptr)
            {
                Write(endpoint, number);
            }
            else
            {
                Read(endpoint);
            }
        }
        std::this_thread::sleep_for(std::chrono::milliseconds(50));
    }
    participant->delete_contained_entities();
    dds::DomainParticipantFactory::get_instance()->delete_participant(participant);
}

}  // namespace

int main(int argc, char **argv)
{
    if (argc < 3)
    {
        std::cerr << "usage: plain_fastdds DOMAIN write|read:TOPIC:TYPE:RELIABILITY:DURABILITY...\n";
        return 2;
    }
    std::signal(SIGTERM, [](int) { ended = 1; });
    try
    {
        Run(argc, argv);
        return 0;
    }
    catch (const std::exception &error)
    {
        std::cerr << "plain_fastdds: " << error.what() << '\n';
        return 1;
    }
}
