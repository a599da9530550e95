// TransportSettings in the vendor's terms.
#pragma once

#include <fastdds/rtps/attributes/RTPSParticipantAttributes.h>
#include <rabit/transport/Transport.h>

namespace Rabit::FastDds
{

// Throws TransportError for settings that cannot be honoured.
eprosima::fastrtps::rtps::RTPSParticipantAttributes MakeParticipantAttributes(
    const TransportSettings &settings);

// Switches intraprocess delivery off, once per process.
void SetLibraryDefaults();

}  // namespace Rabit::FastDds
