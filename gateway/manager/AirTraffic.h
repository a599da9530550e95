#pragma once

#include <rabit/gateway/AirCost.h>
#include <rabit/gateway/GatewayConfig.h>
#include <rabit/transport/Transport.h>

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <functional>
#include <optional>
#include <vector>

#include "air/AirSchedule.h"
#include "air/CapacityEstimate.h"
#include "air/DiscoveryBurst.h"
#include "air/UnscheduledShare.h"
#include "gateway.idl.h"
#include "manager/AirReport.h"
#include "manager/ForeignStreams.h"
#include "manager/LinkStreams.h"
#include "manager/TypeExchange.h"
#include "mirrors/TopicPublisher.h"
#include "paths/PathChoice.h"
#include "presence/BeatRate.h"
#include "presence/Presence.h"
#include "queues/LinkDriver.h"

namespace Rabit
{

// Sends all datagrams of a gateway: in the order and at the rate of AirSchedule where there is a limit, at
// once where there is none.
//
// - The limit is the lower one of `radio: budget` and the capacity estimated from the peers' reports of late
//   datagrams (CapacityEstimate).
// - Streams are: the beats (class presence); for each node, acknowledgements and hellos (class command); the
//   cards and introductions of discovery (class state, before other states); the texts of types that are
//   asked for (class bulk); each link; each published message; each foreign topic that is written (class
//   foreign). A datagram is made when its turn has come, from the newest data.
// - Each datagram is paid for with the bytes that the transport counted for it. DDS's own traffic is paid
//   for, too, and a part of a budget is kept free for it when it is due.
// - With a budget, streams that are ready ride in the datagram of the chosen one (AirSchedule::NextRider), as
//   far as the session merges datagrams (TransportSession::BeginTurn).
// - Where the estimate is the only limit, a due beat does not wait.
// - BeatRate tells how often beats are sent.
//
// Gateway's thread only.
class AirTraffic
{
public:
    using Duration = std::chrono::nanoseconds;

    // Of the path with that number. References must outlive the object. `foreign`: null on a path without
    // foreign topics.
    AirTraffic(const GatewayConfig &config, const RabitClock &clock, Presence &presence, LinkDriver &links,
               std::deque<TopicPublisher> &publishers, std::deque<ForeignPublisher> *foreign,
               TypeExchange &types, const PathChoice &choice, std::size_t path);

    // From now on the session's discovery (DiscoveryTurns) waits for Serve. To be called as soon as the
    // session exists. `wakeUp`: called, on any thread, when Serve is to be called before the time that it
    // returned.
    void TakeTurns(TransportSession &session, std::function<void()> wakeUp);
    // Call once all publishers exist. The session is kept until Close.
    void Open(TransportSession &session);
    void Close()
    {
        _foreign.Close();
        _session = nullptr;
        _turns = nullptr;
    }

    // Sends the due datagrams that may be sent now. Returns when to call again at the latest.
    Duration Serve(Duration now);
    // True if a copy of a frame of the links may go past the schedule now: there is room in the budget, and
    // the frame is not of class bulk. An empty queue: acknowledgements.
    bool MayTakeCopy(std::string_view node, std::string_view queue, std::size_t bytes);
    // That copy, or a datagram of the agreement, was sent past the schedule, and is paid for.
    void SentPast();
    // A peer reported the delay of a datagram of this node.
    void Reported(CapacityEstimate::Peer peer, Duration delay, Duration arrivedAt, Duration now);
    void NothingLate(CapacityEstimate::Peer peer, Duration sentAt, Duration now)
    {
        _estimate.NothingLate(peer, sentAt, now);
    }

    // Returns this path's part of fleet.air, and fills in the rates of links and publications, whose rows are
    // in the message already.
    Gateway::AirStatus Report(Gateway::Fleet &fleet, Duration now);

private:
    bool IsLimited() const { return !_schedule.Budget().IsUnlimited(); }
    // Of several paths each sends only what goes to the nodes that it carries, which the schedule chooses.
    bool IsScheduled() const { return IsLimited() || _choice.Paths() > 1; }
    // Bytes sent since the last call.
    std::size_t TakeSent();
    void LookAtDiscovery(std::uint64_t sent);
    void Watch(Duration now);
    void SetLimit(Duration now);
    Duration ServeUnlimited(Duration now);
    Duration ServeLimited();
    bool IsBeatWorth(Duration now) const;
    std::size_t BeatBytes(Duration now) const;
    std::size_t BeatRoom(Duration now);
    std::size_t SendBeat(std::size_t most, Duration now);
    void KeepPromise(Duration now);
    void LookAtBeat(Duration now);
    void LookAt(std::size_t publisher, Duration now);
    bool MayCopy(const TopicPublisher &publisher, Duration now);
    void LookAtTypes(Duration now);
    void LookAtCards();
    // Sends one datagram of the stream, and pays for it. Returns its bytes on the air. `joins`: the bytes
    // that the datagram of this turn has room for; empty: it is the first one.
    std::size_t Send(StreamId id, std::optional<std::size_t> joins, Duration now);
    // AirTrafficTurns.cpp
    bool IsMerging(Duration now) const;
    void SendTurn(StreamId id, Duration now);
    void SendRiders(TrafficClass first, const AirSchedule::Destinations &to, std::size_t room, Duration now);
    AirSchedule::Destinations TakeDestinations(StreamId id);
    AirReport::Sent SentByStreams() const;
    Duration Now() const { return _clock.Monotonic(); }

    const GatewayConfig &_config;
    const RabitClock &_clock;
    Presence &_presence;
    LinkDriver &_links;
    std::deque<TopicPublisher> &_publishers;
    TypeExchange &_types;
    const PathChoice &_choice;
    const std::size_t _path;
    // The States and telemetry that go by this path.
    enum class Mirrored
    {
        Nothing,
        Copies,
        All
    };
    Mirrored _mirrored = Mirrored::Nothing;
    bool _merges = false;  // datagrams
    const AirCost _cost;
    TransportSession *_session = nullptr;
    DiscoveryTurns *_turns = nullptr;  // of the session
    std::size_t _cardBytes = 0;        // of the next datagram of cards, to one destination

    AirSchedule _schedule;
    CapacityEstimate _estimate;
    DiscoveryBurst _discovery;
    UnscheduledShare _unscheduled;
    StreamId _beat;
    StreamId _typeTexts;
    StreamId _cards;
    std::vector<StreamId> _publisherStreams;
    LinkStreams _linkStreams;
    ForeignStreams _foreign;
    AirReport _report;

    BeatRate _beats;
    std::uint64_t _samples = 0;
    std::uint64_t _sent = 0;  // as the transport counts, when it was last asked
    std::uint64_t _discovered = 0;
    Duration _watchedAt{0};
    Duration _servedAt{0};  // without a limit
    Duration _limitSetAt{0};
};

}  // namespace Rabit
