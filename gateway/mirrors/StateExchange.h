#pragma once

#include <rabit/gateway/RandomSource.h>

#include <chrono>
#include <cstddef>
#include <deque>
#include <optional>
#include <string>
#include <vector>

#include "mirrors/StateRepair.h"
#include "mirrors/Subscriptions.h"
#include "mirrors/TopicPublisher.h"
#include "presence/Presence.h"

namespace Rabit
{

// Carries versions and requests of States between Presence and the mirrors. Announces the versions of this
// node's States, has a State written again that others request, and requests States that this node lacks
// (StateRepair). One for each path. Gateway's thread only.
class StateExchange
{
public:
    using Duration = std::chrono::nanoseconds;

    // References must outlive the object.
    StateExchange(Presence &presence, const Subscriptions &subscriptions, RandomSource random);

    // Once all publishers are there, in the order of the announcement.
    void Open(const std::deque<TopicPublisher> &publishers);
    // Call after Presence has served, and before due datagrams are sent.
    void Serve(const Presence::Served &served, std::deque<TopicPublisher> &publishers, Duration now)
    {
        // Most of the time there is nothing to do.
        const PeerTable::Change &change = served.Change;
        if (change.State || !change.Forgotten.empty() || !served.StatesTold.empty() ||
            !served.StatesAsked.empty() || !_repair.IsIdle())
        {
            TakeIn(served, publishers, now);
        }
    }
    // The States of a node that are wanted, which Subscriptions knows.
    void SetWanted(const PeerTable::Peer &peer, const std::vector<StateRepair::Wanted> &states)
    {
        _repair.SetWanted(peer.Node, peer.Incarnation, states);
    }
    // More States are wanted than before, or this path carries more nodes: compares with what their last
    // beats told.
    void AskAgain(Duration now);
    // After the publishers have written. Returns whether a beat may be due sooner than before.
    bool TellVersions(const std::deque<TopicPublisher> &publishers, Duration now);
    // When to call Serve again at the latest, beside the times that Presence knows; empty: not at all.
    std::optional<Duration> Due() const { return _repair.Due(); }

private:
    void TakeIn(const Presence::Served &served, std::deque<TopicPublisher> &publishers, Duration now);
    void TakeIn(const PeerTable::Change &change);
    void TakeIn(const std::vector<std::string> &told, Duration now);
    void Ask(Duration now);

    Presence &_presence;
    StateRepair _repair;
    std::vector<std::size_t> _states;      // the publisher of the State with that index
    std::vector<std::uint32_t> _versions;  // as told last
};

}  // namespace Rabit
