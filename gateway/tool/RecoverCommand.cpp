// rabit recover: copies the readable part of a recording that was not ended in order into a whole one.
#include <rabit/RabitVersion.h>
#include <rabit/mcap/FileSource.h>
#include <rabit/mcap/McapRecovery.h>

#include <cstdint>
#include <filesystem>
#include <span>

#include "Command.h"
#include "NewFile.h"
#include "PlayedFiles.h"
#include "Wakeup.h"

namespace Rabit::Tool
{
namespace RecoverParts
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
    Output::Talk(recovered.Problems);
    if (recovered.LostMessages > 0)
    {
        Output::Talk(std::to_string(recovered.LostMessages) +
                     " messages are of no channel, and were left out");
    }
    Output::ObjectOrLine(options.Json,
                         {{"file", target},
                          {"messages", recovered.Messages},
                          {"lost", recovered.LostMessages},
                          {"problems", recovered.Problems}},
                         target + ": " + std::to_string(recovered.Messages) + " messages");
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
    const std::string target = TargetOf(options);
    NewFile file(target);
    Mcap::McapWriter writer(file.Sink(), {"rabit " RABIT_VERSION_STRING, "rabit", true});
    const Mcap::Recovered recovered = Mcap::Recover(source, writer);
    file.Finish(recovered.IsWritten, wakeup.IsInterrupted());
    Tell(options, target, recovered);
    return recovered.Messages > 0 ? Good : ProblemFound;
}

}  // namespace
}  // namespace RecoverParts

void AddRecoverCommand(CLI::App &app, Chosen &chosen)
{
    using namespace RecoverParts;
    const auto [command, options] = AddCommand<Options>(
        app, chosen, "recover", "What can be read of a recording that was cut off, as a whole one", &Run);
    command->add_option("FILE", options->File, "A recording (MCAP), which stays as it is")->required();
    command->add_option("--to", options->To, "Where to; else FILE_recovered.mcap. No file is overwritten");
    command->add_flag("--json", options->Json, "One object");
    AddExamples(*command, {"rabit recover flight.mcap", "rabit recover flight.mcap --to whole.mcap",
                           "rabit recover flight.mcap --json"});
}

}  // namespace Rabit::Tool
