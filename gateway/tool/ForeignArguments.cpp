#include "ForeignArguments.h"

#include <rabit/base/ListedNames.h>
#include <rabit/gateway/ConfigError.h>

#include <CLI/CLI.hpp>

#include <cstddef>
#include <cstdlib>
#include <filesystem>
#include <system_error>
#include <utility>

#include "IdlFiles.h"
#include "names/ForeignNames.h"

namespace Rabit::Tool
{
namespace
{

bool IsRosTopic(const std::string &name)
{
    return name.starts_with('/') || name.starts_with("rt/");
}

std::string Replaced(std::string text, const std::string &from, const std::string &to)
{
    for (std::size_t at = text.find(from); at != std::string::npos; at = text.find(from, at + to.size()))
    {
        text.replace(at, from.size(), to);
    }
    return text;
}

// Returns the folders of packages that a shell with the setup of ROS 2 names.
std::vector<std::string> InstalledPackages()
{
    const char *const prefixes = std::getenv("AMENT_PREFIX_PATH");
    std::string rest = prefixes != nullptr ? prefixes : "";
    std::vector<std::string> folders;
    while (!rest.empty())
    {
        const std::size_t end = rest.find(':');
        if (end != 0)
        {
            folders.push_back(rest.substr(0, end) + "/share");
        }
        rest = end == std::string::npos ? "" : rest.substr(end + 1);
    }
    return folders;
}

// Returns the files that may define the type: those given, and of each given folder PACKAGE/msg/NAME.msg, or
// .idl if there is no such file.
std::vector<std::string> FilesOf(const std::string &type, const std::vector<std::string> &given)
{
    const std::string name = Replaced(type, "::", "/");
    std::vector<std::string> files;
    for (const std::string &one : given)
    {
        std::error_code ignored;
        if (!std::filesystem::is_directory(one, ignored))
        {
            files.push_back(one);
            continue;
        }
        for (const char *ending : {".msg", ".idl"})
        {
            const std::string file = one + "/" + name + ending;
            if (std::filesystem::exists(file, ignored))
            {
                files.push_back(file);
                break;
            }
        }
    }
    return files;
}

std::shared_ptr<const DynamicType> TypeOf(const std::string &name, const ForeignOptions &options)
{
    const bool isGiven = !options.Idl.empty();
    const std::vector<std::string> given = isGiven ? options.Idl : InstalledPackages();
    std::vector<std::string> folders;
    for (const std::string &one : given)
    {
        std::error_code ignored;
        if (std::filesystem::is_directory(one, ignored))
        {
            folders.push_back(one);
        }
    }
    // Of installed packages the first that has the type counts: a workspace comes before what it extends.
    std::vector<std::string> files = FilesOf(name, isGiven ? given : folders);
    if (!isGiven && files.size() > 1)
    {
        files.resize(1);
    }
    if (files.empty())
    {
        throw ConfigError("no definition of `" + name + "`" +
                          (folders.empty() ? "" : " in " + ListedNames(folders)) +
                          "; expected --idl with a file that has it, or with a folder of packages of ROS 2, "
                          "as /opt/ros/humble/share");
    }
    const ParsedType found = IdlFiles(files, folders).Find(name);
    if (!found.Type)
    {
        throw ConfigError(found.Reason);
    }
    if (DynamicType::Register(found.Type) == nullptr)
    {
        throw ConfigError("this program has another definition of `" + name + "`");
    }
    return found.Type;
}

ForeignRule RuleOf(const std::string &topic, const std::string &type)
{
    ForeignRule rule;
    rule.Topic = topic;
    rule.Type = type;
    rule.Names = IsRosTopic(topic) ? ForeignRule::WireNames::Ros2 : ForeignRule::WireNames::Plain;
    rule.Local = WireTopicOf(rule);
    return rule;
}

}  // namespace

void AddForeignOptions(CLI::App &command, ForeignOptions &options)
{
    command.add_option("--type", options.Types,
                       "The message is a topic of programs without a gateway, as /chatter of ROS 2, and has "
                       "this type; of several topics repeated in their order");
    command.add_option("--idl", options.Idl,
                       "IDL or .msg file with the types of --type, or a folder of ROS 2 packages (default: "
                       "those of AMENT_PREFIX_PATH)");
}

std::vector<ForeignArgument> TakeForeign(const ForeignOptions &options, std::vector<std::string> &what)
{
    const bool areAll = options.Types.size() == what.size();
    std::vector<std::string> names;
    std::vector<std::string> others;
    for (const std::string &one : what)
    {
        (areAll || IsRosTopic(one) ? names : others).push_back(one);
    }
    if (!names.empty() && options.Types.empty())
    {
        throw ConfigError("`" + names.front() +
                          "` is a topic of programs without a gateway; expected its type, as --type "
                          "std_msgs/msg/String");
    }
    if (names.size() != options.Types.size())
    {
        throw ConfigError("expected one --type for each topic of programs without a gateway; found " +
                          std::to_string(options.Types.size()) + " for " + std::to_string(names.size()) +
                          " topics");
    }
    std::vector<ForeignArgument> topics;
    for (std::size_t i = 0; i < names.size(); ++i)
    {
        const std::string type = Replaced(options.Types[i], "/", "::");
        topics.push_back({.Rule = RuleOf(names[i], type), .Type = TypeOf(type, options)});
    }
    what = std::move(others);
    return topics;
}

void AddForeign(const std::vector<ForeignArgument> &topics, GatewayConfig &config)
{
    if (topics.empty())
    {
        return;
    }
    if (SomePathHasKeys(config))
    {
        throw ConfigError("a program with keys hears no program without keys, so `" +
                          topics.front().Rule.Topic + "` cannot be read; expected no keys");
    }
    for (const ForeignArgument &topic : topics)
    {
        config.Foreign.push_back(topic.Rule);
    }
    ValidateGatewayConfig(config);
}

}  // namespace Rabit::Tool
