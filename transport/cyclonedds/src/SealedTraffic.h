#pragma once

#include <rabit/transport/Transport.h>

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>

#include "VendorTraffic.h"
#include "envelope/SealedSession.h"

namespace Rabit::Cyclone
{

// Throws TransportError if the datagrams of a session with a member cannot all be sealed with these settings,
// as far as that is known without a domain.
void CheckSealable(const TransportSettings &settings);

// The seal of a domain, between the vendor and its sockets. Thread-safe.
class SealedTraffic
{
public:
    // As SealedSession has them. Send may be called as soon as there was a datagram to seal. Throws
    // TransportError.
    SealedTraffic(const std::shared_ptr<FleetMember> &member, const std::shared_ptr<DiscoveryTurns> &turns,
                  Envelope::SealedSession::Calls calls);
    // When this returns, Send is not in progress and will not be called. Seal and Open go on.
    void Stop() { _session.Stop(); }

    // Begins the session of the domain's participant, unless its first message has begun it. Without
    // multicast and peers there is no message before another node is known.
    void Begin(const Rtps::GuidPrefix &own);
    // As RabitCycloneCalls::seal. Begins the session with the vendor's first RTPS message, whose header has
    // the prefix of the domain's participant. A card that comes before the session is not sent.
    RabitCycloneSealed Seal(std::span<const ddsrt_iovec_t> parts, const RabitCyclonePlace *to);
    // Opens a datagram in place. Returns the size of the message at its beginning; 0: there is none.
    std::size_t Open(std::span<std::uint8_t> datagram, const Rtps::Place &from);

    // The most bytes that sealing adds.
    std::size_t MostAdded() const { return _session.MostAdded(); }

    const Envelope::SealedSession &Session() const { return _session; }

private:
    void Begin(const Envelope::RtpsHeader &vendor);

    const Envelope::SealedSession::Calls _calls;
    Envelope::SealedSession _session;
};

}  // namespace Rabit::Cyclone
