// rabit record: records the messages of the network into files.
#include <rabit/RabitClock.h>

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <memory>
#include <string>
#include <utility>

#include "Command.h"
#include "CommonOptions.h"
#include "FleetFollower.h"
#include "FleetSession.h"
#include "Output.h"
#include "recording/FolderDisk.h"
#include "recording/MessageTaps.h"
#include "recording/QueueStreams.h"

namespace Rabit::Tool
{
namespace
{

struct Options
{
    CommonOptions Common;
    std::vector<std::string> What = {"*/*"};
    std::vector<std::string> Except;
    std::string Folder = ".";
    std::string Name = "fleet";
    double For = FleetSession::Forever;
};

RecordingSettings SettingsOf(const Options &options)
{
    RecordingSettings settings;
    settings.Name = options.Name;
    settings.Folder = options.Folder;
    return settings;
}

bool Tell(const Options &options, const RecordingStatus &status)
{
    for (const auto &[topic, count] : status.Lost)
    {
        Output::Talk(topic + ": " + std::to_string(count) + " messages were not recorded");
    }
    if (!status.Problem.empty())
    {
        Output::Talk(status.Problem);
    }
    if (options.Common.Json)
    {
        Output::Object({{"files", status.Files},
                        {"last_file", status.LastFile},
                        {"messages", status.Messages},
                        {"bytes", status.Bytes},
                        {"lost", status.Lost}});
    }
    else
    {
        Output::Line(std::to_string(status.Messages) + " messages, " + std::to_string(status.Bytes) +
                     " bytes, " +
                     (status.Files == 1 ? options.Folder + "/" + status.LastFile
                                        : std::to_string(status.Files) + " files in " + options.Folder));
    }
    return status.Lost.empty() && status.Problem.empty();
}

int Run(const Options &options, Wakeup &wakeup)
{
    GatewayConfig config = ConfigOf(options.Common);
    config.Record = RecordSettings{.Folder = options.Folder};
    config.Record->Except = options.Except;
    config.Record->Queues = false;  // queue messages of other nodes cannot be heard
    const auto target =
        std::make_shared<RecordingTarget>(config.Node, *RabitClock::System(),
                                          std::make_unique<FolderDisk>(options.Folder), SettingsOf(options));
    config.Tap = std::make_shared<QueueStreams>(target, *config.Record);
    target->Inbox().SetMetadata("rabit.node", {{"node", config.Node}, {"kind", "rabit record"}});
    config.Tool->AsksOf = FleetFollower::NodesOf(options.What);
    bool anybody = false;
    bool anything = false;
    {
        FleetSession session(config, options.Common, wakeup);
        FleetFollower follower(session, options.What, config, config.Record->Except);
        MessageTaps taps(config, session.Workspace(), target);
        std::string problem;
        while (!wakeup.IsInterrupted() && session.Seconds() < options.For)
        {
            follower.FollowNew();
            taps.Look();
            anybody = anybody || session.IsAnybodyThere();
            anything = follower.Messages() > 0;
            if (const std::string now = target->Status().Problem;
                std::exchange(problem, now) != now && !now.empty())
            {
                Output::Talk("nothing is recorded: " + now);
            }
            if (!anybody && session.Seconds() >= options.Common.Wait)
            {
                target->End();
                return session.NobodyThere();
            }
            // Looks for new names as often as RecorderManager does.
            session.WaitUntil(std::min(session.Seconds() + 0.1, options.For), [] { return false; });
        }
    }
    target->End();
    if (!anything)
    {
        Output::Talk("nobody publishes such a message");
    }
    return Tell(options, target->Status()) && anything ? Good : ProblemFound;
}

}  // namespace

void AddRecordCommand(CLI::App &app, Chosen &chosen)
{
    auto options = std::make_shared<Options>();
    CLI::App *command =
        app.add_subcommand("record", "What is on the network, into a file that Foxglove opens");
    command->add_option("MESSAGE", options->What, "uav1/Pose; *, ? stand for any; without: all messages");
    AddCommonOptions(*command, options->Common, 5.0);
    command->add_option("--except", options->Except, "Messages to leave out, as */CameraView");
    command->add_option("--to", options->Folder, "Folder of the files (default: this one)");
    command->add_option("--name", options->Name, "How their names begin (default: fleet)");
    command->add_option("--for", options->For, "Seconds (default: until Ctrl-C)")->check(CLI::PositiveNumber);
    command->callback([options, &chosen]
                      { chosen.Run = [options](Wakeup &wakeup) { return Run(*options, wakeup); }; });
}

}  // namespace Rabit::Tool
