// The program `rabit`: looks at a fleet, and speaks to it. README.md shows it.
#include <rabit/RabitVersion.h>
#include <rabit/StandardDescriptors.h>
#include <rabit/gateway/ConfigError.h>
#include <rabit/idl/NearestWord.h>

#include <CLI/CLI.hpp>

#include <algorithm>
#include <csignal>
#include <cstdlib>
#include <exception>
#include <string>
#include <utility>
#include <vector>

#include "Command.h"
#include "CommonOptions.h"
#include "FleetSession.h"
#include "Output.h"

using namespace Rabit;
using namespace Rabit::Tool;

namespace
{

// Says which command or option of the line there is not, with the nearest that there is, or which option
// belongs behind its command. Empty if all are known.
std::string UnknownWord(CLI::App &app)
{
    CLI::App *command = &app;
    std::string line = "rabit";
    while (!command->get_subcommands().empty())
    {
        command = command->get_subcommands().front();
        line += " " + command->get_name();
    }
    const std::vector<std::string> rest = app.remaining(true);
    const auto isOption = [](const std::string &word) { return word.size() > 1 && word.front() == '-'; };
    std::vector<std::string> known;
    if (const auto option = std::find_if(rest.begin(), rest.end(), isOption); option != rest.end())
    {
        if (const std::string name = option->substr(0, option->find('='));
            command->get_option_no_throw(name) != nullptr)
        {
            return "the option `" + name + "` belongs behind its command: " + line + " " + name;
        }
        for (const CLI::Option *one : command->get_options())
        {
            for (const std::string &name : one->get_lnames())
            {
                known.push_back("--" + name);
            }
        }
        return "there is no option `" + *option + "`" + NearestWordHint(*option, known);
    }
    for (const CLI::App *one : command->get_subcommands([](const CLI::App *) { return true; }))
    {
        known.push_back(one->get_name());
    }
    return rest.empty() || known.empty()
               ? ""
               : "there is no command `" + rest.front() + "`" + NearestWordHint(rest.front(), known);
}

// Names the variable of the environment that stands for the option which an error is about.
void TellOfEnvironment(const std::string &error, const std::vector<std::string> &words)
{
    for (const auto &[option, variable] :
         {std::pair("--domain", "RABIT_DOMAIN"), std::pair("--interface", "RABIT_INTERFACE"),
          std::pair("--keys", "RABIT_KEYS")})
    {
        const char *const value = std::getenv(variable);
        const bool isGiven =
            std::any_of(words.begin(), words.end(),
                        [begin = option](const std::string &word) { return word.starts_with(begin); });
        if (value != nullptr && !isGiven && error.find(option) != std::string::npos)
        {
            Output::Talk(std::string(option) + " comes from the environment: " + variable + "=" + value);
        }
    }
}

// Returns the exit code.
int RunProgram(int argc, char **argv)
{
    CLI::App app("Looks at a fleet of Rabit nodes, and speaks to it.");
    app.set_version_flag("--version", "rabit " RABIT_VERSION_STRING);
    app.require_subcommand(1);
    app.footer(
        "Exit code: 0 good, 1 a problem was found, 2 wrong usage, 3 no network or nobody in it, 130 Ctrl-C "
        "before an answer.");
    Chosen chosen;
    for (const auto add :
         {&AddNodesCommand, &AddMessagesCommand, &AddTypeCommand,    &AddEchoCommand,     &AddHzCommand,
          &AddBytesCommand, &AddAgeCommand,      &AddSendCommand,    &AddPostCommand,     &AddRecordCommand,
          &AddPlayCommand,  &AddInfoCommand,     &AddRecoverCommand, &AddFoxgloveCommand, &AddMergeCommand,
          &AddKnewCommand,  &AddCheckCommand,    &AddLogCommand,     &AddPingCommand,     &AddFetchCommand,
          &AddTopCommand,   &AddClaimsCommand,   &AddDoctorCommand,  &AddKeysCommand,     &AddLabCommand})
    {
        add(app, chosen);
    }
    TakeOneValueEach(app);
    // A line for completion is unfinished, so it cannot be parsed.
    const std::vector<std::string> words(argv + 1, argv + argc);
    const bool completes = words.size() > 1 && words[0] == "complete" && words[1] == "--";
    try
    {
        if (completes)
        {
            Wakeup wakeup;
            return Complete(app, {words.begin() + 2, words.end()}, wakeup);
        }
        app.parse(argc, argv);
        if (chosen.RunToEnd)
        {
            // A closed pipe shows as an error of the write.
            static_cast<void>(std::signal(SIGPIPE, SIG_IGN));
            return chosen.RunToEnd();
        }
        Wakeup wakeup;
        return chosen.Run(wakeup);
    }
    catch (const CLI::ParseError &error)
    {
        const std::string unknown = error.get_exit_code() == 0 ? "" : UnknownWord(app);
        if (unknown.empty())
        {
            const int code = app.exit(error) == 0 ? Good : Usage;
            TellOfEnvironment(error.what(), words);
            return code;
        }
        Output::Talk(unknown + " (--help)");
        return Usage;
    }
    catch (const NetworkError &error)
    {
        Output::Talk(std::string(error.what()) +
                     (error.DoctorHelps() ? " (`rabit doctor` tells what is wrong with the network)" : ""));
        return NoNetwork;
    }
    catch (const ConfigError &error)
    {
        Output::Talk(error.what());
        return Usage;
    }
    catch (const std::exception &error)
    {
        Output::Talk(error.what());
        return ProblemFound;
    }
}

}  // namespace

int main(int argc, char **argv)
{
    OpenStandardDescriptors();
    return Output::Ended(RunProgram(argc, argv));
}
