// rabit recover: copies the readable part of a recording that was not ended in order into a whole one.
#include <rabit/RabitVersion.h>

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>

#include "Command.h"
#include "CommonOptions.h"
#include "Output.h"
#include "PlayedFiles.h"
#include "Wakeup.h"
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
    bool Json = false;
};

// A file that cannot be read any more once a signal has asked the program to end.
class InterruptibleSource final : public Mcap::ByteSource
{
public:
    InterruptibleSource(Mcap::ByteSource &source, const Wakeup &wakeup) : _source(source), _wakeup(wakeup) {}

    std::uint64_t Size() override { return _source.Size(); }
    bool Read(std::uint64_t offset, std::span<std::uint8_t> to) override
    {
        return !_wakeup.IsInterrupted() && _source.Read(offset, to);
    }

private:
    Mcap::ByteSource &_source;
    const Wakeup &_wakeup;
};

std::string TargetOf(const Options &options)
{
    const std::filesystem::path file = options.File;
    return options.To.empty() ? (file.parent_path() / (file.stem().string() + "_recovered.mcap")).string()
                              : options.To;
}

void Tell(const Options &options, const std::string &target, const Mcap::Recovered &recovered)
{
    for (const std::string &problem : recovered.Problems)
    {
        Output::Talk(problem);
    }
    if (recovered.LostMessages > 0)
    {
        Output::Talk(std::to_string(recovered.LostMessages) +
                     " messages are of no channel, and were left out");
    }
    if (options.Json)
    {
        Output::Object({{"file", target},
                        {"messages", recovered.Messages},
                        {"lost", recovered.LostMessages},
                        {"problems", recovered.Problems}});
    }
    else
    {
        Output::Line(target + ": " + std::to_string(recovered.Messages) + " messages");
    }
}

int Run(const Options &options, const Wakeup &wakeup)
{
    Mcap::FileSource whole(options.File);
    if (!Mcap::IsRecording(whole))
    {
        Output::Talk(NoRecording(options.File));
        return ProblemFound;
    }
    InterruptibleSource source(whole, wakeup);
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
    if (wakeup.IsInterrupted() || !isWritten)
    {
        Output::Talk(target.string() + (wakeup.IsInterrupted() ? ": was not finished, and is removed"
                                                               : ": the disk takes no more; it is removed"));
        disk.Remove(target.filename().string());
        return ProblemFound;
    }
    Tell(options, target.string(), recovered);
    return recovered.Messages > 0 ? Good : ProblemFound;
}

}  // namespace

void AddRecoverCommand(CLI::App &app, Chosen &chosen)
{
    auto options = std::make_shared<Options>();
    CLI::App *command =
        app.add_subcommand("recover", "What can be read of a recording that was cut off, as a whole one");
    command->add_option("FILE", options->File, "A recording (MCAP), which stays as it is")->required();
    command->add_option("--to", options->To, "Where to; else FILE_recovered.mcap. No file is overwritten");
    command->add_flag("--json", options->Json, "One object");
    AddExamples(*command, {"rabit recover flight.mcap", "rabit recover flight.mcap --to whole.mcap",
                           "rabit recover flight.mcap --json"});
    command->callback([options, &chosen]
                      { chosen.Run = [options](Wakeup &wakeup) { return Run(*options, wakeup); }; });
}

}  // namespace Rabit::Tool
