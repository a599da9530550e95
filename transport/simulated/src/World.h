// State of the simulated network. All of it is guarded by the NetworkCore's mutex, unless said otherwise.
#pragma once

#include <rabit/transport/Transport.h>

#include <algorithm>
#include <chrono>
#include <compare>
#include <cstdint>
#include <deque>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "common/HandlerGate.h"
#include "common/InstanceTable.h"
#include "common/MulticastUse.h"
#include "common/ParticipantIdentity.h"
#include "common/PeerSessions.h"
#include "common/SessionLog.h"
#include "common/TopicRegistry.h"
#include "rtps/CardExchange.h"

namespace Rabit::Simulated
{

using ParticipantId = std::uint32_t;
constexpr ParticipantId Nobody = 0;

struct EndpointId
{
    ParticipantId Participant = 0;
    std::uint32_t Entity = 0;
    auto operator<=>(const EndpointId &) const = default;
};

// Constant once it is in a history.
struct Sample
{
    std::vector<std::uint8_t> Bytes;
    KeyHash Key{};
    std::int64_t SourceTime = 0;
    std::uint64_t Sequence = 0;
    bool Alive = true;
    std::uint32_t Datagrams = 1;  // number in which it travels
};
using SamplePtr = std::shared_ptr<const Sample>;

// A writer or reader as discovery describes it.
struct EndpointInfo
{
    EndpointId Id;
    bool IsWriter = false;
    std::string Topic;
    std::string Type;
    bool Keyed = false;
    TopicQos Qos;
    std::vector<std::string> Partitions;
};
using EndpointInfoPtr = std::shared_ptr<const EndpointInfo>;
using EndpointList = std::vector<EndpointInfoPtr>;  // by rising Id

struct ParticipantState;

struct Datagram
{
    enum class Kind
    {
        Announce,        // the sender is alive
        Bye,             // goodbye
        Card,            // a card message; Endpoints: content of the sender's card
        Introduction,    // of the seal itself: nothing but Sealed
        Data,            // Content; no sample below First will come any more
        Heartbeat,       // samples First to Last are available
        Acknowledgement  // all below First have arrived, Sequences are missing
    };
    Kind What = Kind::Announce;
    EndpointId Writer;
    EndpointId Reader;
    std::uint64_t First = 0;
    std::uint64_t Last = 0;
    SamplePtr Content;
    std::shared_ptr<const std::vector<std::uint8_t>> Card;  // its bytes
    std::shared_ptr<const EndpointList> Endpoints;
    std::vector<std::uint64_t> Sequences;
    std::shared_ptr<const ParticipantState> Sender;  // of a card message
    // The seal's bytes for a message that stands for this datagram (SealStage.h); null: it is not sealed.
    std::shared_ptr<const std::vector<std::uint8_t>> Sealed;
};

// A datagram for one reader, or for one participant, which may share a multicast packet with others.
struct Letter
{
    ParticipantId To = 0;
    Datagram Content;
    std::chrono::nanoseconds Processing{0};
};
using Letters = std::vector<Letter>;  // those to one participant are adjacent

// Letters sent together, in as many packets as they need. They arrive with the last packet.
struct Flight
{
    ParticipantId From = 0;
    std::uint32_t FromNode = 0;
    Simulated::Letters Letters;
    std::uint64_t Waiting = 0;                    // packets that have not passed yet
    std::map<ParticipantId, std::uint32_t> Lost;  // packets lost, by receiver
};

// Letters that go in one packet at the end of a turn.
struct KeptPacket
{
    ParticipantId To = Nobody;  // Nobody: by multicast
    Simulated::Letters Letters;
    std::uint64_t Bytes = 0;  // on the air
};

// A turn of a session (TransportSession::BeginTurn).
struct Turn
{
    bool IsOpen = false;
    std::size_t Most = 0;  // bytes of a packet of several samples
    TurnDestinations Taken;
    std::vector<KeptPacket> Packets;
};

// A writer's view of a matched reader.
struct ReaderProxy
{
    bool Reliable = false;
    std::uint64_t Acknowledged = 0;  // it needs no sample up to here
    // Number of missing datagrams of large samples; no entry: all of them are missing.
    std::map<std::uint64_t, std::uint32_t> Missing;
};

struct WriterState
{
    EndpointInfoPtr Info;
    std::uint64_t LastSequence = 0;
    std::deque<SamplePtr> History;
    std::deque<SamplePtr> Disposals;  // disposals that some reader may not know yet
    std::map<EndpointId, ReaderProxy> Readers;
    // When the next heartbeat goes, if any is needed; the interval to the one after it; and the number of its
    // timer.
    std::optional<std::chrono::nanoseconds> HeartbeatAt;
    std::chrono::nanoseconds HeartbeatGap{0};
    std::uint64_t HeartbeatTimer = 0;
};

// A reader's view of a matched writer.
struct WriterProxy
{
    std::shared_ptr<const PeerSession> Node;
    bool Reliable = false;
    bool Started = false;                               // Expected is known
    std::uint64_t Expected = 0;                         // the next sample to deliver
    std::map<std::uint64_t, SamplePtr> Early;           // samples that came before Expected
    std::optional<std::chrono::nanoseconds> ArrivedAt;  // when the last sample of a best-effort writer came
};

struct ReaderState
{
    ReaderState(std::shared_ptr<SessionLog> log, EndpointInfoPtr info, SampleHandler handler)
        : Info(std::move(info)), Handler(std::move(handler)), Gate(log, "the reader of " + Info->Topic)
    {
    }
    const EndpointInfoPtr Info;
    std::map<EndpointId, WriterProxy> Writers;

