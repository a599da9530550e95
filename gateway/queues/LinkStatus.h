#pragma once

#include <rabit/gateway/links/LinkNode.h>

#include <vector>

#include "gateway.idl.h"

namespace Rabit::LinkStatus
{

// The rows of the links in Gateway/Fleet, in the order of their names. Call under the lock of the links'
// driver.

std::vector<Gateway::LinkStatus> Outbound(const LinkNode &links);
std::vector<Gateway::InboundStatus> Inbound(const LinkNode &links);

}  // namespace Rabit::LinkStatus
