#pragma once

// Rabit::Gateway::Fleet, the local message Gateway/Fleet: the other nodes and their states, counters, and by
// name what keeps data from flowing. Defined in idl/messages/gateway.idl, which says what each member is.
//
//     AddPublishSubscribeMessage("Gateway/Fleet", _fleet);  // std::shared_ptr<Rabit::Gateway::Fleet>
#include "gateway.idl.h"
