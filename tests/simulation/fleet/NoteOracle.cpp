#include "NoteOracle.h"

#include <rabit/gateway/links/LinkOptions.h>

#include <algorithm>
#include <string>
#include <utility>

#include "wire/GatewayTopics.h"

namespace Rabit::Sim
{

namespace
{

// A clock that runs 500 ppm too fast sees the end of a silence this much earlier.
constexpr Time DriftTolerance = std::chrono::milliseconds(10);

// A larger note always goes in several parts.
constexpr std::uint32_t LargeFrom = 4000;

std::uint8_t FillerByte(std::uint64_t number, std::size_t position)
{
    return static_cast<std::uint8_t>((number + 1) * 31 + position * 7);
}

std::string Name(std::uint64_t note)
{
    return "note " + std::to_string(note);
}

}  // namespace

NoteOracle::NoteOracle(FleetWorld &world, const SimulatedNetwork &network,
                       std::function<Time(std::size_t life)> clockOf)
    : _world(world), _network(network), _clockOf(std::move(clockOf))
{
    if (world.Plan.Machines.size() > MostNodes)
    {
        world.Fail(0, "too many nodes in the plan");
    }
}

Note NoteOracle::Make(std::size_t life, std::size_t destination, SimRandom &random)
{
    Record record;
    record.Life = life;
    record.Destination = destination;
    record.EpochsThen = _epochs;
    const std::size_t source = _world.Lives[life].Node;
    for (std::size_t i = 0; i < _world.Plan.Machines.size(); ++i)
    {
        LinkState &link = _links[{source, i}];
        if (link.Life != life)
        {
            link = {.Life = life};
        }
        record.KnownThen[i] = link.KnownEpoch;
    }
    const double kind = random.Unit();
    const auto others = static_cast<std::int64_t>(_world.Plan.Machines.size()) - 1;
    const std::int64_t largest = _world.Plan.LargestNote / (destination == Burst::ToAll ? others : 1);
    const std::int64_t most = kind < 0.93 ? 40 : kind < 1 - LargeNotes ? 3000 : largest;
    record.Bytes = static_cast<std::uint32_t>(random.Between(0, most));

    Note note;
    note.number = _records.size();
    note.source = _world.NameOf(_world.Lives[life].Node);
    for (std::size_t i = 0; i < record.Bytes; ++i)
    {
        note.filler.push_back(FillerByte(note.number, i));
    }
    _records.push_back(std::move(record));
    return note;
}

// True if the note takes as many bytes on the air as a note of several parts. A note to all goes to each
// node separately.
bool NoteOracle::IsLarge(const Record &record) const
{
    const std::size_t receivers = record.Destination == Burst::ToAll ? _world.Plan.Machines.size() - 1 : 1;
    return receivers * record.Bytes > LargeFrom;
}

std::shared_ptr<RabitQueueReceipt> NoteOracle::MakeReceipt(std::uint64_t note)
{
    Record &record = _records[note];
    record.Receipt = std::make_shared<RabitQueueReceipt>();
    record.Receipt->ConnectOutcomeKnown([this, note] { OnOutcome(note); });
    return record.Receipt;
}

void NoteOracle::OnSent(std::uint64_t note, bool accepted, Time localNow)
{
    Record &record = _records[note];
    const std::size_t source = _world.Lives[record.Life].Node;
    record.SentAt = localNow;
    record.Accepted = accepted;
    _largePending[source] += IsLarge(record) && accepted && !record.Known ? 1 : 0;
    const QueueOutcome outcome = record.Receipt->Outcome();
    if (record.Destination == Burst::ToAll)
    {
        // True only if no node refused; even otherwise some may have accepted.
        _counts.SentToAll += 1;
        for (std::size_t i = 0; i < _world.Plan.Machines.size(); ++i)
        {
            _links[{source, i}].ExactlyKnown = false;
        }
        return;
    }
    LinkState &link = _links[{source, record.Destination}];
    const bool full = link.Pending >= RuleOf(source, record.Destination).Capacity;
    if (accepted == (outcome == QueueOutcome::Refused))
    {
        _world.Fail(3, Name(note) + " was " + (accepted ? "accepted" : "refused") +
                           " and its receipt says: " + ToString(outcome));
    }
    if (accepted)
    {
        ++_counts.Accepted;
        link.WasKnown = true;
        link.Pending += record.Known ? 0 : 1;
        if (full && link.ExactlyKnown)
        {
            _world.Fail(7, Name(note) + " was accepted by a full outbox");
        }
        return;
    }
    ++(full ? _counts.RefusedFull : _counts.RefusedUnknown);
    if (!full && link.WasKnown && link.ExactlyKnown)
    {
        _world.Fail(7, Name(note) + " was refused although the outbox was not full and the node known");
    }
}

void NoteOracle::OnOutcome(std::uint64_t note)
{
    Record &record = _records[note];
    if (record.Known)
    {
        _world.Fail(3, Name(note) + " has two outcomes");
        return;
    }
    record.Known = true;
    record.Outcome = record.Receipt->Outcome();
    if (_world.Lives[record.Life].Ended)
    {
        return;  // the process was killed; the simulation alone still hears of it
    }
    _lastOutcomeAt = _world.Now;
    const std::size_t source = _world.Lives[record.Life].Node;
    _largePending[source] -= IsLarge(record) && record.Accepted ? 1 : 0;
    if (record.Destination != Burst::ToAll && record.Accepted)
    {
        LinkState &link = _links[{source, record.Destination}];
        --link.Pending;
        if (record.Outcome == QueueOutcome::Delivered)
        {
            link.KnownEpoch = std::max(link.KnownEpoch, record.EpochsThen[record.Destination]);
        }
    }
    const RabitQueueReceipt::Counts counts = record.Receipt->GetCounts();
    _counts.Delivered += counts.Delivered;
    _counts.Expired += counts.Expired;
    _counts.InDoubt += counts.InDoubt;
    CheckOutcome(record, note);
}

// Checks what can be known now. That a delivered note did arrive is checked when its queue was emptied.
void NoteOracle::CheckOutcome(const Record &record, std::uint64_t note)
{
    const std::size_t source = _world.Lives[record.Life].Node;
    if (record.Destination == Burst::ToAll)
    {
        return;
    }
    const bool arrived = record.Arrivals[record.Destination] > 0;
    if (record.Outcome == QueueOutcome::Expired)
    {
        if (arrived)
        {
            _world.Fail(4, Name(note) + " is said to have expired and was delivered");
        }
        if (RuleOf(source, record.Destination).Expire.count() == 0 && !_world.Lives[record.Life].Leaving)
        {
            _world.Fail(4, Name(note) + " is said to have expired and never does");
        }
    }
    if (record.Outcome == QueueOutcome::Refused && (arrived || record.Accepted))
    {
        _world.Fail(4, Name(note) + " is said to be refused over there, where the queue takes all");
    }
    if (record.Outcome == QueueOutcome::InDoubt && !_world.Lives[record.Life].Leaving &&
        !_world.Plan.IncarnationsMayFall && !MayBeInDoubt(record, record.Destination))
    {
        if (!IsGivenUp(record))
        {
            _world.Fail(
                4, Name(note) + " is in doubt although nobody restarted and the receiver was not silent");
        }
        ++_counts.GivenUp;
    }
}

bool NoteOracle::IsGivenUp(const Record &record) const
{
    const std::size_t source = _world.Lives[record.Life].Node;
    const SendRule &rule = RuleOf(source, record.Destination);
    if (rule.Expire.count() == 0 || _clockOf(record.Life) - record.SentAt < rule.Expire)
    {
        return false;
    }
    const std::optional<Time> heardAt =
        _network.LastArrival(_world.NameOf(record.Destination), _world.NameOf(source), GatewayTopics::Link);
    return !heardAt || _world.Now - *heardAt >= LinkSettings().SilentAfter - DriftTolerance;
}

void NoteOracle::OnArrived(std::size_t life, const Note &note, bool redelivered, Time sourceNow)
{
    const std::size_t receiver = _world.Lives[life].Node;
    if (note.number >= _records.size())
    {
        _world.Fail(8, "a note that nobody sent");
        return;
    }
    Record &record = _records[note.number];
    const std::size_t source = _world.Lives[record.Life].Node;
    const std::string name = Name(note.number);
    bool same =
        note.source == _world.NameOf(source) && note.filler.size() == record.Bytes &&
        (record.Destination == receiver || (record.Destination == Burst::ToAll && source != receiver));
    for (std::size_t i = 0; same && i < record.Bytes; ++i)
    {
        same = note.filler[i] == FillerByte(note.number, i);
    }
    if (!same)
    {
        _world.Fail(8, name + " came with other contents, or to another node");
        return;
    }
    const SendRule &rule = RuleOf(source, receiver);
    Stream &stream = _streams[{source, receiver}];
    const std::uint32_t epoch = EpochOf(source, receiver);
    if (redelivered)
    {
        if (!rule.RedeliverInDoubt)
        {
            _world.Fail(1, name + " was redelivered on a link that did not opt in");
        }
        if (!_world.Plan.IncarnationsMayFall && !MayBeInDoubt(record, receiver))
        {
            _world.Fail(1, name + " was redelivered although nobody restarted");
        }
        if (!_world.Plan.IncarnationsMayFall)
        {
            if (stream.FlaggedEpoch == epoch && note.number < stream.NextFlagged)
            {
                _world.Fail(2, name + " was redelivered after a later one");
            }
            stream.FlaggedEpoch = epoch;
            stream.NextFlagged = note.number + 1;
        }
        _counts.DeliveredAgain += record.Arrivals[receiver] > 0 ? 1 : 0;
    }
    else if (record.Arrivals[receiver] > 0)
    {
        _world.Fail(1, name + " was delivered twice");
    }
    else if (note.number < stream.Next)
    {
        _world.Fail(2, name + " came after a later one");
    }
    if (record.Known && record.Destination != Burst::ToAll &&
        (record.Outcome == QueueOutcome::Expired || record.Outcome == QueueOutcome::Refused) &&
        !_world.Lives[record.Life].Ended)
    {
        _world.Fail(4, name + " was delivered although its outcome was: " + ToString(record.Outcome));
    }
    const Time age = sourceNow - record.SentAt;
    if (rule.Expire.count() > 0 && age > rule.Expire)
    {
        _world.Fail(5, name + " was delivered " + std::to_string((age - Time(rule.Expire)).count()) +
                           " ns after its expiry");
    }
    record.Arrivals[receiver] = static_cast<std::uint8_t>(std::min(record.Arrivals[receiver] + 1, 255));
    stream.Next = std::max(stream.Next, note.number + 1);
}

void NoteOracle::OnFleet(std::size_t life, const Gateway::Fleet &fleet)
{
    for (const Gateway::LinkStatus &link : fleet.links)
    {
        const std::uint64_t ended = link.delivered + link.expired + link.in_doubt + link.undeliverable;
        if (link.accepted != ended + link.outbox || link.undeliverable > 0)
        {
            _world.Fail(3, "the counters of " + _world.NameOf(_world.Lives[life].Node) + " for " + link.node +
                               " do not balance, or count what cannot be");
        }
    }
    for (const Gateway::InboundStatus &link : fleet.inbound)
    {
        if (link.undeliverable > 0)
        {
            _world.Fail(4, "notes of " + link.node + " were undeliverable");
        }
    }
}

void NoteOracle::OnLeft(std::size_t life)
{
    for (std::size_t i = 0; i < _records.size(); ++i)
    {
        const Record &record = _records[i];
        if (record.Life == life && record.Receipt && record.Receipt->Outcome() == QueueOutcome::Pending)
        {
            _world.Fail(3, Name(i) + " has no outcome at the end of its gateway");
        }
    }
}

std::size_t NoteOracle::Undrained(const std::vector<bool> &alive) const
{
    return static_cast<std::size_t>(
        std::count_if(_records.begin(), _records.end(),
                      [&](const Record &record)
                      {
                          return record.Accepted && !record.Known && !_world.Lives[record.Life].Ended &&
                                 (record.Destination == Burst::ToAll || alive[record.Destination]);
                      }));
}

void NoteOracle::CheckDelivered()
{
    for (std::size_t i = 0; i < _records.size(); ++i)
    {
        const Record &record = _records[i];
        if (!record.Receipt)
        {
            continue;
        }
        _counts.LargeDelivered += record.Bytes > LargeFrom ? record.Receipt->GetCounts().Delivered : 0;
        const auto arrived = std::count_if(record.Arrivals.begin(), record.Arrivals.end(),
                                           [](std::uint8_t times) { return times > 0; });
        if (record.Receipt->GetCounts().Delivered > arrived)
        {
            _world.Fail(4, Name(i) + " is said to be delivered and was not");
        }
    }
}

}  // namespace Rabit::Sim
