#include <rabit/RabitLog.h>
#include <rabit/StandardDescriptors.h>
#include <rabit/gateway/ConfigError.h>
#include <rabit/node/RunProgram.h>

#include <CLI/CLI.hpp>

#include <exception>
#include <string>

namespace Rabit
{

int RunProgram(CLI::App &app, int argc, char **argv, const std::function<int()> &body)
{
    OpenStandardDescriptors();
    try
    {
        app.parse(argc, argv);
        return body();
    }
    catch (const CLI::ParseError &error)
    {
        return app.exit(error) == 0 ? 0 : ExitBadInput;
    }
    catch (const ConfigError &error)
    {
        RabitLog::Print(error.what());
        return ExitBadInput;
    }
    catch (const std::exception &error)
    {
        RabitLog::Print(std::string(argv[0]) + ": " + error.what());
        return ExitFailed;
    }
    catch (...)
    {
        RabitLog::Print(std::string(argv[0]) + ": ended by an exception of an unknown type");
        return ExitFailed;
    }
}

}  // namespace Rabit
