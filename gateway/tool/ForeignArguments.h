#pragma once

#include <rabit/dynamic/DynamicType.h>
#include <rabit/gateway/ForeignRule.h>
#include <rabit/gateway/GatewayConfig.h>

#include <memory>
#include <string>
#include <vector>

namespace CLI
{
class App;
}  // namespace CLI

namespace Rabit::Tool
{

// Options of the commands that read topics of programs without a gateway, such as those of ROS 2.
struct ForeignOptions
{
    std::vector<std::string> Types;  // of the topics, in their order
    // Files with their definitions, or folders of packages of ROS 2. None: the packages that
    // AMENT_PREFIX_PATH of the environment names.
    std::vector<std::string> Idl;
};

// Adds --type and --idl.
void AddForeignOptions(CLI::App &command, ForeignOptions &options);

// A topic of foreign programs that the command line names.
struct ForeignArgument
{
    ForeignRule Rule;  // the newest sample is the local message of the topic's name on the wire
    std::shared_ptr<const DynamicType> Type;
};

// Moves the topics of foreign programs out of `what`. Names that begin with `/` or `rt/` are topics of ROS 2.
// If each name has a --type, all are topics, and the others have their names on the wire. The types are in
// the MessageTypeRegistry afterwards. Throws ConfigError if a topic has no type, or a type no definition.
std::vector<ForeignArgument> TakeForeign(const ForeignOptions &options, std::vector<std::string> &what);

// Has the tool read these topics. Throws ConfigError if a name is impossible, or if the tool has keys: it
// would hear no program without.
void AddForeign(const std::vector<ForeignArgument> &topics, GatewayConfig &config);

}  // namespace Rabit::Tool
