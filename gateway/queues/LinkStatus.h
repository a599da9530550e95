#pragma once

#include <rabit/gateway/links/LinkNode.h>

#include <vector>

#include "gateway.idl.h"
#include "queues/IncomingQueues.h"

namespace Rabit::LinkStatus
{

// What Gateway/Fleet shows of the links, in the order of their names. Under the lock of who drives them.

std::vector<Gateway::LinkStatus> Outbound(const LinkNode &links);
std::vector<Gateway::InboundStatus> Inbound(const LinkNode &links, const IncomingQueues &incoming);

}  // namespace Rabit::LinkStatus
