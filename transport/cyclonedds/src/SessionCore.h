#pragma once

#include <rabit/transport/Transport.h>

#include <functional>
#include <optional>
#include <utility>

#include "AnnouncementThread.h"
#include "Entity.h"
#include "Guid.h"
#include "VendorDomain.h"
#include "Worker.h"
#include "common/VendorCore.h"

namespace Rabit::Cyclone
{

// The participant of a session. Only the session and its writers and readers own it, so a thread of the
// vendor's is never its last owner.
class SessionCore final : public VendorCore
{
public:
    // Joins the network. Throws TransportError.
    SessionCore(const TransportSettings &settings, const SessionContext &context);
    // Leaves the network.
    ~SessionCore();
    SessionCore(const SessionCore &) = delete;
    SessionCore &operator=(const SessionCore &) = delete;

    dds_entity_t Participant() const { return _participant.Get(); }

private:
    static void OnParticipants(dds_entity_t reader, void *self);
    template <bool isWriter>
    static void OnEndpoints(dds_entity_t reader, void *self);
    void PeerAppeared(const Rtps::GuidPrefix &prefix, const dds_qos_t *qos);
    void PeerGone(const Rtps::GuidPrefix &prefix);
    std::optional<SettingsProblem> MeetingProblem() const override { return _domain.Problem(); }
    void Run(std::function<void()> call) override { _worker.Post(std::move(call)); }

    Rtps::GuidPrefix _own{};  // set before anything is discovered
    // Runs the peer handler, because the vendor reports peers with its own locks held.
    Worker _worker;
    VendorDomain _domain;
    AnnouncementThread _announcements;
    Entity _participant;  // last member, so that no listener runs when the others are destroyed
};

}  // namespace Rabit::Cyclone
