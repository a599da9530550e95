// TransportSettings in the vendor's terms.
#pragma once

#include <fastdds/rtps/attributes/RTPSParticipantAttributes.h>
#include <rabit/transport/Transport.h>

#include <chrono>
#include <functional>
#include <memory>
#include <string>

#include "DeferredCall.h"
#include "common/DiscoveryRate.h"
#include "common/SessionLog.h"
#include "guard/RtpsMessage.h"
#include "rtps/MeetingThread.h"

namespace Rabit::FastDds
{

// What the participant's sockets need; called on threads of the network, as soon as there is a participant.
// But for the first, with the vendor's locks held; of times, the last that is named counts.
struct NetworkCalls
{
    // Have the participant announce itself once more.
    std::function<void()> Announce;
    std::function<void(std::chrono::steady_clock::time_point)> AnnounceAt;
    // Whether a participant listens to the group of discovery.
    std::function<bool(const Rtps::GuidPrefix &)> IsInGroup;
    // Has Owed run.
    std::function<void(std::chrono::steady_clock::time_point)> SendOwedAt;
    std::shared_ptr<DeferredCall> Owed;
    std::shared_ptr<DiscoveryRate> Rate;
    std::shared_ptr<Rtps::MeetingThread> Meeting;
};

// Of the settings, Interfaces are addresses of this host, none for all, and so are the hosts of Peers. Throws
// TransportError for settings that cannot be honoured. The log hears of datagrams that are dropped.
eprosima::fastrtps::rtps::RTPSParticipantAttributes MakeParticipantAttributes(
    const TransportSettings &settings, const std::shared_ptr<SessionLog> &log, NetworkCalls calls);

// Whether a profiles file, if there is one, defines transports. Throws TransportError if it is not accepted.
bool HasOwnTransports(const std::string &profilesFile);

// Switches intraprocess delivery off, once per process.
void SetLibraryDefaults();

}  // namespace Rabit::FastDds
