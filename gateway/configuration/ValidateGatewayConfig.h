#pragma once

#include <rabit/gateway/GatewayConfig.h>
#include <rabit/gateway/LoadGatewayConfig.h>

#include <string>

namespace Rabit
{

// The TypeCheck of a program that is linked with the types that it names: it looks them up in the
// MessageTypeRegistry.
std::string WhyNotLinked(const std::string &type);

// Does the same as ValidateGatewayConfig(config), with another TypeCheck.
void ValidateGatewayConfig(const GatewayConfig &config, const TypeCheck &whyNoType);

}  // namespace Rabit