    // Not guarded by the network's mutex.
    const SampleHandler Handler;
    HandlerGate Gate;
    InstanceTable Instances;  // under the gate
};

// A participant's view of another.
struct Peer
{
    std::uint64_t Birth = 0;  // distinguishes this entry from earlier ones of the peer, for its timers
    std::shared_ptr<const PeerSession> Who;
    std::chrono::nanoseconds Lease{};
    std::chrono::nanoseconds LastHeard{};
    std::shared_ptr<const EndpointList> TheirEndpoints = std::make_shared<EndpointList>();
};

// When the timer of one kind is due that is valid.
struct DueTimer
{
    std::optional<std::chrono::nanoseconds> At;
    std::uint64_t Number = 0;
};

class SealStage;

struct ParticipantState
{
    ParticipantState(const TransportSettings &settings, PeerHandler onPeer)
        : Settings(settings),
          Who(std::make_shared<ParticipantIdentity>(
              ParticipantIdentity{settings.Node, settings.Incarnation})),
          Cards({.Period = settings.AnnouncementPeriod, .IsMulticast = IsMulticastForData(settings)}),
          Log(std::make_shared<SessionLog>(settings)),
          Topics(Log),
          OnPeer(std::move(onPeer)),
          PeerGate(Log, "peer events")
    {
    }
    const TransportSettings Settings;
    const std::shared_ptr<const ParticipantIdentity> Who;
    ParticipantId Id = 0;
    std::uint32_t NodeNumber = 0;  // in the fault plan
    bool Gone = false;             // closed or crashed
    std::map<ParticipantId, Peer> Peers;
    PeerSessions<ParticipantId> Sessions;  // of Peers
    std::set<ParticipantId> Departed;      // said goodbye: their later announcements are ignored
    std::map<EndpointId, std::shared_ptr<WriterState>> Writers;
    std::map<EndpointId, std::shared_ptr<ReaderState>> Readers;
    std::uint32_t LastEntity = 0;
    std::uint64_t Version = 1;  // of Endpoints
    std::shared_ptr<const EndpointList> Endpoints = std::make_shared<EndpointList>();
    int Announced = 0;  // times

    Simulated::Turn Turn;
    Rtps::CardExchange Cards;
    DueTimer CardTimer;
    std::shared_ptr<SealStage> Seal;  // null: the session has no member
    DueTimer SealTimer;

    // Not guarded by the network's mutex.
    DiscoveryTurns Turns;
    const std::shared_ptr<SessionLog> Log;
    TopicRegistry Topics;
    const PeerHandler OnPeer;
    HandlerGate PeerGate;
};

// The prefix of the RTPS GUIDs of a participant's endpoints.
inline Rtps::GuidPrefix PrefixOf(ParticipantId id)
{
    Rtps::GuidPrefix result{};
    for (std::size_t i = 0; i < 4; ++i)
    {
        result[8 + i] = static_cast<std::uint8_t>(id >> (24 - 8 * i));
    }
    return result;
}

inline ParticipantId ParticipantOf(const Rtps::GuidPrefix &prefix)
{
    ParticipantId id = 0;
    for (std::size_t i = 0; i < 4; ++i)
    {
        id = id << 8 | prefix[8 + i];
    }
    return id;
}

// An RTPS GUID: prefix, entity.
inline WriterId ToWriterId(const EndpointId &id)
{
    WriterId result{};
    const Rtps::GuidPrefix prefix = PrefixOf(id.Participant);
    std::copy(prefix.begin(), prefix.end(), result.begin());
    for (std::size_t i = 0; i < 4; ++i)
    {
        result[12 + i] = static_cast<std::uint8_t>(id.Entity >> (24 - 8 * i));
    }
    return result;
}

}  // namespace Rabit::Simulated
