#include "queues/LinkDatagrams.h"

namespace Rabit
{

void LinkDatagrams::Add(const LinkFrame &frame, std::string_view queue)
{
    if (_used == _datagrams.size())
    {
        _datagrams.emplace_back();
    }
    Datagram &datagram = _datagrams[_used];
    datagram.Destination.assign(frame.Destination);
    datagram.Queue.assign(queue);
    datagram.Frame = frame;
    ++_used;
}

void LinkDatagrams::BindNames()
{
    for (std::size_t i = 0; i < _used; ++i)
    {
        _datagrams[i].Frame.Destination = _datagrams[i].Destination;
        if (!_datagrams[i].Frame.Data.Queue.empty())  // it is left out once the other end knows the link
        {
            _datagrams[i].Frame.Data.Queue = _datagrams[i].Queue;
        }
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
