#include <rabit/gateway/CheckTransportSettings.h>
#include <rabit/gateway/LoadGatewayConfig.h>
#include <rabit/node/NodeOptions.h>
#include <rabit/transport/TransportFactory.h>

#include <CLI/CLI.hpp>

#include <iostream>
#include <string>

namespace Rabit
{

namespace
{

constexpr int highestDomain = 232;

void Override(GatewayConfig &config, const NodeOptions &options)
{
    if (options.Domain >= 0)
    {
        config.Domain = options.Domain;
    }
    if (!options.Transport.empty())
    {
        config.Transport = options.Transport;
    }
    if (!options.Keys.empty())
    {
        config.Security.emplace().Keys = options.Keys;
        for (PathRule &path : config.Paths)
        {
            path.Security.reset();
        }
    }
    ValidateTransportName(config, AvailableTransports(), KnownTransports());
}

}  // namespace

void AddNetworkOptions(CLI::App &app, NodeOptions &options)
{
    app.add_option("--config", options.ConfigFile,
                   "The gateway's configuration file" +
                       (options.ConfigFile.empty() ? "" : " (default: " + options.ConfigFile + ")"));
    app.add_option("--node", options.Node, "Name of this node, in place of the file's");
    // The callback refuses the value, not a check: CLI11 2.4 ignores a variable of the environment that a
    // check refuses.
    app.add_option_function<int>(
           "--domain",
           [&options](const int &domain)
           {
               if (domain < 0 || domain > highestDomain)
               {
                   throw CLI::ValidationError("--domain", "Value " + std::to_string(domain) +
                                                              " not in range 0 to " +
                                                              std::to_string(highestDomain));
               }
               options.Domain = domain;
           },
           "DDS domain, in place of the file's")
        ->type_name("INT in [0 - " + std::to_string(highestDomain) + "]");
    app.add_option("--transport", options.Transport, "DDS implementation, in place of the file's");
    app.add_option("--keys", options.Keys, "Folder of this node's keys, in place of the file's");
}

GatewayConfig LoadNetworkConfig(const NodeOptions &options)
{
    GatewayConfig config;
    if (!options.ConfigFile.empty())
    {
        config = LoadNetworkConfig(options.ConfigFile);
    }
    config.Node = options.Node;
    Override(config, options);
    return config;
}

void AddNodeOptions(CLI::App &app, NodeOptions &options)
{
    AddNetworkOptions(app, options);
    app.add_option("--interface", options.Interfaces,
                   "Network interface to use, by name or address, in place of the file's; may be repeated")
        ->delimiter(',')
        ->allow_extra_args(false)
        ->envname("RABIT_NODE_INTERFACE");
    app.get_option("--keys")->envname("RABIT_NODE_KEYS");
    app.add_option("--record", options.Record, "Folder to record this node into, in place of the file's")
        ->envname("RABIT_NODE_RECORD");
    app.add_flag("--check", options.Check, "Check the options and files, start nothing");
}

GatewayConfig LoadNodeConfig(const NodeOptions &options)
{
    GatewayConfig config = LoadGatewayConfig(options.ConfigFile, options.Node);
    if (!options.Interfaces.empty())
    {
        UseInterfaces(options.Interfaces, config);
    }
    if (!options.Record.empty())
    {
        if (!config.Record)
        {
            config.Record.emplace();
        }
        config.Record->Folder = options.Record;
    }
    Override(config, options);
    if (options.Check)
    {
        for (const GatewayConfig &path : PathConfigsOf(config))
        {
            for (const std::string &missing : CheckTransportSettings(path, *MakeTransport(path.Transport)))
            {
                std::cerr << missing << " (it is waited for)\n";
            }
        }
    }
    return config;
}

}  // namespace Rabit
