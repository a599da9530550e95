#include "AirMedium.h"

#include <utility>

namespace Rabit::Sim
{

bool AirMedium::Offer(AirPacket packet, Time now)
{
    Queue &queue = _queues.at(packet.From);
    if (queue.Bytes + packet.Bytes > QueueBytes)
    {
        return false;
    }
    queue.Bytes += packet.Bytes;
    queue.Packets.push_back(std::move(packet));
    if (!_air)
    {
        Begin(now);
    }
    return true;
}

void AirMedium::Begin(Time now)
{
    for (std::size_t i = 0; i < _queues.size(); ++i)
    {
        _turn = (_turn + 1) % _queues.size();
        Queue &queue = _queues[_turn];
        if (!queue.Packets.empty())
        {
            _air = std::move(queue.Packets.front());
            queue.Packets.pop_front();
            queue.Bytes -= _air->Bytes;
            _began = now;
            _ends =
                now + Time(static_cast<Time::rep>(static_cast<double>(_air->Bytes) * 8e9 / _bitsPerSecond));
            return;
        }
    }
}

std::optional<Time> AirMedium::NextArrival() const
{
    return _air ? std::optional(_ends) : std::nullopt;
}

AirPacket AirMedium::Arrive(Time now)
{
    AirPacket packet = std::move(*_air);
    _air.reset();
    Begin(now);
    return packet;
}

}  // namespace Rabit::Sim
