#include "NodeProgram.h"

#include "BadInput.h"

#include <rabit/gateway/CheckTransportSettings.h>
#include <rabit/gateway/LoadGatewayConfig.h>
#include <rabit/transport/TransportFactory.h>

#include <CLI/CLI.hpp>

#include <exception>
#include <iostream>

namespace Common
{
namespace
{
int Refuse(const std::exception &error)
{
    std::cerr << error.what() << '\n';
    return ExitBadInput;
}
}  // namespace

void Describe(CLI::App &app, NodeOptions &options)
{
    app.add_option("--config", options.ConfigFile,
                   "The gateway's configuration file (default: " + options.ConfigFile + ")");
    app.add_option("--node", options.Node, "Name of this node, in place of the file's");
    app.add_option("--domain", options.Domain, "DDS domain, in place of the file's")
        ->check(CLI::Range(0, 232));
    app.add_option("--transport", options.Transport, "DDS implementation, in place of the file's");
    app.add_flag("--check", options.Check, "Check the options and files, start nothing");
}

Rabit::GatewayConfig LoadConfig(const NodeOptions &options)
{
    Rabit::GatewayConfig config = Rabit::LoadGatewayConfig(options.ConfigFile, options.Node);
    if (options.Domain >= 0)
        config.Domain = options.Domain;
    if (!options.Transport.empty())
        config.Transport = options.Transport;
    Rabit::ValidateTransportName(config, Rabit::AvailableTransports(), Rabit::KnownTransports());
    if (options.Check)
        for (const std::string &missing :
             Rabit::CheckTransportSettings(config, *Rabit::MakeTransport(config.Transport)))
            std::cerr << missing << " (it is waited for)\n";
    return config;
}

int RunProgram(CLI::App &app, int argc, char **argv, const std::function<int()> &body)
{
    try
    {
        app.parse(argc, argv);
        return body();
    }
    catch (const CLI::ParseError &error)
    {
        return app.exit(error) == 0 ? 0 : ExitBadInput;
    }
    catch (const Rabit::ConfigError &error)
    {
        return Refuse(error);
    }
    catch (const BadInput &error)
    {
        return Refuse(error);
    }
    catch (const std::exception &error)
    {
        std::cerr << argv[0] << ": " << error.what() << '\n';
        return ExitFailed;
    }
}

}  // namespace Common
