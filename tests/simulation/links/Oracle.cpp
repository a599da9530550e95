#include "Oracle.h"

#include <algorithm>
#include <cstring>
#include <sstream>

namespace Rabit::Sim
{

namespace
{

// The payload begins with the number of its record; the other bytes follow from that number.
constexpr std::size_t HeaderBytes = 8;

std::uint8_t ByteAt(std::uint64_t number, std::size_t position)
{
    return static_cast<std::uint8_t>((number + 1) * 31 + position * 7);
}

}  // namespace

Oracle::Oracle(const Scenario &scenario)
    : _scenario(scenario),
      _lifeOf(scenario.Nodes.size(), NoLife),
      _nodeEpoch(scenario.Nodes.size(), 0),
      _pairEpoch(scenario.Nodes.size(), std::vector<std::uint32_t>(scenario.Nodes.size(), 0)),
      _knownEpoch(scenario.Nodes.size(), std::vector<std::uint32_t>(scenario.Nodes.size(), 0)),
      _heardAt(scenario.Nodes.size(), std::vector<LinkTime>(scenario.Nodes.size(), LinkTime(0))),
      _links(scenario.Links.size()),
      _linkIndex(scenario.Nodes.size() * scenario.Nodes.size() * scenario.Queues.size(),
                 scenario.Links.size())
{
    for (std::size_t i = 0; i < scenario.Links.size(); ++i)
    {
        const ScenarioLink &link = scenario.Links[i];
        _linkIndex[(link.Source * scenario.Nodes.size() + link.Destination) * scenario.Queues.size() +
                   link.Queue] = i;
    }
}

std::size_t Oracle::FindNode(std::string_view name) const
{
    for (std::size_t i = 0; i < _scenario.Nodes.size(); ++i)
    {
        if (_scenario.Nodes[i].Name == name)
        {
            return i;
        }
    }
    return _scenario.Nodes.size();
}

std::size_t Oracle::FindLink(std::size_t source, std::size_t destination, std::string_view queue) const
{
    for (std::size_t q = 0; q < _scenario.Queues.size(); ++q)
    {
        if (_scenario.Queues[q].Name == queue && source < _scenario.Nodes.size() &&
            destination < _scenario.Nodes.size())
        {
            return _linkIndex[(source * _scenario.Nodes.size() + destination) * _scenario.Queues.size() + q];
        }
    }
    return _links.size();
}

std::uint32_t Oracle::EpochOf(std::size_t link) const
{
    const ScenarioLink &scenario = _scenario.Links[link];
    return EpochTo(scenario.Source, scenario.Destination) + EpochTo(scenario.Destination, scenario.Source);
}

void Oracle::Fail(int invariant, const std::string &what)
{
    if (_failure.empty())
    {
        _failure = "invariant " + std::to_string(invariant) + ": " + what;
    }
}

std::size_t Oracle::StartLife(std::size_t node)
{
    _lives.push_back({node, {}});
    _lifeOf[node] = _lives.size() - 1;
    _knownEpoch[node].assign(_scenario.Nodes.size(), 0);
    return _lives.size() - 1;
}

void Oracle::NewEpoch(std::size_t node)
{
    ++_nodeEpoch[node];
}

void Oracle::Forgets(std::size_t node, std::size_t peer)
{
    ++_pairEpoch[node][peer];
    _knownEpoch[node][peer] = 0;
}

std::vector<std::uint8_t> Oracle::MakePayload(SimRandom &random) const
{
    const std::uint64_t number = _records.size();
    const double kind = random.Unit();
    const std::int64_t more = kind < 0.95    ? random.Between(0, 40)
                              : kind < 0.998 ? random.Between(0, 3000)
                                             : random.Between(0, 30000);
    std::vector<std::uint8_t> payload(HeaderBytes + static_cast<std::size_t>(more));
    std::memcpy(payload.data(), &number, HeaderBytes);
    for (std::size_t i = HeaderBytes; i < payload.size(); ++i)
    {
        payload[i] = ByteAt(number, i);
    }
    return payload;
}

void Oracle::OnEnqueue(std::size_t link, std::string_view type, std::span<const std::uint8_t> payload,
                       LinkRefusal refusal, std::uint64_t id, LinkTime senderNow)
{
    const ScenarioLink &scenario = _scenario.Links[link];
    const LinkOptions &options = scenario.Options;
    LinkState &state = _links[link];
    const std::size_t life = _lifeOf[scenario.Source];
    if (state.Life != life)
    {
        state.Life = life;
        state.Pending = 0;
        state.PendingBytes = 0;
    }
    const LinkRefusal expected = payload.size() > options.CapacityBytes ? LinkRefusal::TooLarge
                                 : state.Pending >= options.Capacity    ? LinkRefusal::FullByCount
                                 : state.PendingBytes + payload.size() > options.CapacityBytes
                                     ? LinkRefusal::FullByBytes
                                     : LinkRefusal::None;
    if (refusal != expected)
    {
        Fail(7, "enqueue said '" + std::string(ToString(refusal)) + "' where '" +
                    std::string(ToString(expected)) + "' is right");
    }
    if (refusal != LinkRefusal::None)
    {
        ++_refused;
        if (id != 0)
        {
            Fail(7, "a refused message has an id");
        }
        return;
    }
    if (id != _lives[life].RecordOfId.size() + 1)
    {
        Fail(3, "ids do not rise by one");
    }
    _lives[life].RecordOfId.push_back(_records.size());
    _records.push_back({.Link = link,
                        .Life = life,
                        .EnqueuedAt = senderNow,
                        .Bytes = payload.size(),
                        .Type = type,
                        .Epoch = EpochTo(scenario.Source, scenario.Destination) +
                                 _knownEpoch[scenario.Source][scenario.Destination]});
    ++state.Pending;
    state.PendingBytes += payload.size();
    _acceptedBytes += payload.size();
}

Record *Oracle::Find(std::size_t receiver, std::string_view source, std::string_view queue,
                     std::string_view type, std::span<const std::uint8_t> payload)
{
    std::uint64_t number = 0;
    if (payload.size() >= HeaderBytes)
    {
        std::memcpy(&number, payload.data(), HeaderBytes);
    }
    if (payload.size() < HeaderBytes || number >= _records.size())
    {
        Fail(8, "a message that nobody sent");
        return nullptr;
    }
    Record &record = _records[number];
    bool same = payload.size() == record.Bytes && type == record.Type;
    for (std::size_t i = HeaderBytes; same && i < payload.size(); ++i)
    {
        same = payload[i] == ByteAt(number, i);
    }
    if (!same)
    {
        Fail(8, "message " + std::to_string(number) + " came with another payload or type");
    }
    if (record.Link != FindLink(FindNode(source), receiver, queue))
    {
        Fail(8, "message " + std::to_string(number) + " came out of another link");
    }
    return &record;
}

void Oracle::OnDelivered(const Record &constRecord, bool redelivered, LinkTime senderNow)
{
    const std::size_t number = IndexOf(constRecord);
    Record &record = _records[number];
    const ScenarioLink &link = _scenario.Links[record.Link];
    LinkState &state = _links[record.Link];
    const std::string name = "message " + std::to_string(number);
    if (!redelivered)
    {
        if (record.Delivered)
        {
            Fail(1, name + " was delivered twice");
        }
        else if (number < state.NextToDeliver)
        {
            Fail(2, name + " came after a later one");
        }
    }
    else
    {
        if (!link.Options.RedeliverInDoubt)
        {
            Fail(1, name + " was redelivered on a link that did not opt in");
        }
        if (record.Epoch == EpochOf(record.Link))
        {
            Fail(1, name + " was redelivered although nobody restarted");
        }
        // If a sender has lost its storage, earlier messages of its stream may still come in between.
        if (!_scenario.IncarnationsMayFall)
        {
            if (state.FlaggedEpoch == EpochOf(record.Link) && number < state.NextFlagged)
            {
                Fail(2, name + " was redelivered after a later one");
            }
            state.FlaggedEpoch = EpochOf(record.Link);
            state.NextFlagged = number + 1;
        }
        _redeliveredTwice += record.Delivered ? 1 : 0;
    }
    if (record.HasOutcome && !(record.Outcome == LinkOutcome::InDoubt && _scenario.IncarnationsMayFall))
    {
        Fail(4,
             name + " was delivered after its outcome was '" + std::string(ToString(record.Outcome)) + "'");
    }
    if (link.Options.Expire > LinkTime(0) && senderNow - record.EnqueuedAt > link.Options.Expire)
    {
        Fail(5, name + " was delivered " +
                    std::to_string((senderNow - record.EnqueuedAt - link.Options.Expire).count()) +
                    " ns after its expiry");
    }
    _deliveredBytes += record.Bytes;
    _largeDelivered += record.Bytes > _scenario.Settings.MaxDatagram ? 1 : 0;
    record.Delivered = true;
    state.NextToDeliver = std::max(state.NextToDeliver, number + 1);
}

void Oracle::OnOutcome(std::size_t node, std::uint64_t id, std::string_view destination,
                       std::string_view queue, LinkOutcome outcome, LinkTime senderNow)
{
    const std::size_t life = _lifeOf[node];
    if (life == NoLife || id == 0 || id > _lives[life].RecordOfId.size())
    {
        Fail(3, "an outcome of a message that was not accepted");
        return;
    }
    const std::size_t number = _lives[life].RecordOfId[id - 1];
    Record &record = _records[number];
    const ScenarioLink &link = _scenario.Links[record.Link];
    const std::string name = "message " + std::to_string(number);
    if (record.Link != FindLink(node, FindNode(destination), queue))
    {
        Fail(3, name + " has an outcome of another link");
    }
    if (record.HasOutcome)
    {
        Fail(3, name + " has two outcomes");
        return;
    }
    record.HasOutcome = true;
    record.Outcome = outcome;
    ++_outcomes[static_cast<std::size_t>(outcome)];
    --_links[record.Link].Pending;
    _links[record.Link].PendingBytes -= record.Bytes;
    switch (outcome)
    {
        case LinkOutcome::Delivered:
            if (!record.Delivered)
            {
                Fail(4, name + " is said to be delivered and was not");
            }
            break;
        case LinkOutcome::Expired:
            if (record.Delivered)
            {
                Fail(4, name + " is said to have expired and was delivered");
            }
            if (link.Options.Expire == LinkTime(0) || senderNow - record.EnqueuedAt < link.Options.Expire)
            {
                Fail(4, name + " is said to have expired and had time left");
            }
            break;
        case LinkOutcome::RefusedThere:
            if (record.Delivered || !record.RefusedByQueue)
            {
                Fail(4, name + " is said to be refused and was not");
            }
            break;
        case LinkOutcome::InDoubt:
        {
            const LinkTime silence = senderNow - _heardAt[link.Source][link.Destination];
            const bool isGivenUp = link.Options.Expire > LinkTime(0) &&
                                   senderNow - record.EnqueuedAt >= link.Options.Expire &&
                                   silence >= _scenario.Settings.SilentAfter;
            _givenUp += isGivenUp ? 1 : 0;
            if (record.Epoch == EpochOf(record.Link) && !_scenario.IncarnationsMayFall && !isGivenUp)
            {
                Fail(4, name + " is in doubt although nobody restarted and the receiver was not silent");
            }
            break;
        }
    }
}

void Oracle::CheckSender(std::size_t node, std::string_view destination, std::string_view queue,
                         const LinkSenderCounters &counters)
{
    const std::size_t index = FindLink(node, FindNode(destination), queue);
    if (index >= _links.size())
    {
        Fail(6, "a link that is not in use");
        return;
    }
    const LinkOptions &options = _scenario.Links[index].Options;
    const LinkState &state = _links[index];
    const bool used = state.Life == _lifeOf[node];
    if (counters.Pending != (used ? state.Pending : 0) ||
        counters.PendingBytes != (used ? state.PendingBytes : 0))
    {
        Fail(3, "the outbox holds " + std::to_string(counters.Pending) + " messages, " +
                    std::to_string(used ? state.Pending : 0) + " have no outcome");
    }
    if (counters.Accepted !=
        counters.Delivered + counters.Expired + counters.InDoubt + counters.RefusedThere + counters.Pending)
    {
        Fail(3, "the counters do not balance");
    }
    if (counters.Pending > options.Capacity || counters.PendingBytes > options.CapacityBytes)
    {
        Fail(6, "the outbox is above its limit");
    }
    if (counters.Unacknowledged > options.Window)
    {
        Fail(6, "the window is above its limit");
    }
}

std::size_t Oracle::PendingBytes() const
{
    std::size_t bytes = 0;
    for (const LinkState &state : _links)
    {
        bytes += state.PendingBytes;
    }
    return bytes;
}

std::size_t Oracle::PendingCount() const
{
    std::size_t count = 0;
    for (const LinkState &state : _links)
    {
        count += state.Pending;
    }
    return count;
}

std::size_t Oracle::Undrained(const std::vector<bool> &alive) const
{
    return static_cast<std::size_t>(std::count_if(_records.begin(), _records.end(),
                                                  [&](const Record &record)
                                                  {
                                                      const ScenarioLink &link = _scenario.Links[record.Link];
                                                      return !record.HasOutcome &&
                                                             record.Life == _lifeOf[link.Source] &&
                                                             alive[link.Destination];
                                                  }));
}

}  // namespace Rabit::Sim
