#pragma once

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include <functional>
#include <memory>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "CommonOptions.h"
#include "Output.h"

namespace Rabit::Tool
{

class Wakeup;

using Json = nlohmann::ordered_json;

// The action of the command line, set by the command that it names: one of the two. Both return the exit code
// and may throw ConfigError.
struct Chosen
{
    std::function<int(Wakeup &)> Run;  // ends soon after Wakeup was interrupted; may throw NetworkError
    std::function<int()> RunToEnd;     // joins no network; a signal ends the program
};

// Adds a command whose action is `run`: `int run(const Options &, Wakeup &)`, or `int run(const Options &)`,
// which joins no network. `check` is called first, and throws CLI::Error if options do not fit each other.
// The command has its options still to add.
template <typename Options, typename Run>
std::pair<CLI::App *, std::shared_ptr<Options>> AddCommand(CLI::App &app, Chosen &chosen,
                                                           const std::string &name, const std::string &help,
                                                           Run run, void (*check)(const Options &) = nullptr)
{
    auto options = std::make_shared<Options>();
    CLI::App *command = app.add_subcommand(name, help);
    command->callback(
        [options, run, check, &chosen]
        {
            if (check != nullptr)
            {
                check(*options);
            }
            if constexpr (std::is_invocable_v<Run, const Options &, Wakeup &>)
            {
                chosen.Run = [options, run](Wakeup &wakeup) { return run(*options, wakeup); };
            }
            else
            {
                chosen.RunToEnd = [options, run] { return run(*options); };
            }
        });
    return {command, std::move(options)};
}

// Each adds one command.
void AddNodesCommand(CLI::App &app, Chosen &chosen);
void AddMessagesCommand(CLI::App &app, Chosen &chosen);
void AddTypeCommand(CLI::App &app, Chosen &chosen);
void AddEchoCommand(CLI::App &app, Chosen &chosen);
void AddHzCommand(CLI::App &app, Chosen &chosen);
void AddBytesCommand(CLI::App &app, Chosen &chosen);
void AddAgeCommand(CLI::App &app, Chosen &chosen);
void AddSendCommand(CLI::App &app, Chosen &chosen);
void AddPostCommand(CLI::App &app, Chosen &chosen);
void AddRecordCommand(CLI::App &app, Chosen &chosen);
void AddPlayCommand(CLI::App &app, Chosen &chosen);
void AddInfoCommand(CLI::App &app, Chosen &chosen);
void AddRecoverCommand(CLI::App &app, Chosen &chosen);
void AddFoxgloveCommand(CLI::App &app, Chosen &chosen);
void AddMergeCommand(CLI::App &app, Chosen &chosen);
void AddKnewCommand(CLI::App &app, Chosen &chosen);
void AddCheckCommand(CLI::App &app, Chosen &chosen);
void AddLogCommand(CLI::App &app, Chosen &chosen);
void AddPingCommand(CLI::App &app, Chosen &chosen);
void AddClaimsCommand(CLI::App &app, Chosen &chosen);
void AddTopCommand(CLI::App &app, Chosen &chosen);
void AddFetchCommand(CLI::App &app, Chosen &chosen);
void AddDoctorCommand(CLI::App &app, Chosen &chosen);
void AddKeysCommand(CLI::App &app, Chosen &chosen);
void AddKeysCheckCommand(CLI::App &keys, Chosen &chosen);  // below `keys`
void AddLabCommand(CLI::App &app, Chosen &chosen);

// For the shells: writes the candidates for the last word of a line, one a line. The line comes without the
// program's name. Candidates that depend on the fleet come from the network that the line names. Returns the
// exit code; may throw NetworkError.
int Complete(const CLI::App &app, const std::vector<std::string> &line, Wakeup &wakeup);

}  // namespace Rabit::Tool
