// rabit record: records the messages of the network into files.
#include <rabit/RabitClock.h>
#include <rabit/base/ListedNames.h>
#include <rabit/gateway/ByteSize.h>

#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <system_error>

#include "Command.h"
#include "FleetFollower.h"
#include "FleetSession.h"
#include "ForeignArguments.h"
#include "recording/FolderDisk.h"
#include "recording/MessageTaps.h"
#include "recording/QueueStreams.h"
#include "recording/RecordingFiles.h"

namespace Rabit::Tool
{
namespace RecordParts
{
namespace
{

struct Options
{
    CommonOptions Common;
    std::vector<std::string> What = {"*/*"};
    ForeignOptions Foreign;
    RecordSettings Record{.Folder = "."};
    std::string Name = "fleet";
    double For = FleetSession::Forever;
    // Milliseconds.
    std::uint64_t SplitTime = static_cast<std::uint64_t>(RecordSettings().SplitTime.count());
};

// Returns why no file can be made in the folder; empty if one can. Makes the folder if it is missing.
std::string WhyNoFile(const std::string &folder)
{
    std::error_code error;
    std::filesystem::create_directories(folder, error);
    if (!error && ::access(folder.c_str(), W_OK | X_OK) != 0)
    {
        error = std::error_code(errno, std::generic_category());
    }
    return error ? folder + ": " + error.message() : "";
}

std::string Counted(const RecordingStatus &status)
{
    return std::to_string(status.Messages) + " messages, " + std::to_string(status.Bytes) + " bytes";
}

// Reports on standard error what the recording does meanwhile: each file, each change of its problem, and on
// a terminal how much there is.
class Progress
{
public:
    explicit Progress(const Options &options) : _options(options) {}

    void Look(const RecordingStatus &status, double seconds)
    {
        if (status.LastFile != _file && !status.LastFile.empty())
        {
            Output::Talk("recording into " + _options.Record.Folder + "/" + status.LastFile);
        }
        if (status.Problem != _problem)
        {
            Output::Talk(status.Problem.empty() ? "recording again"
                                                : "nothing is recorded: " + status.Problem);
        }
        _file = status.LastFile;
        _problem = status.Problem;
        if (_isTerminal && status.Messages > 0 && seconds >= _next)
        {
            Output::Talk(Counted(status));
            _next = seconds + Period;
        }
    }

private:
    static constexpr double Period = 5.0;  // seconds: a line that is read, and does not flood the terminal

