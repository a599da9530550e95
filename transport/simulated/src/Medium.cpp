#include "Medium.h"

#include <algorithm>
#include <utility>

namespace Rabit::Simulated
{

bool Medium::Offer(Packet packet, std::chrono::nanoseconds now)
{
    packet.At = now;
    packet.Bytes += _settings.Overhead;
    if (!_onAir)
    {
        Begin(std::move(packet), now);
        return true;
    }
    Queue &queue = _queues[packet.Node];
    if (queue.Bytes + packet.Bytes > _settings.QueueBytes)
    {
        ++_air.Dropped;
        _air.DroppedBytes += packet.Bytes;
        if (queue.Packets.empty())
        {
            _queues.erase(packet.Node);
        }
        return false;
    }
    queue.Bytes += packet.Bytes;
    queue.Packets.push_back(std::move(packet));
    return true;
}

// The packet keeps the present rate.
void Medium::Begin(Packet packet, std::chrono::nanoseconds now)
{
    _air.LongestWait = std::max(_air.LongestWait, now - packet.At);
    const std::uint64_t rate = _settings.BytesPerSecond;
    _passes = now + std::chrono::nanoseconds(rate == 0 ? 0 : packet.Bytes * 1'000'000'000 / rate);
    _onAir = std::move(packet);
}

std::optional<std::chrono::nanoseconds> Medium::Passes() const
{
    return _onAir ? std::optional(_passes) : std::nullopt;
}

Packet Medium::Pass(std::chrono::nanoseconds now)
{
    Packet passed = std::move(*_onAir);
    _onAir.reset();
    ++_air.Carried;
    _air.CarriedBytes += passed.Bytes;
    if (!_queues.empty())
    {
        const auto after = _queues.upper_bound(passed.Node);
        const auto turn = after == _queues.end() ? _queues.begin() : after;
        Queue &queue = turn->second;
        Packet next = std::move(queue.Packets.front());
        queue.Packets.pop_front();
        queue.Bytes -= next.Bytes;
        if (queue.Packets.empty())
        {
            _queues.erase(turn);
        }
        Begin(std::move(next), now);
    }
    return passed;
}

std::uint64_t Medium::WaitingBytes(std::uint32_t node) const
{
    const auto queue = _queues.find(node);
    return queue == _queues.end() ? 0 : queue->second.Bytes;
}

}  // namespace Rabit::Simulated
