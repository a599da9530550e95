// TransportSettings in the vendor's terms.
#pragma once

#include <rabit/transport/Transport.h>

#include <memory>
#include <string>

#include "GuardedUdp.h"
#include "Vendor.h"
#include "common/SessionLog.h"

namespace Rabit::FastDds
{

// In `settings`, Interfaces are addresses of this host (empty: all), and the hosts of Peers are addresses.
// Throws TransportError for settings that cannot be honoured. `log` counts dropped datagrams. `udp`: has the
// calls and objects that are to be used; the rest is set here.
rtps::RTPSParticipantAttributes MakeParticipantAttributes(const TransportSettings &settings,
                                                          const std::shared_ptr<SessionLog> &log,
                                                          GuardedUdpDescriptor::Settings udp);

// Throws TransportError if the profiles file, if any, cannot be read, is refused by the vendor or configures
// DDS Security. With a member of a fleet with keys it also throws if some datagrams would not be sealed.
void CheckConfig(const TransportSettings &settings);

// True if the profiles file, if any, defines transports. Throws TransportError if the vendor refuses the
// file.
bool HasOwnTransports(const std::string &profilesFile);

// Switches intraprocess delivery off, once per process.
void SetLibraryDefaults();

}  // namespace Rabit::FastDds
