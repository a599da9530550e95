#include "queues/LinkDatagrams.h"

namespace Rabit
{

void LinkDatagrams::Add(const LinkFrame &frame)
{
    if (_used == _datagrams.size())
    {
        _datagrams.emplace_back();
    }
    Datagram &datagram = _datagrams[_used];
    datagram.Destination.assign(frame.Destination);
    datagram.Queue.assign(frame.HasData ? frame.Data.Queue : std::string_view());
    datagram.Frame = frame;
    ++_used;
}

void LinkDatagrams::BindNames()
{
    for (std::size_t i = 0; i < _used; ++i)
    {
        _datagrams[i].Frame.Destination = _datagrams[i].Destination;
        _datagrams[i].Frame.Data.Queue = _datagrams[i].Queue;
    }
}

void LinkDatagrams::Clear()
{
    for (std::size_t i = 0; i < _used; ++i)
    {
        _datagrams[i].Frame.Data.Items.clear();
    }
    _used = 0;
}

}  // namespace Rabit
