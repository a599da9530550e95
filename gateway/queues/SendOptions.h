#pragma once

#include <rabit/gateway/GatewayConfig.h>
#include <rabit/gateway/links/LinkOptions.h>

#include <string_view>
#include <vector>

namespace Rabit
{

// The first rule that fits; null: none.
const SendRule *FindSendRule(const std::vector<SendRule> &rules, std::string_view node,
                             std::string_view queue);
// How messages to that queue of that node are kept: by the first rule that fits, or by default.
LinkOptions SendOptions(const std::vector<SendRule> &rules, std::string_view node, std::string_view queue);

}  // namespace Rabit
