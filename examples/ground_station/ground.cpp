// A ground station: a view of the fleet, a commander, and the gateway that joins them to the aircraft.
#include "Commander.h"
#include "FleetView.h"
#include "Verdict.h"

#include <rabit/RabitReactor.h>
#include <rabit/gateway/GatewayManager.h>
#include <rabit/gateway/LoadGatewayConfig.h>
#include <rabit/transport/TransportFactory.h>

#include <boost/asio/io_context.hpp>
#include <boost/asio/signal_set.hpp>

#include <CLI/CLI.hpp>

#include <unistd.h>

#include <chrono>
#include <csignal>
#include <exception>
#include <iostream>
#include <memory>
#include <string>
#include <thread>
#include <utility>
#include <vector>

namespace
{
constexpr int ExitFailed = 1;
constexpr int ExitBadInput = 2;

struct Options
{
    std::string ConfigFile = "ground.yaml";
    std::string Node;
    int Domain = -1;
    std::string Transport;
    int Seconds = 0;
    double CommandPeriodS = 15;
    std::vector<std::string> Expected;
    bool Check = false;
};

void Describe(CLI::App &app, Options &options)
{
    app.add_option("--config", options.ConfigFile, "The gateway's configuration file (default: ground.yaml)");
    app.add_option("--node", options.Node, "Name of this ground station, in place of the file's");
    app.add_option("--domain", options.Domain, "DDS domain, in place of the file's")
        ->check(CLI::Range(0, 232));
    app.add_option("--transport", options.Transport, "DDS implementation, in place of the file's");
    app.add_option("--seconds", options.Seconds, "End after so many seconds (default: run until Ctrl-C)")
        ->check(CLI::Range(1, 86400));
    app.add_option("--command-period", options.CommandPeriodS, "Seconds between two commands to one aircraft")
        ->check(CLI::Range(0.1, 86400.0));
    app.add_option("--expect", options.Expected, "Name of an aircraft that must be there; may be repeated");
    app.add_flag("--check", options.Check, "Check the options and files, start nothing");
}

Rabit::GatewayConfig LoadConfig(const Options &options)
{
    Rabit::GatewayConfig config = Rabit::LoadGatewayConfig(options.ConfigFile, options.Node);
    if (options.Domain >= 0)
        config.Domain = options.Domain;
    if (!options.Transport.empty())
        config.Transport = options.Transport;
    Rabit::ValidateTransportName(config, Rabit::AvailableTransports(), Rabit::KnownTransports());
    return config;
}

Ground::Commander::Settings CommanderSettings(const Options &options, const std::string &node)
{
    Ground::Commander::Settings settings;
    settings.Node = node;
    settings.Period = std::chrono::milliseconds(static_cast<int>(options.CommandPeriodS * 1000));
    if (options.Seconds > 0)
        settings.Duration = std::chrono::seconds(options.Seconds);
    return settings;
}

// Ends a run in order at the first SIGINT or SIGTERM; the second ends the process as usual. The reactor
// leaves signals alone that a program handles itself.
class EndOnSignal
{
public:
    explicit EndOnSignal(Ground::Commander &commander)
    {
        _signals.async_wait(
            [this, &commander](const boost::system::error_code &error, int)
            {
                if (error)
                    return;
                boost::system::error_code ignored;
                _signals.clear(ignored);
                commander.RequestEnd();
            });
        _thread = std::thread([this] { _io.run(); });
    }
    ~EndOnSignal()
    {
        _io.stop();
        _thread.join();
    }
    EndOnSignal(const EndOnSignal &) = delete;
    EndOnSignal &operator=(const EndOnSignal &) = delete;

private:
    boost::asio::io_context _io{1};
    boost::asio::signal_set _signals{_io, SIGINT, SIGTERM};
    std::thread _thread;
};

int Summarize(const Ground::FleetView &view, const Ground::Commander &commander)
{
    std::vector<Ground::AircraftResult> results;
    for (const Ground::FleetView::Seen &seen : view.Result())
        results.push_back(
            {seen.Row.Node, seen.Row.State, seen.Published, seen.Heard, commander.Log().Of(seen.Row.Node)});
    const Ground::Verdict verdict = Ground::Judge(results, commander.Log(), commander.ElapsedS());
    for (const std::string &line : verdict.Summary)
        std::cout << line << '\n';
    std::cout.flush();
    return verdict.Passed() ? 0 : ExitFailed;
}

int Watch(const Options &options)
{
    const Rabit::GatewayConfig config = LoadConfig(options);
    if (options.Check)
        return 0;
    auto view = std::make_unique<Ground::FleetView>(
        options.Expected, Ground::FleetView::Output{std::cout, isatty(STDOUT_FILENO) == 1});
    auto commander = std::make_unique<Ground::Commander>(CommanderSettings(options, config.Node));
    const Ground::FleetView &theView = *view;  // the reactor keeps both until the end of this function
    Ground::Commander &theCommander = *commander;

    Rabit::RabitReactor reactor;
    reactor.AddManager(std::move(view));
    reactor.AddManager(std::move(commander));
    reactor.AddManager(
        std::make_unique<Rabit::GatewayManager>(config, Rabit::MakeTransport(config.Transport)));
    {
        const EndOnSignal endOnSignal(theCommander);
        reactor.Run();
    }
    return Summarize(theView, theCommander);
}
}  // namespace

int main(int argc, char **argv)
{
    CLI::App app("A ground station for the example fleet.");
    Options options;
    Describe(app, options);
    try
    {
        app.parse(argc, argv);
        return Watch(options);
    }
    catch (const CLI::ParseError &error)
    {
        return app.exit(error) == 0 ? 0 : ExitBadInput;
    }
    catch (const Rabit::ConfigError &error)
    {
        std::cerr << error.what() << '\n';
        return ExitBadInput;
    }
    catch (const std::exception &error)
    {
        std::cerr << "ground: " << error.what() << '\n';
        return ExitFailed;
    }
}
