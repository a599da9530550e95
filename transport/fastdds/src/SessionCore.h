// State that a session shares with its writers and readers: the participant, its peers and their topics.
#pragma once

#include <fastdds/rtps/common/Guid.h>
#include <fastdds/rtps/participant/RTPSParticipantListener.h>
#include <rabit/transport/Transport.h>

#include <atomic>
#include <map>
#include <memory>
#include <mutex>
#include <set>
#include <string>
#include <vector>

#include "DeferredCall.h"
#include "ParticipantNumber.h"
#include "ParticipantTimer.h"
#include "common/HandlerGate.h"
#include "common/ParticipantIdentity.h"
#include "common/PeerPlace.h"
#include "common/PeerProof.h"
#include "common/PeerSessions.h"
#include "common/SessionLog.h"
#include "common/TopicRegistry.h"
#include "guard/AuthenticationThread.h"
#include "guard/RecentGoodbyes.h"
#include "rtps/MeetingThread.h"

namespace Rabit::FastDds
{

// Lives until the session and all its writers and readers are gone, so that a writer that outlives its
// session fails instead of touching freed memory. Thread-safe.
class SessionCore final : private eprosima::fastrtps::rtps::RTPSParticipantListener
{
public:
    using GuidPrefix = eprosima::fastrtps::rtps::GuidPrefix_t;

    // Joins the network. Throws TransportError.
    SessionCore(const TransportSettings &settings, PeerHandler onPeer, std::shared_ptr<DiscoveryTurns> turns);
    // Leaves the network.
    ~SessionCore() override;
    SessionCore(const SessionCore &) = delete;
    SessionCore &operator=(const SessionCore &) = delete;

    // When this returns, no peer handler runs any more, and writes fail.
    void Close();
    bool IsClosed() const { return _closed; }

    eprosima::fastrtps::rtps::RTPSParticipant &Participant() { return *_participant; }
    bool IsOwn(const GuidPrefix &prefix) const;
    // Identity of a writer's or a reader's participant; nullptr if it is not a Rabit node, or unknown.
    std::shared_ptr<const PeerSession> IdentityOf(const WriterId &endpoint) const;
    // The participants to which samples written to the node go (PeerSessions).
    std::set<GuidPrefix> PrefixesOf(const std::string &node) const;
    // The addresses of the Rabit nodes that it knows.
    std::vector<PeerPlace> PeerPlaces() const;
    const std::shared_ptr<SessionLog> &Log() const { return _log; }
    // True if samples for several readers go by multicast.
    bool HasMulticast() const { return _multicast; }
    TopicRegistry &Topics() { return _topics; }

private:
    void onParticipantDiscovery(eprosima::fastrtps::rtps::RTPSParticipant *participant,
                                eprosima::fastrtps::rtps::ParticipantDiscoveryInfo &&info) override;
    void onReaderDiscovery(eprosima::fastrtps::rtps::RTPSParticipant *participant,
                           eprosima::fastrtps::rtps::ReaderDiscoveryInfo &&info) override;
    void onWriterDiscovery(eprosima::fastrtps::rtps::RTPSParticipant *participant,
                           eprosima::fastrtps::rtps::WriterDiscoveryInfo &&info) override;
    void onParticipantAuthentication(eprosima::fastrtps::rtps::RTPSParticipant *participant,
                                     eprosima::fastrtps::rtps::ParticipantAuthenticationInfo &&info) override;
    template <typename Proxy>
    void NoteEndpoint(const Proxy &endpoint, bool isRemoved);
    // Called on a thread of the network, also before the participant is complete.
    void Announce();
    // True if the participant listens to the discovery group.
    bool IsInGroup(const GuidPrefix &prefix) const;
    void NotePlace(const eprosima::fastrtps::rtps::ParticipantDiscoveryInfo &info);
    void PeerAppeared(const eprosima::fastrtps::rtps::ParticipantProxyData &peer);
    struct Newcomer
    {
        std::shared_ptr<const ParticipantIdentity> Who;
        PeerPlace Place;
    };
    // Name of a Rabit node that is not authenticated yet; empty if unknown. Requires _mutex.
    std::string NameOfNewcomer(const GuidPrefix &prefix) const;
    void Admit(const GuidPrefix &prefix, const Newcomer &newcomer);
    void PeerGone(const GuidPrefix &prefix, PeerEvent::Kind how);

    const std::shared_ptr<SessionLog> _log;
    TopicRegistry _topics;
    HandlerGate _peerGate;
    HandlerGate _announceGate;
    const PeerHandler _onPeer;
    const bool _multicast;
    const PeerProof _proof;
    std::atomic<bool> _closed{false};
    mutable std::mutex _mutex;
    PeerSessions<GuidPrefix> _peers;          // Rabit nodes; guarded by _mutex
    std::map<GuidPrefix, PeerPlace> _places;  // of the peers; guarded by _mutex
    // Rabit nodes that are not authenticated yet; guarded by _mutex
    std::map<GuidPrefix, Newcomer> _unproven;
    std::set<GuidPrefix> _proven;   // authenticated participants; guarded by _mutex
    std::set<GuidPrefix> _inGroup;  // listeners of the discovery group; guarded by _mutex
    // The guard notes them, before the vendor sees them.
    const std::shared_ptr<Rtps::RecentGoodbyes> _goodbyes = std::make_shared<Rtps::RecentGoodbyes>();
    const std::shared_ptr<Rtps::MeetingThread> _meeting;
    const std::shared_ptr<Rtps::AuthenticationThread> _authentication =
        std::make_shared<Rtps::AuthenticationThread>();
    const ParticipantNumber _number;
    ParticipantTimer _announceTimer;
    const std::shared_ptr<DeferredCall> _owed = std::make_shared<DeferredCall>();
    ParticipantTimer _owedTimer;
    std::atomic<eprosima::fastrtps::rtps::RTPSParticipant *> _participant = nullptr;
};

}  // namespace Rabit::FastDds
