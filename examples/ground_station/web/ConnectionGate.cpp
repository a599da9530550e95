#include "ConnectionGate.h"

#include <algorithm>

namespace Ground
{

ConnectionGate::Decision ConnectionGate::Arrive(const Address &from)
{
    const std::size_t most =
        IsKnown(from) ? _limits.Most : _limits.Most - std::min(_limits.Most, _limits.ForKnown);
    Decision decision;
    bool hasRoom = true;
    if (!from.is_loopback() && Of(from) >= _limits.MostOfOne)
    {
        decision.Dropped = OldestIdleOf(from);
        hasRoom = decision.Dropped.has_value();
    }
    else if (Open() >= most)
    {
        decision.Dropped = IdleToDrop();
        hasRoom = decision.Dropped.has_value();
    }
    else if (Idle() >= _limits.MostIdle)
    {
        decision.Dropped = IdleToDrop();
    }
    if (!hasRoom)
        return {};
    if (decision.Dropped)
        _open.erase(*decision.Dropped);
    decision.Taken = ++_lastId;
    _open[_lastId] = {from, ++_lastIdle};
    return decision;
}

void ConnectionGate::BecomesIdle(Id id)
{
    if (const auto found = _open.find(id); found != _open.end())
        found->second.IdleSince = ++_lastIdle;
}

void ConnectionGate::BecomesBusy(Id id)
{
    if (const auto found = _open.find(id); found != _open.end())
        found->second.IdleSince = 0;
}

void ConnectionGate::OpensPage(Id id)
{
    BecomesBusy(id);
    const auto found = _open.find(id);
    if (found == _open.end() || Open() > _limits.Most / 2 || IsKnown(found->second.From))
        return;
    _known.push_back(found->second.From);
    if (_known.size() > MostKnown)
        _known.pop_front();
}

bool ConnectionGate::IsKnown(const Address &from) const
{
    return from.is_loopback() || std::find(_known.begin(), _known.end(), from) != _known.end();
}

std::size_t ConnectionGate::Of(const Address &from) const
{
    return static_cast<std::size_t>(std::count_if(
        _open.begin(), _open.end(), [&from](const auto &entry) { return entry.second.From == from; }));
}

std::size_t ConnectionGate::Idle() const
{
    return static_cast<std::size_t>(std::count_if(
        _open.begin(), _open.end(), [](const auto &entry) { return entry.second.IdleSince != 0; }));
}

std::optional<ConnectionGate::Id> ConnectionGate::OldestIdleOf(const Address &from) const
{
    std::optional<Id> oldest;
    for (const auto &[id, connection] : _open)
        if (connection.From == from && connection.IdleSince != 0 &&
            (!oldest || connection.IdleSince < _open.at(*oldest).IdleSince))
            oldest = id;
    return oldest;
}

std::optional<ConnectionGate::Id> ConnectionGate::IdleToDrop() const
{
    std::map<Address, std::size_t> idle;
    for (const auto &[id, connection] : _open)
        if (connection.IdleSince != 0)
            ++idle[connection.From];
    const auto most = std::max_element(idle.begin(), idle.end(),
                                       [](const auto &a, const auto &b) { return a.second < b.second; });
    return most == idle.end() ? std::nullopt : OldestIdleOf(most->first);
}

}  // namespace Ground
