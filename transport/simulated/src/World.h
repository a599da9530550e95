// What the simulated network consists of. All of it is guarded by the NetworkCore's mutex, unless said
// otherwise.
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

struct EndpointId
{
    ParticipantId Participant = 0;
    std::uint32_t Entity = 0;
    auto operator<=>(const EndpointId &) const = default;
};

// Never changed once it is in a history.
struct Sample
{
    std::vector<std::uint8_t> Bytes;
    KeyHash Key{};
    std::int64_t SourceTime = 0;
    std::uint64_t Sequence = 0;
    bool Alive = true;
    std::uint32_t Datagrams = 1;  // that it travels in
};
using SamplePtr = std::shared_ptr<const Sample>;

// What discovery tells of a writer or reader.
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
        Announce,        // I am here
        Bye,             // I go
        Card,            // a message about cards; Endpoints is what the sender's card says
        Data,            // Content; nothing below First will come any more
        Heartbeat,       // I have First to Last for you
        Acknowledgement  // I have all below First, but miss Sequences
    };
    Kind What = Kind::Announce;
    EndpointId Writer;
    EndpointId Reader;
    std::uint64_t First = 0;
    std::uint64_t Last = 0;
    SamplePtr Content;
    std::shared_ptr<const std::vector<std::uint8_t>> Card;  // as it travels
    std::shared_ptr<const EndpointList> Endpoints;
    std::vector<std::uint64_t> Sequences;
    std::shared_ptr<const ParticipantState> Sender;  // of a message about cards
};

// A datagram for one reader, or for one participant, of those that may share it on the way.
struct Letter
{
    ParticipantId To = 0;
    Datagram Content;
    std::chrono::nanoseconds Processing{0};
};
using Letters = std::vector<Letter>;  // those to one participant stand together

// Letters that go together, in as many packets as they need. They have arrived when the last packet has.
struct Flight
{
    ParticipantId From = 0;
    std::uint32_t FromNode = 0;
    Simulated::Letters Letters;
    std::uint64_t Waiting = 0;                    // packets that have not passed yet
    std::map<ParticipantId, std::uint32_t> Lost;  // packets, at whom
};

// How a writer sees a matched reader.
struct ReaderProxy
{
    bool Reliable = false;
    std::uint64_t Acknowledged = 0;  // it needs nothing up to here
    // Datagrams of large samples that have not got through yet; absent: all of them.
    std::map<std::uint64_t, std::uint32_t> Missing;
};

struct WriterState
{
    EndpointInfoPtr Info;
    std::uint64_t LastSequence = 0;
    std::deque<SamplePtr> History;
    std::deque<SamplePtr> Disposals;  // that some reader may not know yet
    std::map<EndpointId, ReaderProxy> Readers;
    // When the next heartbeat goes, if anything waits for it; the distance to the one after it; and the
    // number of its timer.
    std::optional<std::chrono::nanoseconds> HeartbeatAt;
    std::chrono::nanoseconds HeartbeatGap{0};
    std::uint64_t HeartbeatTimer = 0;
};

// How a reader sees a matched writer.
struct WriterProxy
{
    std::shared_ptr<const PeerSession> Node;
    bool Reliable = false;
    bool Started = false;                               // Expected is known
    std::uint64_t Expected = 0;                         // the next to hand over
    std::map<std::uint64_t, SamplePtr> Early;           // came before Expected did
    std::optional<std::chrono::nanoseconds> ArrivedAt;  // of a best-effort writer: the last sample
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

// How a participant sees another.
struct Peer
{
    std::uint64_t Birth = 0;  // tells this life of the entry from others, for its timers
    std::shared_ptr<const PeerSession> Who;
    std::chrono::nanoseconds Lease{};
    std::chrono::nanoseconds LastHeard{};
    std::shared_ptr<const EndpointList> TheirEndpoints = std::make_shared<EndpointList>();
};

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
    PeerSessions<ParticipantId> Sessions;  // of these
    std::set<ParticipantId> Departed;      // said goodbye: announcements of theirs that come later are void
    std::map<EndpointId, std::shared_ptr<WriterState>> Writers;
    std::map<EndpointId, std::shared_ptr<ReaderState>> Readers;
    std::uint32_t LastEntity = 0;
    std::uint64_t Version = 1;  // of Endpoints
    std::shared_ptr<const EndpointList> Endpoints = std::make_shared<EndpointList>();
    int Announced = 0;  // times

    Rtps::CardExchange Cards;
    std::optional<std::chrono::nanoseconds> CardsAt;  // when their timer is due
    std::uint64_t CardTimer = 0;                      // the number of the one that counts

    // Not guarded by the network's mutex.
    const std::shared_ptr<SessionLog> Log;
    TopicRegistry Topics;
    const PeerHandler OnPeer;
    HandlerGate PeerGate;
};

// Of the RTPS GUIDs of its endpoints.
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
