#pragma once

#include <rabit/gateway/ConfigError.h>
#include <rabit/gateway/GatewayConfig.h>

#include <functional>
#include <string>

namespace Rabit
{

// Reads a gateway's YAML file and validates it. The keys are those of GatewayConfig in lower case with
// underscores; docs/reference/configuration.md is about them. `node` may be missing if nodeOverride is not
// empty, which takes its place either way, so that one file can serve a fleet. Throws ConfigError: an
// unreadable file, broken YAML, an unknown or repeated key, a value of the wrong kind or out of range, an
// unknown IDL type; each with file, line and the nearest right word.
GatewayConfig LoadGatewayConfig(const std::string &file, const std::string &nodeOverride = "");

// Returns why there is no such IDL type, for the error message; empty if there is one.
using TypeCheck = std::function<std::string(const std::string &type)>;

// The same for a program that was not built with the types of that node: `whyNoType` tells which there are.
GatewayConfig LoadGatewayConfig(const std::string &file, const std::string &nodeOverride,
                                const TypeCheck &whyNoType);

// The same of a text in the form of such a file. `name` stands in errors in place of the file's; empty:
// errors name no place.
GatewayConfig ParseGatewayConfig(const std::string &text, const std::string &name,
                                 const std::string &nodeOverride = "");
GatewayConfig ParseGatewayConfig(const std::string &text, const std::string &name,
                                 const std::string &nodeOverride, const TypeCheck &whyNoType);

// The same for a program that is another node in that network, perhaps one that knows none of the types: the
// sections publish, subscribe, accept, send and foreign of the file are ignored.
GatewayConfig LoadNetworkConfig(const std::string &file);

}  // namespace Rabit
