#pragma once

#include <rabit/gateway/GatewayConfig.h>
#include <rabit/gateway/LoadGatewayConfig.h>

#include <string>

namespace Rabit::Tool
{

// Reads a configuration for `rabit keys`. Types do not matter to keys, so any type name will do. Throws
// ConfigError.
inline GatewayConfig ConfigForKeys(const std::string &file, const std::string &node)
{
    return LoadGatewayConfig(file, node, [](const std::string &) { return std::string(); });
}

}  // namespace Rabit::Tool
