#pragma once

#include <dds/ddsi/ddsi_guid.h>
#include <rabit/transport/Transport.h>

#include <algorithm>
#include <atomic>
#include <condition_variable>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <span>
#include <vector>

#include "DirectAnnouncements.h"
#include "Entity.h"
#include "RemoteParticipant.h"
#include "RouteOrder.h"
#include "SealedTraffic.h"
#include "common/HardwareAddresses.h"
#include "common/ProcessNumber.h"
#include "common/RecentGoodbyes.h"
#include "common/SendingTurn.h"
#include "common/SessionLog.h"
#include "guard/RtpsGuard.h"
#include "rtps/CardRoutes.h"
#include "rtps/MeetingThread.h"

namespace Rabit::Cyclone
{

// A domain in the vendor's sense: sockets, threads, discovery and a configuration. Each session has its own.
class VendorDomain
{
public:
    // Throws TransportError. The vendor's messages about the domain go to the log. Cards and introductions
    // wait for `turns`; `sending` keeps the samples of its thread. `goodbyes`, `accounts`: as RtpsGuard.
    VendorDomain(const TransportSettings &settings, const std::shared_ptr<SessionLog> &log,
                 const std::shared_ptr<DiscoveryTurns> &turns, std::shared_ptr<SendingTurn> sending,
                 std::shared_ptr<Rtps::RecentGoodbyes> goodbyes, std::shared_ptr<Rtps::Ledger> accounts);
    ~VendorDomain();
    VendorDomain(const VendorDomain &) = delete;
    VendorDomain &operator=(const VendorDomain &) = delete;

