#pragma once

#include <dds/ddsi/ddsi_guid.h>
#include <rabit/transport/Transport.h>

#include <memory>

#include "DirectAnnouncements.h"
#include "Entity.h"
#include "HandshakeEnds.h"
#include "OutboxThread.h"
#include "common/DiscoveryPace.h"
#include "common/SessionLog.h"
#include "guard/RtpsGuard.h"

namespace Rabit::Cyclone
{

// What the vendor calls a domain: sockets, threads, discovery and a configuration. Each session has its own.
class VendorDomain
{
public:
    // Throws TransportError. What the vendor says of the domain goes to the log.
    // What discovery says of endpoints stays within `pace`.
    VendorDomain(const TransportSettings &settings, const std::shared_ptr<SessionLog> &log,
                 std::shared_ptr<DiscoveryPace> pace);
    ~VendorDomain();
    VendorDomain(const VendorDomain &) = delete;
    VendorDomain &operator=(const VendorDomain &) = delete;

    // The number by which this process's vendor knows it; not that of the network.
    dds_domainid_t Id() const { return _id; }
    // Announces a participant of it to all, now.
    void Announce(const ddsi_guid_t &participant) const;
    // Whether somebody whom that participant knows has not shown that it knows it.
    bool IsUnheard(const ddsi_guid_t &participant) const;

private:
    static bool MaySend(void *self, unsigned char *datagram, std::size_t size,
                        const RabitCycloneRoute *route);
    static bool Hold(void *self, const unsigned char *datagram, std::size_t size,
                     const RabitCycloneRoute *route);
    static void OnSent(void *self, const unsigned char *head, std::size_t headSize, std::size_t size);
    static std::size_t OnReceived(void *self, unsigned char *datagram, std::size_t size, std::size_t capacity,
                                  const unsigned char *from, bool direct);
    // Looked at whenever something is said or comes: the vendor itself says something every now and then.
    void RepeatHandshakes();
    // How long what the vendor may see of a datagram is.
    std::size_t Admit(std::span<std::uint8_t> buffer, std::size_t size, const Rtps::HostAddress &from);

    dds_domainid_t _id = 0;
    void *_watch = nullptr;  // of what it sends
    const std::shared_ptr<SessionLog> _log;
    const bool _multicast;  // reaches all, but for who announces itself to us alone
    const bool _secured;
    DirectAnnouncements _direct;
    HandshakeEnds _handshakes;
    Rtps::RtpsGuard _guard;
    OutboxThread _outbox;
    Entity _entity;
};

}  // namespace Rabit::Cyclone
