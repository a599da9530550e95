// TransportSettings in the vendor's terms.
#pragma once

#include <fastdds/rtps/attributes/RTPSParticipantAttributes.h>
#include <rabit/transport/Transport.h>

#include <chrono>
#include <functional>
#include <memory>
#include <string>

#include "common/SessionLog.h"

namespace Rabit::FastDds
{

// Has the participant announce itself once more. Both are called on threads of the network, as soon as there
// is a participant; the second with the vendor's locks held, and the last time that it names counts.
struct AnnounceCalls
{
    std::function<void()> Now;
    std::function<void(std::chrono::steady_clock::time_point)> At;
};

// Of the settings, Interfaces are addresses of this host, none for all, and so are the hosts of Peers. Throws
// TransportError for settings that cannot be honoured. The log hears of datagrams that are dropped.
eprosima::fastrtps::rtps::RTPSParticipantAttributes MakeParticipantAttributes(
    const TransportSettings &settings, const std::shared_ptr<SessionLog> &log, AnnounceCalls announce);

// Whether a profiles file, if there is one, defines transports. Throws TransportError if it is not accepted.
bool HasOwnTransports(const std::string &profilesFile);

// Switches intraprocess delivery off, once per process.
void SetLibraryDefaults();

}  // namespace Rabit::FastDds