    // The domain's number in this process. It may differ from the one on the network; it does not if that is
    // free, so that a vendor's file that names the domain applies.
    dds_domainid_t Id() const { return _id.Get(); }
    // The domain's participant exists: it can answer others before it has sent anything.
    void Begin(const Rtps::GuidPrefix &own);
    // Announces a participant of the domain to all, now.
    void Announce(const ddsi_guid_t &participant) const;
    // True if a peer known to that participant has not shown yet that it knows the participant.
    bool IsUnheard(const ddsi_guid_t &participant) const;
    // True if the domain's participant exchanges cards (rtps/Meeting.h).
    bool HasCard() const { return _meets; }
    // True if the vendor learns of another participant by its card.
    bool IsReplayed(const Rtps::GuidPrefix &participant) const
    {
        return _meets && _meeting.IsReplayed(participant);
    }
    // MeetingThread::Problem
    std::optional<SettingsProblem> Problem() const { return _meeting.Problem(); }
    // The vendor knows another participant, and does not know it any more. Call from a listener of a built-in
    // topic.
    void Came(const Rtps::GuidPrefix &participant);
    void Gone(const Rtps::GuidPrefix &participant);
    // The vendor has lost another participant.
    void Lost(const Rtps::GuidPrefix &participant);
    // True if the vendor was told here that the participant is gone, because it was silent.
    bool WasEnded(const Rtps::GuidPrefix &participant) const { return _meeting.WasEnded(participant); }

private:
    static bool MaySend(void *self, unsigned char *datagram, std::size_t size,
                        const RabitCycloneRoute *route);
    static bool Hold(void *self, const unsigned char *datagram, std::size_t size,
                     const RabitCycloneRoute *route);
    static bool IsInTurn(void *self);
    static void Take(void *self, const unsigned char *datagram, std::size_t size,
                     const RabitCycloneRoute *route, RabitCycloneTo to);
    static RabitCycloneWays WaysTo(void *self, const unsigned char *address);
    static bool MayGo(void *self, const RabitCyclonePlace *place, std::size_t size, bool samples);
    static RabitCycloneSealed Seal(void *self, const ddsrt_iovec_t *part, std::size_t parts,
                                   const RabitCyclonePlace *to);
    static void OnSent(void *self, const unsigned char *head, std::size_t headSize, std::size_t size);
    static std::size_t OnReceived(void *self, unsigned char *datagram, std::size_t size, std::size_t capacity,
                                  const RabitCyclonePlace *from, bool direct);
    // Null: the session has no member. Throws TransportError.
    std::unique_ptr<SealedTraffic> MakeSeal(const TransportSettings &settings,
                                            const std::shared_ptr<DiscoveryTurns> &turns);
    // Throws TransportError if a datagram could pass by the seal; the domain is then gone.
    // End the domain, and throw TransportError, if the configuration has DDS Security, or if the keys cannot
    // protect all datagrams.
    void CheckSecurity(const TransportSettings &settings);
    void CheckSeal(const TransportSettings &settings);
    void End();
    // With a seal the domain is deaf at first: what the vendor's receiving thread reads before the sockets
    // are watched is lost. Ends that once the thread reads through OnReceived alone. Returns false if the
    // thread does not answer.
    bool Hear();
    // Bytes of a message that has at most `most` bytes when it is sent.
    std::size_t Unsealed(std::size_t most) const
    {
        return _seal == nullptr ? most : most - std::min(most, _seal->MostAdded());
    }
    // Returns the size of the part of a datagram that the vendor may see.
    std::size_t Admit(std::span<std::uint8_t> buffer, std::size_t size, const Rtps::HostAddress &from);
    // Sends a datagram that is not counted yet.
    void Send(const RabitCycloneRoute &route, RabitCycloneTo to, std::span<const std::uint8_t> datagram);
    // Runs on the meeting's thread, or on that of the session's holder (DiscoveryTurns).
    void SendCard(const std::optional<Rtps::GuidPrefix> &to, std::span<const std::uint8_t> datagram);
    // Without multicast a node that lists no peers learns by an announcement where to ask for the card.
    void NoteHeard(std::span<const std::uint8_t> datagram, const Rtps::HostAddress &host);
    // The ways by which the participant is announced, and without multicast those to
    // SealedSession::Strangers, or to their hosts' usual ports.
    std::vector<RabitCycloneRoute> WaysOfSealed();
    // Runs on the seal's thread, or on that of the session's holder (DiscoveryTurns).
    void SendSealed(std::span<const std::uint8_t> sealed);
    // Runs on the meeting's thread.
    void DeliverCard(const Rtps::HostAddress &from, std::span<std::uint8_t> datagram);
    // Puts messages from cards before a received datagram.
    std::size_t JoinDelivered(std::span<std::uint8_t> buffer, std::size_t size);

    const ProcessNumber<VendorDomain> _id;
    void *_watch = nullptr;  // returned by RabitCycloneWatch
    const std::shared_ptr<SessionLog> _log;
    const std::shared_ptr<SendingTurn> _sending;
    const bool _multicast;  // reaches all peers but those that announce themselves to us alone
    const bool _hasPeers;   // peers are listed; they may not hear the group
    std::atomic<bool> _meets{false};
    Rtps::MeetingThread _meeting;
    std::mutex _cardMutex;
    Rtps::CardRoutes<RabitCycloneRoute, RouteOrder> _cardRoutes;  // guarded by _cardMutex
    // The unicast addresses by which the vendor reaches each other participant; guarded by _cardMutex.
    std::map<Rtps::GuidPrefix, std::vector<RabitCyclonePlace>> _reached;
    std::vector<std::vector<std::uint8_t>> _delivered;  // for the vendor; guarded by _cardMutex
    DirectAnnouncements _direct;
    const std::vector<std::uint16_t> _usualPorts;  // the first ones of UsualDiscoveryPorts
    Rtps::RtpsGuard _guard;
    HardwareAddresses _addresses;
    const std::unique_ptr<SealedTraffic> _seal;  // null: the session has no member
    std::atomic<bool> _isDeaf{false};
    std::mutex _deafMutex;
    std::condition_variable _hasRead;
    bool _readWhileDeaf = false;  // guarded by _deafMutex
    Entity _entity;
};

}  // namespace Rabit::Cyclone
