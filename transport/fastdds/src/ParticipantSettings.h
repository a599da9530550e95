// TransportSettings in the vendor's terms.
#pragma once

#include <fastdds/rtps/attributes/RTPSParticipantAttributes.h>
#include <rabit/transport/Transport.h>

#include <memory>

#include "common/SessionLog.h"

namespace Rabit::FastDds
{

// Throws TransportError for settings that cannot be honoured. The log hears of datagrams that are dropped.
eprosima::fastrtps::rtps::RTPSParticipantAttributes MakeParticipantAttributes(
    const TransportSettings &settings, const std::shared_ptr<SessionLog> &log);

// Switches intraprocess delivery off, once per process.
void SetLibraryDefaults();

}  // namespace Rabit::FastDds
