#pragma once

#include <rabit/RabitWorkspace.h>
#include <rabit/gateway/GatewayConfig.h>
#include <rabit/gateway/RandomSource.h>
#include <rabit/transport/Transport.h>

#include <algorithm>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <functional>
#include <memory>
#include <string>

#include "clocks/SourceClock.h"
#include "foreign/ForeignTopics.h"
#include "gateway.idl.h"
#include "manager/AirTraffic.h"
#include "manager/NodeSecurity.h"
#include "manager/TypeExchange.h"
#include "mirrors/StateExchange.h"
#include "mirrors/Subscriptions.h"
#include "mirrors/TopicPublisher.h"
#include "paths/PathChoice.h"
#include "presence/OriginTable.h"
#include "presence/Presence.h"
#include "presence/RemoteQueues.h"
#include "queues/LinkDriver.h"

namespace Rabit
{
class RabitManager;

// One path of a gateway: a network by which it reaches other nodes. A path has a session, beats, publications
// and a schedule of its own, since each network has its own capacity and delay. Links, subscriptions and the
// local names belong to all paths together. The gateway's thread only.
class GatewayPath
{
public:
    using Duration = std::chrono::nanoseconds;

    // The parts that the paths of one gateway share. All references must outlive the paths.
    struct Shared
    {
        RabitManager &Manager;
        std::function<void()> WakeUp;
        RabitWorkspace &Workspace;
        std::uint64_t Incarnation = 0;
        const SourceClock &Source;
        OriginTable &Origins;
        RemoteQueues &Remote;
        LinkDriver &Links;
        Subscriptions &Subscribed;
        ForeignTopics &Foreign;  // of the first path
        PathChoice &Choice;
        NodeMembers &Members;
        RandomSource Random;
        PeerTable::IsNeeded IsNeeded;
        TypeExchange::OnText OnText;
        TypeExchange::ReportOf ReportOf;
    };

    // `config` is the gateway's, with the network settings of this path. `number`: its place among the paths.
    GatewayPath(GatewayConfig config, std::shared_ptr<Rabit::Transport> transport, std::size_t number,
                const Shared &shared);

    // Joins the network. Throws TransportError.
    void Join();
    // Once all paths have joined, in their order. Throws TransportError.
    void Open();
    // Once all paths are open.
    void Begin();
    // Says goodbye; the endpoints and the session stay until Close.
    void SayGoodbye() { _presence.Close(); }
    void Close();

    // Takes in what has come. The result is valid until the next call.
    const Presence::Served &TakeIn(Duration now)
    {
        const Presence::Served &served = _presence.Service(now);
        _types.TakeIn(served, now);
        // Most of the time there is nothing to do.
        if (!served.Delays.empty() || !served.NothingLate.empty() || _shared.Links.HasDelays())
        {
            TakeDelays(served, now);
        }
        return served;
    }
    // Sends what is due, and may be sent now. Returns when to call TakeIn and Send again at the latest.
    Duration Send(Duration now)
    {
        _states.Serve(_presence.LastServed(), _publishers, now);
        Duration next = std::min(_presence.NextDue(), _air.Serve(now));
        next = std::min(next, _states.Due().value_or(next));
        if (_states.TellVersions(_publishers, now))
        {
            // A beat that is due already waits for its turn.
            const Duration beat = _presence.BeatDue();
            next = beat > now ? std::min(next, beat) : next;
        }
        return next;
    }

    // True if a copy of a frame of the links, of that size on the air, may go by this path now.
    bool MayTakeCopy(std::string_view node, std::string_view queue, std::size_t bytes)
    {
        return _air.MayTakeCopy(node, queue, bytes);
    }
    // AirTraffic::SentPast
    void SentPast() { _air.SentPast(); }

    // Matches the States of a node with the subscriptions.
    void SetWanted(const PeerTable::Peer &peer, const std::vector<StateRepair::Wanted> &states)
    {
        _states.SetWanted(peer, states);
    }
    void SubscriptionsAdded(Duration now) { _states.AskAgain(now); }

    // AirTraffic::Report
    Gateway::AirStatus Report(Gateway::Fleet &fleet, Duration now) { return _air.Report(fleet, now); }
    // Adds the problems of this path alone.
    void AddProblems(Gateway::Fleet &fleet, Duration now) const;

    // Empty: the only one of a gateway without `paths`.
    std::string Name() const { return _config.Paths.empty() ? "" : _config.Paths.front().Name; }
    Presence &Beats() { return _presence; }
    const Presence &Beats() const { return _presence; }
    TransportSession &Session() { return *_session; }
    TypeExchange &Types() { return _types; }
    const TypeExchange &Types() const { return _types; }
    const std::deque<TopicPublisher> &Publishers() const { return _publishers; }

private:
    bool Carries(std::string_view node) const { return _shared.Choice.Of(node) == _number; }
    void Attach(TopicPublisher &publisher);
    void TakeDelays(const Presence::Served &served, Duration now);

    const GatewayConfig _config;
    const std::shared_ptr<Rabit::Transport> _transport;
    const std::size_t _number;
    const Shared _shared;
    Presence _presence;
    StateExchange _states;
    std::unique_ptr<TransportSession> _session;
    std::deque<TopicPublisher> _publishers;
    TypeExchange _types;
    AirTraffic _air;
    Duration _openedAt{0};
};

}  // namespace Rabit
