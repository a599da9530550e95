#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "World.h"
#include "envelope/SealedCore.h"
#include "envelope/Sealer.h"

namespace Rabit::Simulated
{

// Seals and opens the datagrams of a participant that is a member of a fleet, by the real seal, in simulated
// time. Simulated datagrams are no bytes, so a small RTPS message is sealed in the place of each: a card
// itself, an announcement with the participant's address, an empty message for all else. A datagram arrives
// if the receiver's seal opens that message.
//
// Not thread-safe: guarded by the network's mutex.
class SealStage
{
public:
    using TimePoint = Envelope::TimePoint;

    // The bytes that a seal adds to a datagram for several receivers: the header, the signature and the tag,
    // in place of the RTPS header.
    static constexpr std::size_t AddedForGroup =
        Envelope::OuterSize + sizeof(Envelope::Signature) + Envelope::TagSize - Rtps::RtpsHeaderSize;

    // `seed`: of the session's random bytes. Throws TransportError.
    SealStage(const std::shared_ptr<FleetMember> &member, ParticipantId self, std::uint64_t seed,
              TimePoint now);

    struct Sealed
    {
        std::shared_ptr<const std::vector<std::uint8_t>> Bytes;  // null: it must not be sent
        std::size_t Added = 0;                                   // to the RTPS message
    };
    // `to`: Nobody for a group.
    Sealed Seal(const Datagram &datagram, ParticipantId to, TimePoint now);
    // `sealed`: null for a plain datagram, which does not open either.
    bool Opens(const std::vector<std::uint8_t> *sealed, ParticipantId from, TimePoint now);

    // As those of SealedCore.
    std::optional<TimePoint> LocalDue() const { return _core->LocalDue(); }
    std::optional<TimePoint> NetworkDue() const { return _core->NetworkDue(); }
    void Learn() { _core->Learn(); }
    std::size_t DueBytes(TimePoint now) { return _core->DueBytes(now); }
    std::optional<std::vector<std::uint8_t>> TakeDue(TimePoint now) { return _core->TakeDue(now); }
    std::vector<std::string> TakeLogs() { return _core->TakeLogs(); }

    // The name in the certificate by which a participant speaks, and whether it may write (else read) a
    // topic. Empty, and false: no certificate is known.
    std::optional<std::string> NameOf(ParticipantId peer) const;
    bool May(ParticipantId peer, bool write, std::string_view topic) const;

private:
    const std::vector<std::uint8_t> _announcement;
    const std::vector<std::uint8_t> _other;
    std::unique_ptr<Envelope::SealedCore> _core;
};

}  // namespace Rabit::Simulated
