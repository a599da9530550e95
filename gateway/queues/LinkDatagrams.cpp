#include "queues/LinkDatagrams.h"

namespace Rabit
{

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
    Datagram &datagram = Next(LinkTopic::Data, data.Destination);
    datagram.Queue.assign(data.Queue);
    datagram.Data = data;
    ++_used;
}

void LinkDatagrams::BindNames()
{
    for (std::size_t i = 0; i < _used; ++i)
    {
        _datagrams[i].Data.Destination = _datagrams[i].Destination;
        _datagrams[i].Data.Queue = _datagrams[i].Queue;
    }
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

}  // namespace Rabit
