// NetworkCore: transmission of datagrams over a shared medium.
#include <algorithm>
#include <memory>
#include <utility>

#include "NetworkCore.h"

namespace Rabit::Simulated
{

namespace
{

// Calls `call` once for each participant that the flight is for.
template <typename Call>
void ForEachReceiver(const Flight &flight, const Call &call)
{
    ParticipantId last = Nobody;
    for (const Letter &letter : flight.Letters)
    {
        if (std::exchange(last, letter.To) != letter.To)
        {
            call(letter.To);
        }
    }
}

}  // namespace

void NetworkCore::Offer(Medium &medium, const std::shared_ptr<Flight> &flight, const Cost &cost)
{
    flight->Waiting = cost.Packets;
    for (std::uint32_t i = 0; i < cost.Packets; ++i)
    {
        ForEachReceiver(*flight, [&](ParticipantId) { ++_traffic.Sent; });
        const bool isFree = !medium.Passes();
        if (!medium.Offer({flight->FromNode, cost.Bytes, flight, {}}, _now))
        {
            ForEachReceiver(*flight, [&](ParticipantId to) { ++flight->Lost[to], ++_traffic.Lost; });
            --flight->Waiting;
        }
        else if (isFree)
        {
            AwaitPassage(medium);
        }
    }
    if (flight->Waiting == 0)
    {
        Land(*flight);
    }
}

void NetworkCore::AwaitPassage(const Medium &medium)
{
    Event event;
    event.What = Event::Kind::Passage;
    event.At = static_cast<std::uint32_t>(_media.NumberOf(medium));
    Later(*medium.Passes() - _now, std::move(event));
}

// The packet on the air has passed the medium.
void NetworkCore::OnPassage(Medium &medium)
{
    const std::shared_ptr<Flight> flight = medium.Pass(_now).Content;
    if (medium.Passes())
    {
        AwaitPassage(medium);
    }
    ForEachReceiver(*flight,
                    [&](ParticipantId to)
                    {
                        const auto target = _participants.find(to);
                        if (target == _participants.end())
                        {
                            ++flight->Lost[to], ++_traffic.Lost;
                            return;
                        }
                        if (_faults.Loses(flight->FromNode, target->second->NodeNumber, _random))
                        {
                            ++flight->Lost[to], ++_traffic.Lost;
                        }
                    });
    if (--flight->Waiting == 0)
    {
        Land(*flight);
    }
}

// All packets of the flight have passed, or have been lost.
void NetworkCore::Land(Flight &flight)
{
    const auto from = _participants.find(flight.From);
    for (Letter &letter : flight.Letters)
    {
        const auto lost = flight.Lost.find(letter.To);
        if (from != _participants.end())
        {
            NoteFragments(*from->second, letter.Content, lost == flight.Lost.end() ? 0 : lost->second);
        }
        if (lost == flight.Lost.end() && letter.To != Nobody)
        {
            const SimulatedFaults &faults =
                _faults.Between(flight.FromNode, _participants.at(letter.To)->NodeNumber);
            Transmit(faults, flight.From, letter.To, std::move(letter.Content), letter.Processing);
        }
    }
}

}  // namespace Rabit::Simulated
