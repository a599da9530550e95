// TransportSettings in the vendor's terms.
#pragma once

#include <fastdds/rtps/attributes/RTPSParticipantAttributes.h>
#include <rabit/transport/Transport.h>

#include <chrono>
#include <functional>
#include <memory>
#include <string>

#include "DeferredCall.h"
#include "common/SessionLog.h"
#include "guard/AuthenticationThread.h"
#include "guard/RtpsMessage.h"
#include "rtps/MeetingThread.h"

namespace Rabit::FastDds
{

// Calls that the participant's sockets make, on threads of the network, from the participant's creation on.
// All but the first are made with the vendor's locks held. Of several times given, the last one counts.
struct NetworkCalls
{
    // Announce the participant once more, now or at a time.
    std::function<void()> Announce;
    std::function<void(std::chrono::steady_clock::time_point)> AnnounceAt;
    // Returns true if a participant listens to the discovery group.
    std::function<bool(const Rtps::GuidPrefix &)> IsInGroup;
    // Has Owed run at that time.
    std::function<void(std::chrono::steady_clock::time_point)> SendOwedAt;
    std::shared_ptr<DeferredCall> Owed;
    std::shared_ptr<DiscoveryTurns> Turns;
    std::shared_ptr<Rtps::MeetingThread> Meeting;
    std::shared_ptr<Rtps::AuthenticationThread> Authentication;
    // Where the guard notes the goodbyes of known participants.
    std::shared_ptr<Rtps::RecentGoodbyes> Goodbyes;
};

// In `settings`, Interfaces are addresses of this host (empty: all), and the hosts of Peers are addresses.
// Throws TransportError for settings that cannot be honoured. `log` counts dropped datagrams.
eprosima::fastrtps::rtps::RTPSParticipantAttributes MakeParticipantAttributes(
    const TransportSettings &settings, const std::shared_ptr<SessionLog> &log, NetworkCalls calls);

// True if the profiles file, if any, defines transports. Throws TransportError if the vendor refuses the
// file.
bool HasOwnTransports(const std::string &profilesFile);

// Switches intraprocess delivery off, once per process.
void SetLibraryDefaults();

}  // namespace Rabit::FastDds
