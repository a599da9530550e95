// A ground station: a view of the fleet, a commander, and the gateway that joins them to the aircraft.
#include "BadInput.h"
#include "Commander.h"
#include "FleetView.h"
#include "Limits.h"
#include "NumberWithin.h"
#include "ScreenLog.h"
#include "Verdict.h"
#include "WebPage.h"
#include "WebServer.h"

#include <rabit/RabitLog.h>
#include <rabit/RabitReactor.h>
#include <rabit/backfill/BackfillManager.h>
#include <rabit/gateway/GatewayManager.h>
#include <rabit/node/NodeOptions.h>
#include <rabit/node/RunProgram.h>
#include <rabit/recording/RecorderManager.h>
#include <rabit/transport/TransportFactory.h>

#include <boost/asio/io_context.hpp>
#include <boost/asio/signal_set.hpp>
#include <boost/asio/steady_timer.hpp>

#include <CLI/CLI.hpp>

#include <unistd.h>

#include <chrono>
#include <csignal>
#include <cstdint>
#include <ctime>
#include <iostream>
#include <memory>
#include <optional>
#include <string>
#include <thread>
#include <utility>
#include <vector>

namespace
{
struct Options
{
    Rabit::NodeOptions Node{.ConfigFile = "ground.yaml"};
    int Seconds = 0;
    double CommandPeriodS = 0;
    std::vector<double> SearchArea;  // empty: none
    std::vector<std::string> Searchers;
    bool ExpectTarget = false;
    std::vector<std::string> Expected;
    std::string Web;
    std::string WebKeys;
    bool WebIsOpen = false;
};

void Describe(CLI::App &app, Options &options)
{
    Rabit::AddNodeOptions(app, options.Node);
    app.add_option("--seconds", options.Seconds, "End after so many seconds (default: run until Ctrl-C)")
        ->check(CLI::Range(1, 86400));
    app.add_option(
           "--command-period", options.CommandPeriodS,
           "Send every aircraft a command to fly somewhere near, this often in seconds (default: never)")
        ->check(Common::NumberWithin({0.1, 86400}));
    app.add_option(
        "--search", options.Searchers,
        "Name of an aircraft that is told to search as soon as it is heard, or `*` for all; may be repeated");
    app.add_option("--search-area", options.SearchArea,
                   "Where to search at first, if no aircraft has an area yet: latitude and longitude of the "
                   "middle, lengths "
                   "in metres to the north and to the east, altitude in metres above mean sea level")
        ->expected(5)
        ->multi_option_policy(CLI::MultiOptionPolicy::TakeLast);
    app.add_flag("--expect-target", options.ExpectTarget,
                 "Fail unless a target was found by one aircraft, validated by another, and followed");
    app.add_option("--expect", options.Expected, "Name of an aircraft that must be there; may be repeated");
    app.add_option(
        "--web", options.Web,
        "Serve the web page at `PORT`, `ADDRESS:PORT` or `[ADDRESS]:PORT` (address: 127.0.0.1 unless "
        "given; port 0: any that is free), to browsers that show the token in the printed address. At "
        "another "
        "address than this machine's own 127.0.0.1 it is served by TLS");
    CLI::Option *const keys = app.add_option("--web-keys", options.WebKeys,
                                             "Folder of the page's certificate.pem, private_key.pem and "
                                             "token; what is not there is made there, so that "
                                             "the next start has the same (default: new ones at each start)");
    app.add_flag("--web-open-to-everybody-on-the-network", options.WebIsOpen,
                 "Serve the page without TLS and without a token at any address, 127.0.0.1 too: anybody who "
                 "reaches the "
                 "port commands the fleet")
        ->excludes(keys);
}

Rabit::GatewayConfig LoadConfig(const Options &options)
{
    Rabit::GatewayConfig config = Rabit::LoadNodeConfig(options.Node);
    if (options.Web.empty())
        std::erase_if(config.Accept, [](const Rabit::AcceptRule &rule) { return rule.Queue == "Pictures"; });
    return config;
}

// Throws Common::BadInput.
std::optional<Uav::SearchArea> AreaOf(const Options &options)
{
    if (options.SearchArea.empty())
        return std::nullopt;
    constexpr double speedMps = 16;
    constexpr double laneM = 60;
    std::vector<double> numbers = options.SearchArea;
    numbers.insert(numbers.end(), {speedMps, laneM});
    Uav::SearchArea area;
    const auto take = [next = numbers.begin()]<typename Number>(const char *name, Number &number,
                                                                const Common::Range &range) mutable
    {
        const double value = *next++;
        const std::string problem = Common::WhyNot(name, value, range);
        if (!problem.empty())
            throw Common::BadInput("--search-area: " + problem);
        number = static_cast<Number>(value);
    };
    Common::ForEachNumberOfArea(area, take);
    return area;
}

// The fence of the configuration file. Throws Rabit::ConfigError.
Uav::Geofence FenceOf(const Rabit::NodeParameters &parameters)
{
    constexpr double atMostM = 1'000'000;
    Uav::Geofence fence;
    std::string present;  // the last name that the file has
    int count = 0;
    const auto read = [&](const char *name, double &value, const Common::Range &range)
    {
        parameters.Read(name, value, range.Lowest, range.Highest);
        if (!parameters.Has(name))
            return;
        present = name;
        ++count;
    };
    read("geofence_latitude_deg", fence.latitude_deg, Common::LatitudeDeg);
    read("geofence_longitude_deg", fence.longitude_deg, Common::LongitudeDeg);
    read("geofence_radius_m", fence.radius_m, {10, atMostM});
    if (count != 0 && count != 3)
        parameters.Fail(present,
                        "a geofence needs all three of geofence_latitude_deg, "
                        "geofence_longitude_deg and geofence_radius_m");
    parameters.RefuseOthers();
    return fence;
}

// Different in each second of four days, so that answers to an earlier run are told apart.
std::uint32_t FirstCommandId()
{
    const auto seconds =
        std::chrono::duration_cast<std::chrono::seconds>(std::chrono::system_clock::now().time_since_epoch());
    return 1 + static_cast<std::uint32_t>(seconds.count() % 400'000) * 10'000;
}

// The secrets of the page: a token, and TLS if other machines can reach it. Nothing if it is open to
// everybody.
std::optional<Ground::WebSecrets> SecretsOf(const Options &options, const boost::asio::ip::address &address)
{
    if (options.WebIsOpen)
        return std::nullopt;
    if (options.WebKeys.empty() && address.is_loopback())
        return Ground::MakeWebToken();
    Ground::WebNames names{Ground::NamesOfThisHost(), {}};
    names.Names.emplace_back("localhost");
    for (const auto &one : Ground::AddressesOf(address))
        names.Addresses.push_back(one.to_string());
    const std::time_t now = std::time(nullptr);
    return options.WebKeys.empty() ? Ground::MakeWebSecrets(names, now)
                                   : Ground::WebSecretsIn(options.WebKeys, names, now, !options.Node.Check);
}

// Null if no page is configured. Already listens, so that an unavailable address is reported at once.
std::unique_ptr<Ground::WebServer> MakeWebServer(const Options &options)
{
    if (options.Web.empty())
        return nullptr;
    Ground::WebServer::Settings settings;
    settings.Endpoint = Ground::ParseWebAddress(options.Web);
    settings.Secrets = SecretsOf(options, settings.Endpoint.address());
    return std::make_unique<Ground::WebServer>(settings);
}

Ground::RateLimits MaxRatesOf(const Rabit::GatewayConfig &config)
{
    Ground::RateLimits rates;
    for (const Rabit::PublishRule &rule : config.Publish)
        if (rule.MaxRate > 0)
            rates[rule.Message] = rule.MaxRate;
    return rates;
}

std::unique_ptr<Ground::WebPage> MakeWebPage(const Options &options, const Rabit::GatewayConfig &config,
                                             std::unique_ptr<Ground::WebServer> server)
{
    for (const std::string &line : server->Addresses())
        std::cerr << line << std::endl;
    return std::make_unique<Ground::WebPage>(
        Ground::WebPage::Settings{config.Node, options.Expected, MaxRatesOf(config)}, std::move(server));
}

Ground::Commander::Settings CommanderSettings(const Options &options, const std::string &node,
                                              const std::optional<Uav::SearchArea> &area,
                                              const Uav::Geofence &fence)
{
    Ground::Commander::Settings settings;
    settings.Node = node;
    settings.FirstId = FirstCommandId();
    settings.Area = area;
    settings.Fence = fence;
    settings.Searchers.insert(options.Searchers.begin(), options.Searchers.end());
    if (options.CommandPeriodS > 0)
        settings.Period = std::chrono::milliseconds(static_cast<int>(options.CommandPeriodS * 1000));
    if (options.Seconds > 0)
        settings.Duration = std::chrono::seconds(options.Seconds);
    return settings;
}

// Ends a run in an orderly way at the first SIGINT, SIGTERM or SIGHUP; one that comes SignalRepeat after it
// or later ends the process as usual. The reactor ignores signals that a program handles itself.
class EndOnSignal
{
public:
    explicit EndOnSignal(Ground::Commander &commander)
    {
        for (const int number : {SIGINT, SIGTERM, SIGHUP})
        {
            struct sigaction present = {};
            sigaction(number, nullptr, &present);
            if (present.sa_handler != SIG_IGN)  // as it is after nohup
                _signals.add(number);
        }
        _signals.async_wait(
            [this, &commander](const boost::system::error_code &error, int)
            {
                if (error)
                    return;
                commander.RequestEnd();
                _repeats.expires_after(Rabit::RabitReactor::SignalRepeat);
                _repeats.async_wait(
                    [this](const boost::system::error_code &)
                    {
                        boost::system::error_code ignored;
                        _signals.clear(ignored);
                    });
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
    boost::asio::signal_set _signals{_io};
    boost::asio::steady_timer _repeats{_io};
    std::thread _thread;
};

int Summarize(const Ground::FleetView &view, const Ground::Commander &commander,
              const Ground::Demands &demands)
{
    std::vector<Ground::AircraftResult> results;
    for (const Ground::FleetView::Seen &seen : view.Result())
        results.push_back({seen.Row.Node, seen.Row.State, seen.Published, seen.Heard,
                           commander.Log().Of(seen.Row.Node), seen.Targets});
    const Ground::Verdict verdict = Ground::Judge(results, commander.Log(), demands, commander.ElapsedS());
    for (const std::string &line : verdict.Summary)
        std::cout << line << '\n';
    std::cout.flush();
    return verdict.Passed() ? 0 : Rabit::ExitFailed;
}

int Watch(const Options &options)
{
    Rabit::GatewayConfig config = LoadConfig(options);
    Rabit::RabitLog::SetName(config.Node);
    const std::optional<Uav::SearchArea> area = AreaOf(options);
    const Uav::Geofence fence = FenceOf(config.Parameters);
    std::unique_ptr<Ground::WebServer> server = MakeWebServer(options);
    if (options.Node.Check)
        return 0;
    Ground::FleetView::Output output{std::cout, isatty(STDOUT_FILENO) == 1};
    std::optional<Ground::ScreenLog> log;  // outlives the reactor, whose managers use it
    if (output.IsTerminal && isatty(STDERR_FILENO) == 1)
    {
        log.emplace();
        output.TakeLog = [&log] { return log->Take(); };
    }
    auto view = std::make_unique<Ground::FleetView>(
        Ground::FleetView::Settings{options.Expected, MaxRatesOf(config)}, output);
    auto commander =
        std::make_unique<Ground::Commander>(CommanderSettings(options, config.Node, area, fence));
    const Ground::FleetView &theView = *view;  // the reactor keeps both until the end of this function
    Ground::Commander &theCommander = *commander;

    Rabit::RabitReactor reactor;
    reactor.AddManager(std::move(view));
    reactor.AddManager(std::move(commander));
    if (server)
        reactor.AddManager(MakeWebPage(options, config, std::move(server)));
    Rabit::RecorderManager *recorder = nullptr;
    if (config.Record)
    {
        auto made = std::make_unique<Rabit::RecorderManager>(config);
        recorder = made.get();
        reactor.AddManager(std::move(made));
    }
    if (Rabit::BackfillManager::IsUsed(config))
        reactor.AddManager(std::make_unique<Rabit::BackfillManager>(config, recorder));
    reactor.AddManager(
        std::make_unique<Rabit::GatewayManager>(config, Rabit::TransportsOf(config, Rabit::MakeTransport)));
    {
        const EndOnSignal endOnSignal(theCommander);
        reactor.Run();
    }
    Ground::Demands demands;
    demands.Commanded.insert(options.Searchers.begin(), options.Searchers.end());
    demands.TrackedTarget = options.ExpectTarget;
    return Summarize(theView, theCommander, demands);
}
}  // namespace

int main(int argc, char **argv)
{
    CLI::App app("A ground station for the example fleet.");
    Options options;
    Describe(app, options);
    return Rabit::RunProgram(app, argc, argv, [&] { return Watch(options); });
}
