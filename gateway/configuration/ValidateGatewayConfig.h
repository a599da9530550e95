#pragma once

#include <rabit/gateway/GatewayConfig.h>
#include <rabit/gateway/LoadGatewayConfig.h>

#include <string>

namespace Rabit
{

// The TypeCheck of a program that has the types it names: they are in the MessageTypeRegistry.
std::string WhyNotLinked(const std::string &type);

// ValidateGatewayConfig with other types than those.
void ValidateGatewayConfig(const GatewayConfig &config, const TypeCheck &whyNoType);

}  // namespace Rabit
