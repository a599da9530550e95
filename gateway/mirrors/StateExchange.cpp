#include "mirrors/StateExchange.h"

#include <utility>

namespace Rabit
{

StateExchange::StateExchange(Presence &presence, const Subscriptions &subscriptions, RandomSource random)
    : _presence(presence),
      _repair([&subscriptions](const std::string &node, std::uint64_t incarnation, std::size_t subscription)
              { return subscriptions.TakenIn(subscription, node, incarnation); },
              std::move(random))
{
}

void StateExchange::Open(const std::deque<TopicPublisher> &publishers)
{
    for (std::size_t i = 0; i < publishers.size(); ++i)
    {
        if (publishers[i].Rule().Qos == QosProfile::State)
        {
            _states.push_back(i);
        }
    }
    _versions.assign(_states.size(), StateVersion::None);
}

void StateExchange::TakeIn(const Presence::Served &served, std::deque<TopicPublisher> &publishers,
                           Duration now)
{
    TakeIn(served.Change);
    TakeIn(served.StatesTold, now);
    for (const std::size_t place : served.StatesAsked)
    {
        if (place < _states.size())
        {
            publishers[_states[place]].AskedFor(now);
        }
    }
    const std::optional<Duration> due = _repair.Due();
    if (!_repair.IsIdle() && ((due && *due <= now) || _presence.BeatDue() <= now))
    {
        Ask(now);
    }
}

void StateExchange::TakeIn(const PeerTable::Change &change)
{
    for (const std::string &node : change.Forgotten)
    {
        _repair.Forget(node);
    }
    if (change.State)
    {
        for (const PeerTable::Peer *peer : _presence.Peers().Heard())
        {
            if (peer->State == Gateway::NodeState::LOST)
            {
                _repair.Rest(peer->Node);
            }
        }
    }
}

void StateExchange::AskAgain(Duration now)
{
    std::vector<std::string> nodes;
    for (const PeerTable::Peer *peer : _presence.Peers().Heard())
    {
        nodes.push_back(peer->Node);
    }
    TakeIn(nodes, now);
}

void StateExchange::TakeIn(const std::vector<std::string> &told, Duration now)
{
    if (told.empty())
    {
        return;
    }
    const std::size_t heard = _presence.Peers().Heard().size();
    for (const std::string &node : told)
    {
        const PeerTable::Peer *peer = _presence.Peers().Find(node);
        const auto source = peer == nullptr ? std::nullopt : peer->Clock.Source();
        if (source && peer->State != Gateway::NodeState::LOST)
        {
            _repair.OnTold(node,
                           {.Incarnation = peer->Incarnation,
                            .Versions = peer->States,
                            .SourceNow = (now - source->ToLocal).count(),
                            .RoundTrip = peer->Clock.RoundTrip().value_or(Duration(0)),
                            .Others = heard - 1},
                           now);
        }
    }
}

void StateExchange::Ask(Duration now)
{
    for (const StateRepair::Ask &ask : _repair.Take(now))
    {
        _presence.WantStates(ask.Node, ask.States, ask.Now, now);
    }
}

bool StateExchange::TellVersions(const std::deque<TopicPublisher> &publishers, Duration now)
{
    bool any = false;
    for (std::size_t place = 0; place < _states.size(); ++place)
    {
        const std::uint32_t version = publishers[_states[place]].Version();
        if (std::exchange(_versions[place], version) != version)
        {
            _presence.SetStateVersion(place, version);
            _presence.StateWritten(now);
            any = true;
        }
    }
    return any;
}

}  // namespace Rabit
