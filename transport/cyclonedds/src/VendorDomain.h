#pragma once

#include <dds/ddsi/ddsi_guid.h>
#include <rabit/transport/Transport.h>

#include <atomic>
#include <map>
#include <memory>
#include <mutex>
#include <set>
#include <vector>

#include "DirectAnnouncements.h"
#include "Entity.h"
#include "HandshakeEnds.h"
#include "OutboxThread.h"
#include "common/DiscoveryRate.h"
#include "common/HardwareAddresses.h"
#include "common/SessionLog.h"
#include "guard/RtpsGuard.h"
#include "rtps/MeetingThread.h"

namespace Rabit::Cyclone
{

// What the vendor calls a domain: sockets, threads, discovery and a configuration. Each session has its own.
class VendorDomain
{
public:
    // Throws TransportError. What the vendor says of the domain goes to the log.
    // The exchange of cards and of keys stays within `rate`.
    VendorDomain(const TransportSettings &settings, const std::shared_ptr<SessionLog> &log,
                 std::shared_ptr<DiscoveryRate> rate);
    ~VendorDomain();
    VendorDomain(const VendorDomain &) = delete;
    VendorDomain &operator=(const VendorDomain &) = delete;

    // The number by which this process's vendor knows it; not that of the network.
    dds_domainid_t Id() const { return _id; }
    // Announces a participant of it to all, now.
    void Announce(const ddsi_guid_t &participant) const;
    // Whether somebody whom that participant knows has not shown that it knows it.
    bool IsUnheard(const ddsi_guid_t &participant) const;
    // Whether the participant of the domain exchanges cards (rtps/Meeting.h).
    bool HasCard() const { return _meets; }
    // Whether another participant does.
    bool IsReplayed(const Rtps::GuidPrefix &participant) const
    {
        return _meets && _meeting.IsReplayed(participant);
    }
    // The vendor has lost another participant.
    void Lost(const Rtps::GuidPrefix &participant);
    // Whether the vendor was told here that it is gone, because it was silent.
    bool WasEnded(const Rtps::GuidPrefix &participant) const { return _meeting.WasEnded(participant); }

private:
    static bool MaySend(void *self, unsigned char *datagram, std::size_t size,
                        const RabitCycloneRoute *route);
    static bool Hold(void *self, const unsigned char *datagram, std::size_t size,
                     const RabitCycloneRoute *route);
    static RabitCycloneWays WaysTo(void *self, const unsigned char *address);
    static void OnSent(void *self, const unsigned char *head, std::size_t headSize, std::size_t size);
    static std::size_t OnReceived(void *self, unsigned char *datagram, std::size_t size, std::size_t capacity,
                                  const unsigned char *from, bool direct);
    // Looked at whenever something is said or comes: the vendor itself says something every now and then.
    void RepeatHandshakes();
    // How long what the vendor may see of a datagram is.
    std::size_t Admit(std::span<std::uint8_t> buffer, std::size_t size, const Rtps::HostAddress &from);
    // How a card reaches one participant, or all.
    void NoteRoute(std::span<const std::uint8_t> datagram, const RabitCycloneRoute &route);
    void NoteAnnouncement(const RabitCycloneRoute &route, bool isGroup);
    // Both on the thread of the meeting.
    void SendCard(const std::optional<Rtps::GuidPrefix> &to, std::span<const std::uint8_t> datagram);
    void DeliverCard(const Rtps::HostAddress &from, std::span<std::uint8_t> datagram);
    // Puts what cards say before a datagram that came.
    std::size_t JoinDelivered(std::span<std::uint8_t> buffer, std::size_t size);

    dds_domainid_t _id = 0;
    void *_watch = nullptr;  // of what it sends
    const std::shared_ptr<SessionLog> _log;
    const bool _multicast;  // reaches all, but for who announces itself to us alone
    const bool _secured;
    const bool _hasPeers;  // listed, who may not hear the group
    std::atomic<bool> _meets{false};
    Rtps::MeetingThread _meeting;
    std::mutex _cardMutex;
    // Guarded by _cardMutex: the ways that announcements take, to the group first; and to single
    // participants.
    std::map<const void *, RabitCycloneRoute> _groups;
    std::vector<RabitCycloneRoute> _listed;
    std::map<Rtps::GuidPrefix, RabitCycloneRoute> _cardRoutes;
    std::vector<std::vector<std::uint8_t>> _delivered;  // for the vendor; guarded by _cardMutex
    DirectAnnouncements _direct;
    HandshakeEnds _handshakes;
    Rtps::RtpsGuard _guard;
    HardwareAddresses _addresses;
    const std::shared_ptr<DiscoveryRate> _rate;
    OutboxThread _outbox;
    Entity _entity;
};

}  // namespace Rabit::Cyclone
