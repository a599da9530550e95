#pragma once

#include <rabit/base/Backoff.h>

#include <chrono>
#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <vector>

#include "rtps/OwnCard.h"

namespace Rabit::Rtps
{

// Tells the own DDS implementation the content of peers' cards, in the peers' names. It does so as reliably
// as if the peers had sent it themselves (OMG DDSI-RTPS 2.3, 8.4). Each announcement of an endpoint has a
// number, heartbeats name the numbers, and unacknowledged announcements are repeated. It also acknowledges to
// the implementation in the peers' names (OwnCard). So between nodes with cards none of these datagrams use
// the network.
//
// `Put` replaces the lease in a peer's announcement, so that a silent participant is remembered for long:
// beats tell whether it is alive.
//
// A pure state machine, not thread-safe.
class CardReplay
{
public:
    using TimePoint = std::chrono::steady_clock::time_point;
    using Duration = Backoff::Duration;

    // Shortest interval between answers to the implementation.
    static constexpr std::chrono::milliseconds ShortestGap{5};
    // First and longest interval between two repetitions of announcements that are not acknowledged.
    static constexpr std::chrono::milliseconds FirstRetry{50};
    static constexpr std::chrono::milliseconds LongestRetry{1000};
    // Bounds the repetitions to an implementation that refuses a peer because it has too many.
    static constexpr int MostRetries = 60;
    // Limit in bytes of a message with several announcements.
    static constexpr std::size_t LargestMessage = 8000;

    explicit CardReplay(Duration memory) : _memory(memory) {}

    void SetSelf(const GuidPrefix &self) { _self = self; }

    // Sets the unpacked card of a peer, in place of the former one: endpoints that it does not have are gone.
    // Returns false, and changes nothing, if it is no card of that peer.
    bool Put(const GuidPrefix &peer, std::span<const std::uint8_t> card, TimePoint now);
    bool Has(const GuidPrefix &peer) const { return _peers.contains(peer); }
    // The implementation has lost the peer, or was told that it left.
    void Forget(const GuidPrefix &peer) { _peers.erase(peer); }
    // Tells the implementation that the peer left, and forgets it.
    void End(const GuidPrefix &peer);
    // Tells the implementation that the peer left before it is told its card: it knows another announcement.
    void EndFirst(const GuidPrefix &peer);
    // The name that the peer's announcement gives it; empty: none.
    std::string NameOf(const GuidPrefix &peer) const;
    std::vector<GuidPrefix> Peers() const;
    std::size_t Size() const { return _peers.size(); }
    // True if the peer's card names that address, or if the address is of this host (guard/PeerVoice.h).
    bool IsAt(const GuidPrefix &peer, const HostAddress &host) const;
    // Bytes kept of the peer's card.
    std::size_t BytesOf(const GuidPrefix &peer) const;

    // Repeats everything of that peer, after a message to the implementation was lost. Does nothing while a
    // replay is in progress.
    void Again(const GuidPrefix &peer, TimePoint now);
    // Goes on with a replay that has ended before the implementation had acknowledged all.
    void GoOn(const GuidPrefix &peer, TimePoint now);

    // The implementation sent something to that peer, or to all: a heartbeat, or an acknowledgement.
    void Said(const EndpointSubmessage &said, TimePoint now);

    std::optional<TimePoint> Due() const;
    // Messages for the implementation, one after the other.
    struct Message
    {
        GuidPrefix From{};
        std::vector<std::uint8_t> Bytes;
    };
    // `own`: tells which announcements are acknowledged to the implementation.
    std::vector<Message> TakeDue(TimePoint now, const OwnCard &own);

private:
    struct Announcement
    {
        std::int64_t Number = 0;
        std::uint64_t Content = 0;
        bool IsGone = false;  // forgotten when it is acknowledged
        std::vector<std::uint8_t> Bytes;
    };
    // The announcements of one of the peer's endpoint writers, and the state of their delivery.
    struct Stream
    {
        std::map<EntityId, Announcement> Endpoints;
        std::int64_t Last = 0;
        std::int64_t Acknowledged = 1;  // the implementation has all before this one
        bool IsConfirmed = false;       // it has acknowledged since the last restart
        bool OwesAcknowledgement = false;
    };
    struct Peer
    {
        std::vector<std::uint8_t> Header;
        std::vector<std::uint8_t> Participant;  // its announcement
        std::string Name;                       // in it
        std::vector<HostAddress> Hosts;         // in it
        std::int64_t Announced = 0;             // number of its announcement, counted from 1
        std::map<EntityId, Stream> Streams;
        bool IsKnown = false;  // the implementation has answered since the last retry
        BackoffTimer<TimePoint> Retry{{FirstRetry, LongestRetry, 2.0, MostRetries}};
        std::optional<TimePoint> AnswerAt;
        TimePoint Answered{};
    };

    static void RemoveMissing(Stream &stream, EntityId writer, const GuidPrefix &peer,
                              const std::set<EntityId> &present);
    static bool IsSettled(const Peer &peer);
    void Answer(Peer &peer, TimePoint now);
    void Say(const GuidPrefix &name, Peer &peer, bool all, const OwnCard &own,
             std::vector<Message> &messages);

    const Duration _memory;
    GuidPrefix _self{};
    std::uint32_t _count = 0;  // of heartbeats and acknowledgements
    std::map<GuidPrefix, Peer> _peers;
    std::vector<Message> _ends;
};

}  // namespace Rabit::Rtps
