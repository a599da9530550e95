// AirTraffic: streams that ride in the datagram of another one.
#include <algorithm>
#include <cstddef>
#include <optional>

#include "manager/AirTraffic.h"

namespace Rabit
{
namespace
{

// A turn of the session, unless it sends each datagram by itself. The turn ends with this object.
class AirTurn
{
public:
    AirTurn(TransportSession &session, std::size_t mostBytes)
        : _session(session), _isOpen(session.BeginTurn(mostBytes))
    {
    }
    ~AirTurn()
    {
        if (_isOpen)
        {
            _session.EndTurn();
        }
    }
    AirTurn(const AirTurn &) = delete;
    AirTurn &operator=(const AirTurn &) = delete;

private:
    TransportSession &_session;
    const bool _isOpen;
};

}  // namespace

// Without a budget nothing rides: on a full channel, whose queues drop what does not fit, larger datagrams
// are lost more often. While this path is the second one of a node, copies of queue messages pass the
// schedule in the pauses between its datagrams. A datagram with riders has a longer pause behind it, so
// copies would find no room.
bool AirTraffic::IsMerging(Duration now) const
{
    return _config.Radio.Budget.has_value() && !_choice.IsSecondOfAny(_path, now);
}

void AirTraffic::SendTurn(StreamId id, Duration now)
{
    if (!_merges)
    {
        Send(id, std::nullopt, now);
        return;
    }
    const TrafficClass first = _schedule.ClassOf(id);
    const std::size_t most = _schedule.Budget().LargestDatagram();
    const AirTurn turn(*_session, most);
    const std::size_t bytes = Send(id, std::nullopt, now);
    const AirSchedule::Destinations to = TakeDestinations(id);
    if (to.Count > 0)
    {
        SendRiders(first, to, most - std::min(most, bytes / to.Count), now);
    }
}

// Each rider pays for what it adds, as if it had been chosen: its next turn counts from now. `room`: of each
// copy of the datagram.
void AirTraffic::SendRiders(TrafficClass first, const AirSchedule::Destinations &to, std::size_t room,
                            Duration now)
{
    while (const std::optional<StreamId> rider = _schedule.NextRider(first, to, room, now))
    {
        const std::size_t bytes = Send(*rider, room, now);
        if (TakeDestinations(*rider).Number != to.Number)
        {
            return;  // it had nothing to send, or goes elsewhere by itself
        }
        room -= std::min(room, (bytes + to.Count - 1) / to.Count);
    }
}

// The destinations of what was sent since the last call, all of it of that stream.
AirSchedule::Destinations AirTraffic::TakeDestinations(StreamId id)
{
    const TurnDestinations taken = _session->TakeTurnDestinations();
    const AirSchedule::Destinations to{.Number = taken.Number, .Count = taken.Count};
    _schedule.Went(id, to);
    return to;
}

// With a budget all samples wait for their turn, so the schedule knows the bytes of each stream.
AirReport::Sent AirTraffic::SentByStreams() const
{
    if (!_config.Radio.Budget)
    {
        return {.Foreign = _foreign.SentBytes()};
    }
    AirReport::Sent sent{.Foreign = _schedule.SentBytes(TrafficClass::Foreign)};
    for (const StreamId stream : _publisherStreams)
    {
        sent.Publications.push_back(_schedule.SentBytes(stream));
    }
    return sent;
}

}  // namespace Rabit
