// What a session shares with its writers and readers: the participant and what it knows of the network.
#pragma once

#include <rabit/transport/Transport.h>

#include <atomic>
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
#include "common/DiscoveryRate.h"
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
// session fails instead of touching freed memory. Only they own it: its last owner is never a thread of the
// vendor's. Thread-safe.
class SessionCore
{
public:
    // Joins the network. Throws TransportError.
    SessionCore(const TransportSettings &settings, PeerHandler onPeer, std::shared_ptr<DiscoveryRate> rate);
    // Leaves it.
    ~SessionCore();
    SessionCore(const SessionCore &) = delete;
    SessionCore &operator=(const SessionCore &) = delete;

    // No peer handler runs afterwards, and writes fail.
    void Close();
    bool IsClosed() const { return _closed; }

    dds_entity_t Participant() const { return _participant.Get(); }
    // Who a writer's participant is or was; nullptr if it is not a Rabit node, or unknown.
    std::shared_ptr<const PeerSession> IdentityOf(const WriterId &writer) const;
    // The participants to which goes what is written to the node (PeerSessions).
    std::vector<ddsi_guid_t> ParticipantsOf(const std::string &node) const;
    // Where the Rabit nodes are that it knows.
    std::vector<PeerPlace> PeerPlaces() const;
    const std::shared_ptr<SessionLog> &Log() const { return _log; }
    TopicRegistry &Topics() { return _topics; }

private:
    using Identity = std::shared_ptr<const PeerSession>;

    struct Gone
    {
        Identity Who;
        PeerEvent::Kind How;
    };

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
    std::map<Prefix, PeerPlace> _places;  // of those; guarded by _mutex
    std::map<Prefix, Gone> _gone;         // the last that went; guarded by _mutex
    std::deque<Prefix> _goneOrder;        // guarded by _mutex
    // Tells of peers: the vendor tells us under locks of its own.
    Worker _worker;
    VendorDomain _domain;
    AnnouncementThread _announcements;
    Entity _participant;  // the last, so that no listener runs when the others go
};

}  // namespace Rabit::Cyclone
