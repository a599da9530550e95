// The program `rabit`: looks at a fleet, and speaks to it. README.md shows it.
#include <rabit/RabitVersion.h>
#include <rabit/gateway/ConfigError.h>

#include <CLI/CLI.hpp>

#include <exception>
#include <string>
#include <vector>

#include "Command.h"
#include "CommonOptions.h"
#include "FleetSession.h"
#include "Output.h"

using namespace Rabit;
using namespace Rabit::Tool;

int main(int argc, char **argv)
{
    CLI::App app("Looks at a fleet of Rabit nodes, and speaks to it.");
    app.set_version_flag("--version", "rabit " RABIT_VERSION_STRING);
    app.require_subcommand(1);
    app.footer("Exit code: 0 good, 1 a problem was found, 2 wrong usage, 3 no network or nobody in it.");
    Chosen chosen;
    AddNodesCommand(app, chosen);
    AddMessagesCommand(app, chosen);
    AddTypeCommand(app, chosen);
    AddEchoCommand(app, chosen);
    AddHzCommand(app, chosen);
    AddBytesCommand(app, chosen);
    AddAgeCommand(app, chosen);
    AddSendCommand(app, chosen);
    AddPostCommand(app, chosen);
    AddRecordCommand(app, chosen);
    AddPlayCommand(app, chosen);
    AddInfoCommand(app, chosen);
    AddRecoverCommand(app, chosen);
    AddFoxgloveCommand(app, chosen);
    AddMergeCommand(app, chosen);
    AddKnewCommand(app, chosen);
    AddCheckCommand(app, chosen);
    AddDoctorCommand(app, chosen);
    AddKeysCommand(app, chosen);
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
        Wakeup wakeup;
        return chosen.Run(wakeup);
    }
    catch (const CLI::ParseError &error)
    {
        return app.exit(error) == 0 ? Good : Usage;
    }
    catch (const NetworkError &error)
    {
        Output::Talk(error.what());
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
