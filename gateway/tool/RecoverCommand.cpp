// rabit recover: copies the readable part of a recording that was not ended in order into a whole one.
#include <rabit/RabitVersion.h>

#include <CLI/CLI.hpp>

#include <filesystem>
#include <memory>

#include "Command.h"
#include "CommonOptions.h"
#include "Output.h"
#include "recording/FolderDisk.h"
#include "recording/mcap/FileSource.h"
#include "recording/mcap/McapRecovery.h"

namespace Rabit::Tool
{
namespace
{

struct Options
{
    std::string File;
    std::string To;
};

std::string TargetOf(const Options &options)
{
    const std::filesystem::path file = options.File;
    return options.To.empty() ? (file.parent_path() / (file.stem().string() + "_recovered.mcap")).string()
                              : options.To;
}

int Run(const Options &options)
{
    Mcap::FileSource source(options.File);
    const std::filesystem::path target = TargetOf(options);
    FolderDisk disk(target.has_parent_path() ? target.parent_path().string() : ".");
    std::string reason;
    const auto file = disk.Create(target.filename().string(), reason);
    if (!file)
    {
        Output::Talk(reason);
        return ProblemFound;
    }
    Mcap::McapWriter writer(*file, {"rabit " RABIT_VERSION_STRING, "rabit", true});
    const Mcap::Recovered recovered = Mcap::Recover(source, writer);
    const bool isWritten = recovered.IsWritten && file->Sync();
    for (const std::string &problem : recovered.Problems)
    {
        Output::Talk(problem);
    }
    if (recovered.LostMessages > 0)
    {
        Output::Talk(std::to_string(recovered.LostMessages) +
                     " messages are of no channel, and were left out");
    }
    if (!isWritten)
    {
        Output::Talk(target.string() + ": the disk takes no more");
    }
    Output::Line(target.string() + ": " + std::to_string(recovered.Messages) + " messages");
    return isWritten && recovered.Messages > 0 ? Good : ProblemFound;
}

}  // namespace

void AddRecoverCommand(CLI::App &app, Chosen &chosen)
{
    auto options = std::make_shared<Options>();
    CLI::App *command =
        app.add_subcommand("recover", "What can be read of a recording that was cut off, as a whole one");
    command->add_option("FILE", options->File, "A recording (MCAP), which stays as it is")->required();
    command->add_option("--to", options->To, "Where to; else FILE_recovered.mcap. No file is overwritten");
    command->callback([options, &chosen] { chosen.Run = [options](Wakeup &) { return Run(*options); }; });
}

}  // namespace Rabit::Tool
