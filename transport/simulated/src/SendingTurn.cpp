// NetworkCore: the samples of a turn go in common packets.
#include <rabit/base/Fnv1a.h>

#include <algorithm>
#include <iterator>
#include <memory>
#include <utility>

#include "NetworkCore.h"

namespace Rabit::Simulated
{

namespace
{

// Headers that a sample lacks in the packet of another one: IPv4, UDP, RTPS.
constexpr std::uint64_t Headers = 20 + 8 + 20;

// The letters to the participant of the first one, of adjacent ones to each participant.
Letters::iterator EndOfFirst(Letters::iterator first, Letters::iterator last)
{
    return std::find_if(first, last, [to = first->To](const Letter &letter) { return letter.To != to; });
}

}  // namespace

bool NetworkCore::BeginTurn(ParticipantState &participant, std::size_t most)
{
    const std::lock_guard lock(_mutex);
    participant.Turn.IsOpen = true;
    participant.Turn.Most = most;
    participant.Turn.Taken = {};
    return true;
}

TurnDestinations NetworkCore::TakeTurnDestinations(ParticipantState &participant)
{
    const std::lock_guard lock(_mutex);
    return std::exchange(participant.Turn.Taken, {});
}

void NetworkCore::EndTurn(ParticipantState &participant)
{
    const std::lock_guard lock(_mutex);
    participant.Turn.IsOpen = false;
    if (participant.Gone)
    {
        participant.Turn.Packets.clear();
    }
    SendKept(participant);
}

// Letters of one sample of one packet.
void NetworkCore::Keep(ParticipantState &from, Letters letters, bool multicast)
{
    for (auto first = letters.begin(); first != letters.end();)
    {
        const auto last = multicast ? letters.end() : EndOfFirst(first, letters.end());
        const ParticipantId to = multicast ? Nobody : first->To;
        KeepPacket(from, to, Letters(std::make_move_iterator(first), std::make_move_iterator(last)));
        first = last;
    }
}

void NetworkCore::KeepPacket(ParticipantState &from, ParticipantId to, Letters letters)
{
    Turn &turn = from.Turn;
    turn.Taken.Number += Fnv1a().AddNumber(to).Sum();
    ++turn.Taken.Count;
    const Cost cost = CostOf(from, letters.front().Content);
    const std::uint64_t joined = cost.Bytes - Headers;
    const auto last = std::find_if(turn.Packets.rbegin(), turn.Packets.rend(),
                                   [to](const KeptPacket &packet) { return packet.To == to; });
    if (last == turn.Packets.rend() || last->Bytes + joined + MostOfSeal(from) > turn.Most)
    {
        turn.Packets.push_back({to, std::move(letters), cost.Bytes});
        Count(from, cost);
        return;
    }
    last->Bytes += joined;
    std::move(letters.begin(), letters.end(), std::back_inserter(last->Letters));
    from.Log->SentSamples(0, joined);
    _sent[from.NodeNumber].Bytes += joined;
}

void NetworkCore::SendKept(ParticipantState &from)
{
    Medium *const medium = _media.Of(from.NodeNumber);
    for (KeptPacket &packet : std::exchange(from.Turn.Packets, {}))
    {
        Letters &letters = packet.Letters;
        std::stable_sort(letters.begin(), letters.end(),
                         [](const Letter &a, const Letter &b) { return a.To < b.To; });
        const std::uint64_t added = SealLetters(from, letters.begin(), letters.end(), packet.To == Nobody);
        from.Log->SentSamples(0, added);
        _sent[from.NodeNumber].Bytes += added;
        packet.Bytes += added;
        if (medium != nullptr && medium->IsInTheWay())
        {
            const auto flight = std::make_shared<Flight>();
            flight->From = from.Id;
            flight->FromNode = from.NodeNumber;
            flight->Letters = std::move(letters);
            Offer(*medium, flight, {.Packets = 1, .Bytes = packet.Bytes});
            continue;
        }
        for (auto first = letters.begin(); first != letters.end();)
        {
            const auto last = EndOfFirst(first, letters.end());
            SendPacket(from, Letters(std::make_move_iterator(first), std::make_move_iterator(last)));
            first = last;
        }
    }
}

// Sends the letters to one participant, if no medium is in the way. All letters are lost, or none.
void NetworkCore::SendPacket(const ParticipantState &from, Letters letters)
{
    const auto target = _participants.find(letters.front().To);
    ++_traffic.Sent;
    if (target == _participants.end() || _faults.Loses(from.NodeNumber, target->second->NodeNumber, _random))
    {
        ++_traffic.Lost;
        return;
    }
    const SimulatedFaults &faults = _faults.Between(from.NodeNumber, target->second->NodeNumber);
    for (Letter &letter : letters)
    {
        Transmit(faults, from.Id, letter.To, std::move(letter.Content), letter.Processing);
    }
}

}  // namespace Rabit::Simulated
