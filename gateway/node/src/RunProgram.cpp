#include <rabit/gateway/ConfigError.h>
#include <rabit/node/RunProgram.h>

#include <CLI/CLI.hpp>

#include <exception>
#include <iostream>

namespace Rabit
{

int RunProgram(CLI::App &app, int argc, char **argv, const std::function<int()> &body)
{
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
        std::cerr << error.what() << '\n';
        return ExitBadInput;
    }
    catch (const std::exception &error)
    {
        std::cerr << argv[0] << ": " << error.what() << '\n';
        return ExitFailed;
    }
    catch (...)
    {
        std::cerr << argv[0] << ": ended by an exception of an unknown type\n";
        return ExitFailed;
    }
}

}  // namespace Rabit
