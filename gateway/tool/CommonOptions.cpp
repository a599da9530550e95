#include "CommonOptions.h"

#include <rabit/gateway/ConfigError.h>
#include <rabit/gateway/LoadGatewayConfig.h>
#include <rabit/keys/NodeOfKeys.h>
#include <unistd.h>

#include <CLI/CLI.hpp>

#include <algorithm>
#include <array>

namespace Rabit::Tool
{
namespace
{

// Returns a name that is unique in the network: two tools on one machine are two nodes.
std::string OwnName()
{
    constexpr std::size_t longestHost = 40;
    std::array<char, 256> host{};
    static_cast<void>(::gethostname(host.data(), host.size() - 1));
    std::string name = std::string(host.data()).substr(0, longestHost);
    std::replace_if(
        name.begin(), name.end(),
        [](char c)
        { return !((c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '-'); },
        '-');
    return "rabit." + name + "." + std::to_string(::getpid());
}

}  // namespace

void AddCommonOptions(CLI::App &app, CommonOptions &options, double wait)
{
    options.Wait = wait;
    AddNetworkOptions(app, options.Node);
    app.add_option("--interface", options.Interfaces,
                   "Network interface to use, by name or address, in place of the file's; may be repeated")
        ->delimiter(',')
        ->envname("RABIT_INTERFACE");
    CLI::Option *const domain = app.get_option("--domain")->envname("RABIT_DOMAIN");
    CLI::Option *const keys = app.get_option("--keys")->envname("RABIT_KEYS");
    // The environment is read once the whole line is.
    app.get_option("--config")
        ->trigger_on_parse()
        ->each(
            [domain, keys](const std::string &)
            {
                domain->envname("");
                keys->envname("");
            });
    app.add_option("--wait", options.Wait, "Seconds to wait for an answer")
        ->check(CLI::Range(0.1, 86400.0))
        ->each([&options](const std::string &) { options.IsWaitGiven = true; })
        ->capture_default_str();
    app.add_flag("--json", options.Json, "One JSON object a line");
    app.add_flag("-v,--verbose", options.Verbose, "Tell more on standard error");
}

void AddExamples(CLI::App &command, const std::vector<std::string> &examples)
{
    std::string text = "Examples:\n";
    for (const std::string &example : examples)
    {
        text += "  " + example + "\n";
    }
    command.footer(text + "\n" + command.get_footer());
}

CLI::Validator AboveZero()
{
    return {[](std::string &text)
            {
                double number = 0.0;
                const bool isGood = CLI::detail::lexical_cast(text, number) && number > 0.0;
                return isGood ? std::string() : "`" + text + "`; it must be a number above 0";
            },
            "NUMBER"};
}

void TakeOneValueEach(CLI::App &app)
{
    for (CLI::Option *option : app.get_options([](const CLI::Option *one) { return !one->get_positional(); }))
    {
        option->allow_extra_args(false);
    }
    for (CLI::App *command : app.get_subcommands([](const CLI::App *) { return true; }))
    {
        TakeOneValueEach(*command);
    }
}

GatewayConfig ConfigOf(const CommonOptions &options)
{
    GatewayConfig config = LoadNetworkConfig(options.Node);
    if (!options.Interfaces.empty())
    {
        UseInterfaces(options.Interfaces, config);
    }
    config.Node = options.Node.Node.empty() ? OwnName() : options.Node.Node;
    if (options.Node.Node.empty())
    {
        const std::vector<GatewayConfig> paths = PathConfigsOf(config);
        const auto with = std::find_if(paths.begin(), paths.end(),
                                       [](const GatewayConfig &path) { return path.Security.has_value(); });
        if (with != paths.end())
        {
            config.Node = Keys::NodeOfKeys(with->Security->Keys);
        }
    }
    config.StateDir.clear();
    config.Tool.emplace();
    ValidateGatewayConfig(config);
    return config;
}

}  // namespace Rabit::Tool
