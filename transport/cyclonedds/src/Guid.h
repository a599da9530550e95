// The identities of participants, writers and readers in the three forms that the vendor and we use.
#pragma once

#include <dds/dds.h>
#include <dds/ddsi/ddsi_guid.h>
#include <rabit/transport/Transport.h>

#include "common/Rtps.h"

namespace Rabit::Cyclone
{

WriterId ToWriterId(const ddsi_guid_t &guid);
WriterId ToWriterId(const dds_guid_t &guid);
ddsi_guid_t ToVendorGuid(const WriterId &id);
// The participant's own GUID.
ddsi_guid_t ParticipantOf(const Rtps::GuidPrefix &prefix);

}  // namespace Rabit::Cyclone
