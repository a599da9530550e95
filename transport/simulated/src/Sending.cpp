// NetworkCore: datagrams leave a participant.
#include <algorithm>
#include <iterator>
#include <memory>
#include <utility>

#include "NetworkCore.h"

namespace Rabit::Simulated
{

void NetworkCore::Send(const ParticipantState &from, ParticipantId to, Datagram datagram, Time processing)
{
    Letters letters;
    letters.push_back({to, std::move(datagram), processing});
    SendTogether(from, std::move(letters), false);
}

// To a multicast group, if the participant uses one. A datagram to the group takes its time on the air even
// if nobody is in the group.
void NetworkCore::SendToGroup(const ParticipantState &from, Letters letters, const Datagram &content)
{
    if (letters.empty() && from.Settings.Multicast)
    {
        letters.push_back({Nobody, content, _timings.DiscoveryDelay});
    }
    SendTogether(from, std::move(letters), from.Settings.Multicast);
}

// With multicast as one datagram, otherwise as one for each participant.
void NetworkCore::SendTogether(const ParticipantState &from, Letters letters, bool multicast,
                               std::uint32_t partsBefore)
{
    Medium *medium = _media.Of(from.NodeNumber);
    for (auto first = letters.begin(); first != letters.end();)
    {
        const auto isElsewhere = [&](const Letter &letter) { return letter.To != first->To; };
        const auto last = multicast ? letters.end() : std::find_if(first, letters.end(), isElsewhere);
        Cost cost;
        for (auto letter = first; letter != last; ++letter)
        {
            const Cost ofThis = CostOf(from, letter->Content);
            cost =
                letter == first || ofThis.Packets * ofThis.Bytes > cost.Packets * cost.Bytes ? ofThis : cost;
        }
        cost.Packets -= std::min(cost.Packets, partsBefore);
        cost.Bytes += SealLetters(from, first, last, multicast);
        Count(from, cost);
        if (medium != nullptr && medium->IsInTheWay())
        {
            const auto flight = std::make_shared<Flight>();
            flight->From = from.Id;
            flight->FromNode = from.NodeNumber;
            flight->Letters.assign(std::make_move_iterator(first), std::make_move_iterator(last));
            Offer(*medium, flight, cost);
        }
        else
        {
            std::for_each(first, last, [&](Letter &letter) { SendAlone(from, std::move(letter)); });
        }
        first = last;
    }
}

// Used if no medium is in the way.
void NetworkCore::SendAlone(const ParticipantState &from, Letter letter)
{
    if (letter.To == Nobody)
    {
        return;
    }
    const auto target = _participants.find(letter.To);
    std::uint32_t *missing = MissingOf(from, letter.Content);
    const std::uint32_t packets = missing != nullptr ? *missing : 1;
    _traffic.Sent += packets;
    if (target == _participants.end())
    {
        _traffic.Lost += packets;
        return;
    }
    std::uint32_t lost = 0;
    for (std::uint32_t i = 0; i < packets; ++i)
    {
        lost += _faults.Loses(from.NodeNumber, target->second->NodeNumber, _random) ? 1 : 0;
    }
    _traffic.Lost += lost;
    NoteFragments(from, letter.Content, lost);
    if (lost == 0)
    {
        Transmit(_faults.Between(from.NodeNumber, target->second->NodeNumber), from.Id, letter.To,
                 std::move(letter.Content), letter.Processing);
    }
}

// Transmits a datagram that is not lost.
void NetworkCore::Transmit(const SimulatedFaults &faults, ParticipantId from, ParticipantId to,
                           Datagram datagram, Time processing)
{
    const auto delay = [&]
    {
        Time time = processing + faults.Delay + _random.PartOf(faults.Jitter);
        if (_random.Happens(faults.Straggle))
        {
            time += _random.PartOf(faults.StraggleDelay);
        }
        return time;
    };
    if (_random.Happens(faults.Duplicate))
    {
        ++_traffic.Duplicated;
        Later(delay(), {Event::Kind::Arrival, to, from, 0, datagram});
    }
    Later(delay(), {Event::Kind::Arrival, to, from, 0, std::move(datagram)});
}

}  // namespace Rabit::Simulated
