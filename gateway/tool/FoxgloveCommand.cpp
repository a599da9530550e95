// rabit foxglove: shows the messages of the network live in Foxglove.
#include <rabit/keys/AccessToken.h>

#include <string>
#include <vector>

#include "Command.h"
#include "FleetFollower.h"
#include "FleetSession.h"
#include "live/LiveServer.h"
#include "live/LiveTaps.h"

namespace Rabit::Tool
{
namespace FoxgloveParts
{
namespace
{

struct Options
{
    CommonOptions Common;
    std::vector<std::string> What = {"*/*"};
    std::vector<std::string> Except;
    std::string Address = "127.0.0.1";
    std::uint16_t Port = 8765;
    std::vector<std::string> Origins;
    std::string TokenFile;
    bool IsOpen = false;
};

LiveServer::Settings SettingsOf(const Options &options)
{
    LiveServer::Settings settings;
    settings.Endpoint = {boost::asio::ip::make_address(options.Address), options.Port};
    settings.Origins = options.Origins;
    if (!options.IsOpen)
    {
        settings.Token =
            options.TokenFile.empty() ? Keys::MakeAccessToken() : Keys::AccessTokenIn(options.TokenFile);
    }
    return settings;
}

std::string WhyNoAddress(const std::string &text)
{
    boost::system::error_code error;
    static_cast<void>(boost::asio::ip::make_address(text, error));
    return error ? "`" + text + "` is no address" : "";
}

// Throws CLI::ValidationError.
void CheckListen(const Options &options)
{
    if (!options.IsOpen && !boost::asio::ip::make_address(options.Address).is_loopback())
    {
        throw CLI::ValidationError(
            "--listen", "there is no TLS: anybody on the way to " + options.Address +
                            " would see the token and everything else; `ssh -L 8765:127.0.0.1:8765` brings "
                            "it to one machine, --open-to-everybody-on-the-network allows it to all");
    }
}

std::string UrlOf(const boost::asio::ip::tcp::endpoint &endpoint, const std::string &token)
{
    const std::string host = endpoint.address().to_string();
    return "ws://" + (endpoint.address().is_v6() ? "[" + host + "]" : host) + ":" +
           std::to_string(endpoint.port()) + (token.empty() ? "" : "/?token=" + token);
}

int Run(const Options &options, Wakeup &wakeup)
{
    GatewayConfig config = ConfigOf(options.Common);
    std::vector<std::string> except = options.Except;
    config.Tool->AsksOf = FleetFollower::NodesOf(options.What);
    const LiveServer::Settings settings = SettingsOf(options);
    LiveServer server(settings);
    const std::string url = UrlOf(server.Endpoint(), settings.Token);
    if (!Output::ObjectOrLine(options.Common.Json, {{"url", url}}, url))
    {
        return Good;
    }
    FleetSession session(config, options.Common, wakeup);
    FleetFollower follower(session, options.What, config, except);
    LiveTaps taps(session, config, except, server);
    bool lonely = false;
    while (!wakeup.IsInterrupted())
    {
        follower.FollowNew();
        follower.TellOfMissing();
        taps.Look();
        if (!lonely && !session.IsAnybodyThere() && session.Seconds() >= options.Common.Wait)
        {
            lonely = true;
            static_cast<void>(session.NobodyThere());
        }
        session.WaitUntil(session.Seconds() + 0.1);
    }
    const LiveServer::Counters counters = server.Count();
    if (counters.Dropped > 0)
    {
        Output::Talk(std::to_string(counters.Dropped) +
                     " values were not shown to viewers that were too slow");
    }
    return Good;
}

}  // namespace
}  // namespace FoxgloveParts

void AddFoxgloveCommand(CLI::App &app, Chosen &chosen)
{
    using namespace FoxgloveParts;
    const auto [command, options] =
        AddCommand<Options>(app, chosen, "foxglove", "What is on the network, live in Foxglove or Lichtblick",
                            &Run, &CheckListen);
    command->add_option("MESSAGE", options->What, "uav1/Pose; *, ? stand for any; without: all messages");
    AddCommonOptions(*command, options->Common, 5.0);
    command->add_option("--except", options->Except, "Messages to leave out, as */CameraView");
    command
        ->add_option(
            "--listen", options->Address,
            "Address to listen at (default: 127.0.0.1); another one than of this machine alone needs "
            "--open-to-everybody-on-the-network")
        ->check(CLI::Validator([](const std::string &text) { return WhyNoAddress(text); }, ""));
    CLI::Option *const open =
        command->add_flag("--open-to-everybody-on-the-network", options->IsOpen,
                          "Anybody who reaches the address may see everything: no token is needed");
    command->add_option("--port", options->Port, "Port to listen at (default: 8765; 0: any)");
    command->add_option(
        "--origin", options->Origins,
        "An origin whose pages may look, besides the sites of Foxglove and Lichtblick; file:// for an "
        "installed Foxglove or Lichtblick");
    command
        ->add_option("--token-file", options->TokenFile,
                     "File that keeps the token, so that the address stays the same; made if it is missing "
                     "(default: a new token at each start)")
        ->excludes(open);
    AddExamples(*command, {"rabit foxglove", "rabit foxglove 'uav*/Pose' --domain 7",
                           "rabit foxglove --except '*/CameraView' --port 8766"});
}

}  // namespace Rabit::Tool
