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
// (StateRepair). Gateway's thread only.
class StateExchange
{
public:
    using Duration = std::chrono::nanoseconds;

    // References must outlive the object.
    StateExchange(Presence &presence, Subscriptions &subscriptions, RandomSource random);

    // Once all publishers are there, in the order of the announcement.
    void Open(const std::deque<TopicPublisher> &publishers);
    // Call after Presence has served, and before due datagrams are sent.
    void Serve(const Presence::Served &served, std::deque<TopicPublisher> &publishers, Duration now)
    {
        // Most of the time there is nothing to do.
        const PeerTable::Change &change = served.Change;
        if (change.State || change.Offers || change.NewLife || !change.Forgotten.empty() ||
            !served.StatesTold.empty() || !served.StatesAsked.empty() || !_repair.IsIdle())
        {
            TakeIn(served, publishers, now);
        }
    }
    // After Subscriptions::Add.
    void SubscriptionsAdded(Duration now);
    // After the publishers have written. Returns whether a beat may be due sooner than before.
    bool TellVersions(const std::deque<TopicPublisher> &publishers, Duration now);
    // When to call Serve again at the latest, beside the times that Presence knows; empty: not at all.
    std::optional<Duration> Due() const { return _repair.Due(); }

private:
    void TakeIn(const Presence::Served &served, std::deque<TopicPublisher> &publishers, Duration now);
    void TakeIn(const PeerTable::Change &change);
    void Compare();
    void TakeIn(const std::vector<std::string> &told, Duration now);
    void Ask(Duration now);

    Presence &_presence;
    Subscriptions &_subscriptions;
    StateRepair _repair;
    std::vector<std::size_t> _states;      // the publisher of the State with that index
    std::vector<std::uint32_t> _versions;  // as told last
};

}  // namespace Rabit
