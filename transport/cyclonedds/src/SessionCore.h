// State that a session shares with its writers and readers: the participant, its peers and their topics.
#pragma once

#include <rabit/transport/Transport.h>

#include <atomic>
#include <chrono>
#include <deque>
#include <map>
#include <memory>
#include <mutex>
#include <vector>

#include "AnnouncementThread.h"
#include "Entity.h"
#include "Guid.h"
#include "VendorDomain.h"
#include "Worker.h"
#include "common/HandlerGate.h"
#include "common/ParticipantIdentity.h"
#include "common/PeerPlace.h"
#include "common/PeerProof.h"
#include "common/PeerSessions.h"
#include "common/SessionLog.h"
#include "common/TopicRegistry.h"

namespace Rabit::Cyclone
{

// Lives until the session and all its writers and readers are gone, so that a writer that outlives its
// session fails instead of touching freed memory. Only these own it, so a thread of the vendor's is never its
// last owner. Thread-safe.
class SessionCore
{
public:
    // Joins the network. Throws TransportError.
    SessionCore(const TransportSettings &settings, PeerHandler onPeer, std::shared_ptr<DiscoveryTurns> turns);
    // Leaves the network.
    ~SessionCore();
    SessionCore(const SessionCore &) = delete;
    SessionCore &operator=(const SessionCore &) = delete;

    // When this returns, no peer handler runs any more, and writes fail.
    void Close();
    bool IsClosed() const { return _closed; }

    dds_entity_t Participant() const { return _participant.Get(); }
    // Identity of a writer's present or former participant; nullptr if it is not a Rabit node, or unknown.
    std::shared_ptr<const PeerSession> IdentityOf(const WriterId &writer) const;
    // The participants to which samples written to the node go (PeerSessions).
    std::vector<ddsi_guid_t> ParticipantsOf(const std::string &node) const;
    // The addresses of the Rabit nodes that it knows.
    std::vector<PeerPlace> PeerPlaces() const;
    const std::shared_ptr<SessionLog> &Log() const { return _log; }
    TopicRegistry &Topics() { return _topics; }

private:
    using Identity = std::shared_ptr<const PeerSession>;

    static void OnParticipants(dds_entity_t reader, void *self);
    template <bool isWriter>
    static void OnEndpoints(dds_entity_t reader, void *self);
    void PeerAppeared(const Prefix &prefix, const dds_qos_t *qos);
    void PeerGone(const Prefix &prefix);
    void Tell(PeerEvent::Kind kind, const Identity &identity);

    const std::shared_ptr<SessionLog> _log;
    TopicRegistry _topics;
    HandlerGate _peerGate;
    const PeerHandler _onPeer;
    const PeerProof _proof;
    std::atomic<bool> _closed{false};
    Prefix _own{};  // set before anything is discovered
    mutable std::mutex _mutex;
    PeerSessions<Prefix> _peers;          // Rabit nodes; guarded by _mutex
    std::map<Prefix, PeerPlace> _places;  // of the peers; guarded by _mutex
    std::map<Prefix, Identity> _gone;     // the last peers that went; guarded by _mutex
    std::deque<Prefix> _goneOrder;        // guarded by _mutex
    // Runs the peer handler, because the vendor reports peers with its own locks held.
    Worker _worker;
    VendorDomain _domain;
    AnnouncementThread _announcements;
    Entity _participant;  // last member, so that no listener runs when the others are destroyed
};

}  // namespace Rabit::Cyclone
