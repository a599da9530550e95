#pragma once

#include <rabit/transport/Transport.h>

#include <atomic>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "common/HandlerGate.h"
#include "common/Ledger.h"
#include "common/ParticipantIdentity.h"
#include "common/PeerPlace.h"
#include "common/PeerSessions.h"
#include "common/RecentGoodbyes.h"
#include "common/RecentMap.h"
#include "common/Rtps.h"
#include "common/SessionContext.h"

namespace Rabit
{

// The common part of what all vendors' sessions share with their writers and readers: the peers.
//
// Lives until the session and all its writers and readers are gone. So a writer that outlives its session
// fails instead of touching freed memory. Thread-safe.
class VendorCore
{
public:
    // When this returns, no peer handler runs any more, and writes fail.
    void Close();
    bool IsClosed() const { return _closed; }
    // Identity of the present or former participant of a writer or reader; nullptr if it is not a Rabit node,
    // or unknown.
    std::shared_ptr<const PeerSession> IdentityOf(const WriterId &endpoint) const;
    // The participants to which samples written to the node go (PeerSessions), one after the other, under a
    // lock: visit(prefix).
    template <typename Visit>
    void VisitParticipantsOf(const std::string &node, const Visit &visit) const
    {
        const std::lock_guard lock(_mutex);
        _peers.VisitOf(node, visit);
    }
    // As BackendSession.
    std::vector<SettingsProblem> Problems() const;
    // The addresses of the Rabit nodes that it knows.
    std::vector<PeerPlace> PeerPlaces() const;
    const std::shared_ptr<SessionLog> &Log() const { return _context.Log; }
    TopicRegistry &Topics() { return *_context.Topics; }

protected:
    VendorCore(const TransportSettings &settings, const SessionContext &context);
    ~VendorCore() = default;

    // The vendor has found a Rabit node, perhaps once more. It is not admitted if it said goodbye a moment
    // ago: the vendor may handle an announcement after a goodbye that overtook it.
    void Appeared(const Rtps::GuidPrefix &participant, const ParticipantIdentity &who,
                  const PeerPlace &place);
    // The vendor has lost the participant.
    void Gone(const Rtps::GuidPrefix &participant, PeerEvent::Kind how);

    const SessionContext _context;
    // The guard notes them, before the vendor sees them.
    const std::shared_ptr<Rtps::RecentGoodbyes> _goodbyes = std::make_shared<Rtps::RecentGoodbyes>();
    // The guard keeps them. The session closes that of a participant which the vendor has lost.
    const std::shared_ptr<Rtps::Ledger> _accounts;

private:
    using Identity = std::shared_ptr<const PeerSession>;

    // Number of departed participants that are remembered: the instances of their writers end later.
    static constexpr std::size_t MostGone = 64;

    // The reason why other nodes are not told of all endpoints, if there is one (rtps/MeetingThread.h).
    virtual std::optional<SettingsProblem> MeetingProblem() const = 0;
    // Makes a call of the peer handler, here or on another thread, in the order of the events.
    virtual void Run(std::function<void()> call) { call(); }
    void Tell(PeerEvent::Kind what, const Identity &who);

    HandlerGate _peerGate;
    std::atomic<bool> _closed{false};
    mutable std::mutex _mutex;
    PeerSessions<Rtps::GuidPrefix> _peers;          // Rabit nodes; guarded by _mutex, like those below
    std::map<Rtps::GuidPrefix, PeerPlace> _places;  // of the peers
    RecentMap<Rtps::GuidPrefix, Identity> _gone{MostGone};
};

}  // namespace Rabit
