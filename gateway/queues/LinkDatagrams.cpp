#include "queues/LinkDatagrams.h"

#include "gateway.idl.h"
#include "wire/GatewayTopics.h"
#include "wire/LinkDataCodec.h"
#include "wire/MessageEncoder.h"

namespace Rabit
{
namespace
{

// Lets the transport encode a LinkData straight into its own buffer.
class LinkDataEncoder final : public SampleEncoder
{
public:
    explicit LinkDataEncoder(const LinkData &data) : _data(data), _size(LinkDataCodec::EncodedSize(data)) {}

    std::size_t EncodedSize() const override { return _size; }
    bool Encode(std::span<std::uint8_t> buffer) const override
    {
        return LinkDataCodec::Encode(_data, buffer);
    }

private:
    const LinkData &_data;
    const std::size_t _size;
};

}  // namespace

LinkDatagrams::Datagram &LinkDatagrams::Next(LinkTopic topic, std::string_view destination)
{
    if (_used == _datagrams.size())
    {
        _datagrams.emplace_back();
    }
    Datagram &datagram = _datagrams[_used];
    datagram.Topic = topic;
    datagram.Destination.assign(destination);
    return datagram;
}

void LinkDatagrams::Add(const LinkData &data)
{
    Next(LinkTopic::Data, data.Destination).Data = data;
    ++_used;
}

void LinkDatagrams::Clear()
{
    for (std::size_t i = 0; i < _used; ++i)
    {
        _datagrams[i].Data.Items.clear();
    }
    _used = 0;
}

void LinkDatagrams::Add(LinkTopic topic, std::string_view destination, const MessageType &type,
                        const RabitMessage &sample)
{
    Datagram &datagram = Next(topic, destination);
    const std::size_t size = type.SerializedSize(sample);
    if (type.Serialize(sample, datagram.Buffer.Resize(size)) == size)
    {
        ++_used;
    }
}

TopicDescription DescribeLinkTopic(LinkTopic topic)
{
    switch (topic)
    {
        case LinkTopic::Data:
            return GatewayTopics::Describe(GatewayTopics::LinkData,
                                           GatewayTopics::TypeOf<Gateway::LinkDataSample>());
        case LinkTopic::Ack:
            return GatewayTopics::Describe(GatewayTopics::LinkAck,
                                           GatewayTopics::TypeOf<Gateway::LinkAckSample>());
        case LinkTopic::Hello:
            break;
    }
    return GatewayTopics::Describe(GatewayTopics::LinkHello,
                                   GatewayTopics::TypeOf<Gateway::LinkHelloSample>());
}

// The links do not rely on DDS's reliability, but its repair is the quicker one. A hello is soon followed by
// the next.
TopicQos LinkTopicQos(LinkTopic topic)
{
    TopicQos qos;
    qos.Reliability = topic == LinkTopic::Hello ? Reliability::BestEffort : Reliability::Reliable;
    qos.Durability = Durability::Volatile;
    qos.Depth = topic == LinkTopic::Data ? 256 : topic == LinkTopic::Ack ? 16 : 1;
    return qos;
}

void LinkWriters::Write(const LinkDatagrams::Datagram &datagram, std::int64_t sourceTime)
{
    std::unique_ptr<TransportWriter> &writer = _writers[{datagram.Topic, datagram.Destination}];
    if (!writer)
    {
        writer = _session.CreateWriter(DescribeLinkTopic(datagram.Topic), LinkTopicQos(datagram.Topic),
                                       {datagram.Destination});
    }
    const WriteResult result = datagram.Topic == LinkTopic::Data
                                   ? writer->Write(LinkDataEncoder(datagram.Data), sourceTime)
                                   : writer->Write(BytesEncoder(datagram.Buffer.Bytes()), sourceTime);
    static_cast<void>(result);
}

}  // namespace Rabit