    const Options &_options;
    const bool _isTerminal = ::isatty(STDERR_FILENO) != 0;
    std::string _file;
    std::string _problem;
    double _next = Period;
};

bool Tell(const Options &options, const RecordingStatus &status)
{
    std::vector<std::string> topics;
    std::uint64_t lost = 0;
    for (const auto &[topic, count] : status.Lost)
    {
        topics.push_back(topic);
        lost += count;
    }
    if (lost > 0)
    {
        Output::Talk(std::to_string(lost) + (lost == 1 ? " message was" : " messages were") +
                     " not recorded, of " + ListedNames(topics));
    }
    Output::ObjectOrLine(
        options.Common.Json,
        {{"files", status.Files},
         {"last_file", status.LastFile},
         {"messages", status.Messages},
         {"bytes", status.Bytes},
         {"lost", status.Lost}},
        Counted(status) + ", " +
            (status.Files == 1 ? options.Record.Folder + "/" + status.LastFile
                               : std::to_string(status.Files) + " files in " + options.Record.Folder));
    return status.Lost.empty() && status.Problem.empty();
}

// If no message was followed, the file holds nothing but what this program knew of the fleet.
void RemoveFile(const Options &options, const RecordingStatus &status)
{
    if (status.Files == 1)
    {
        FolderDisk(options.Record.Folder).Remove(status.LastFile);
    }
}

// Replaces a size such as 500MB by its bytes.
CLI::Validator Size(const ByteRange &range)
{
    return {[range](std::string &text)
            {
                try
                {
                    text = std::to_string(ParseByteSize(text, range));
                }
                catch (const std::invalid_argument &error)
                {
                    return "`" + text + "`; " + error.what();
                }
                return std::string();
            },
            "SIZE"};
}

// Files are removed whole, so a smaller size keeps none but the one that is written.
void CheckSizes(const Options &options)
{
    if (options.Record.Keep > 0 && options.Record.Keep < options.Record.SplitSize)
    {
        throw CLI::ValidationError(
            "--keep", "less than the size of one file; give a larger size, or a smaller --split-size");
    }
}

void TellOfNew(const std::vector<std::string> &messages)
{
    if (!messages.empty())
    {
        Output::Talk("recording " + ListedNames(messages));
    }
}

std::vector<std::string> LocalsOf(const std::vector<ForeignArgument> &topics)
{
    std::vector<std::string> names;
    for (const ForeignArgument &topic : topics)
    {
        names.push_back(topic.Rule.Local);
    }
    return names;
}

// True if something has come of a topic of foreign programs.
bool HasForeign(const FleetSession &session)
{
    const Gateway::Fleet fleet = session.Fleet();
    return std::any_of(fleet.foreign.begin(), fleet.foreign.end(),
                       [](const Gateway::ForeignTopic &topic) { return topic.samples > 0; });
}

int Run(const Options &options, Wakeup &wakeup)
{
    GatewayConfig config = ConfigOf(options.Common);
    std::vector<std::string> what = options.What;
    const std::vector<ForeignArgument> topics = TakeForeign(options.Foreign, what);
    AddForeign(topics, config);
    if (const std::string why = WhyNoFile(options.Record.Folder); !why.empty())
    {
        Output::Talk(why);
        return ProblemFound;
    }
    config.Record = options.Record;
    config.Record->SplitTime = std::chrono::milliseconds(options.SplitTime);
    config.Record->Queues = false;  // queue messages of other nodes cannot be heard
    const auto target = std::make_shared<RecordingTarget>(
        config.Node, *RabitClock::System(), std::make_unique<FolderDisk>(options.Record.Folder),
        RecordingSettings{.Name = options.Name, .Record = *config.Record});
    config.Tap = std::make_shared<QueueStreams>(target, *config.Record);
    target->Inbox().SetMetadata("rabit.node", {{"node", config.Node}, {"kind", "rabit record"}});
    config.Tool->AsksOf = what.empty() ? std::vector{config.Node} : FleetFollower::NodesOf(what);
    if (options.Record.Free < RecordingFiles::LeastMargin)
    {
        Output::Talk("--free: at least 16 MiB of the disk stay free, for the end of the file");
    }
    Progress progress(options);
    bool anybody = false;
    bool isTold = topics.empty();  // why nothing comes of foreign topics
    // The length counts from the first message that is followed, or that came of a foreign topic.
    std::optional<double> begin;
    {
        FleetSession session(config, options.Common, wakeup);
        FleetFollower follower(session, what, config, config.Record->Except);
        MessageTaps taps(config, session.Workspace(), target);
        TellOfNew(LocalsOf(topics));
        const auto end = [&]
        { return begin ? *begin + options.For : std::max(options.For, options.Common.Wait); };
        while (!wakeup.IsInterrupted() && session.Seconds() < end())
        {
            TellOfNew(follower.FollowNew());
            follower.TellOfMissing();
            taps.Look();
            const bool hasForeign = !topics.empty() && !begin && HasForeign(session);
            anybody = anybody || hasForeign || session.IsAnybodyThere();
            if (!begin && (hasForeign || follower.Messages() > 0))
            {
                begin = session.Seconds();
            }
            if (!anybody && session.Seconds() >= options.Common.Wait)
            {
                target->End();
                RemoveFile(options, target->Status());
                return session.NobodyThere();
            }
            if (!isTold && session.Seconds() >= options.Common.Wait)
            {
                isTold = true;
                session.TellProblems();
            }
            progress.Look(target->Status(), session.Seconds());
            // Looks for new names as often as RecorderManager does.
            session.WaitUntil(std::min(session.Seconds() + 0.1, end()));
        }
    }
    target->End();
    if (!begin)
    {
        RemoveFile(options, target->Status());
        Output::Talk("nobody publishes such a message; nothing was recorded");
        return ProblemFound;
    }
    progress.Look(target->Status(), 0.0);
    return Tell(options, target->Status()) ? Good : ProblemFound;
}

}  // namespace
}  // namespace RecordParts

void AddRecordCommand(CLI::App &app, Chosen &chosen)
{
    using namespace RecordParts;
    const auto [command, options] = AddCommand<Options>(
        app, chosen, "record", "What is on the network, into a file that Foxglove opens", &Run, &CheckSizes);
    command->add_option("MESSAGE", options->What, "uav1/Pose; *, ? stand for any; without: all messages");
    AddCommonOptions(*command, options->Common, 5.0);
    AddForeignOptions(*command, options->Foreign);
    command->add_option("--except", options->Record.Except, "Messages to leave out, as */CameraView");
    command->add_option("--to", options->Record.Folder, "Folder of the files (default: this one)");
    command->add_option("--name", options->Name, "How their names begin (default: fleet)");
    command->add_option("--for", options->For, "Seconds from the first message (default: until Ctrl-C)")
        ->check(AboveZero());
    command
        ->add_option("--split-size", options->Record.SplitSize,
                     "End a file at this size, as 500MB (default: 1 GiB)")
        ->transform(Size(RecordRanges::SplitSize));
    const std::map<std::string, std::uint64_t> units{
        {"ms", 1}, {"s", 1000}, {"min", 60'000}, {"h", 3'600'000}};
    command
        ->add_option("--split-time", options->SplitTime,
                     "End a file after this time, as 5min (default: 10min)")
        ->transform(CLI::AsNumberWithUnit(units, CLI::AsNumberWithUnit::UNIT_REQUIRED, "TIME"))
        ->check(CLI::Range(std::uint64_t{1000}, std::uint64_t{86'400'000}));
    command
        ->add_option(
            "--keep", options->Record.Keep,
            "Size of all files of that name, as 20GB; beyond it the oldest is removed (default: no limit)")
        ->transform(Size(RecordRanges::Keep));
    command
        ->add_option("--free", options->Record.Free,
                     "Bytes of the disk that stay free, as 5GB (default: 1 GiB)")
        ->transform(Size(RecordRanges::Free));
    AddExamples(*command, {"rabit record uav1/Pose 'uav*/Health' --for 60",
                           "rabit record --except '*/CameraView' --to flights --split-time 5min --keep 20GB",
                           "rabit record uav1/Pose /scan --type sensor_msgs/msg/LaserScan"});
}

}  // namespace Rabit::Tool
