#pragma once

#include <rabit/transport/Transport.h>

#include <atomic>
#include <cstdint>
#include <memory>
#include <optional>

#include "AnnouncementTimer.h"
#include "GuardedUdp.h"
#include "Vendor.h"
#include "common/ProcessNumber.h"
#include "common/VendorCore.h"
#include "envelope/SealedSession.h"
#include "rtps/MeetingThread.h"

namespace Rabit::FastDds
{

// The participant of a session.
class SessionCore final : public VendorCore, private ParticipantEvents
{
public:
    using GuidPrefix = rtps::GuidPrefix_t;

    // Joins the network. Throws TransportError.
    SessionCore(const TransportSettings &settings, const SessionContext &context);
    // Leaves the network.
    ~SessionCore() override;
    SessionCore(const SessionCore &) = delete;
    SessionCore &operator=(const SessionCore &) = delete;

    // VendorCore::Close
    void Close();

    rtps::RTPSParticipant &Participant() { return *_participant; }
    bool IsOwn(const GuidPrefix &prefix) const;
    // True if samples for several readers go by multicast.
    bool HasMulticast() const { return _multicast; }

private:
    std::optional<SettingsProblem> MeetingProblem() const override { return _meeting->Problem(); }
    void OnParticipant(const ParticipantNews &news) override;
    void OnEndpoint(const EndpointNews &news) override;
    // Leaves the network with a participant that may be incomplete.
    void Leave();
    // Called on a thread of the network, also before the participant is complete.
    void Announce();
    void PeerAppeared(const ParticipantNews &peer);
    void PeerGone(const Rtps::GuidPrefix &peer, PeerEvent::Kind how);

    HandlerGate _announceGate;
    const bool _multicast;
    const std::shared_ptr<Rtps::MeetingThread> _meeting;
    const std::shared_ptr<Envelope::SealedSession> _seal;  // null without a member
    // The vendor would give each participant of a process the next number, and with it the next ports, even
    // if earlier participants are gone. A session that joins the network anew would leave the ports at which
    // peers look for it, and run out of ports in the end. The search for ports starts with this number; the
    // vendor skips ports that another process has.
    const ProcessNumber<SessionCore> _number{0, 1};
    AnnouncementTimer _announceTimer;
    std::atomic<rtps::RTPSParticipant *> _participant = nullptr;
    std::atomic<std::uint32_t> _deafAt{0};  // port of a group at which the vendor could not listen; 0: none
};

}  // namespace Rabit::FastDds
