#pragma once

#include <functional>

namespace CLI
{
class App;
}

namespace Rabit
{

// Exit codes.
inline constexpr int ExitFailed = 1;
inline constexpr int ExitBadInput = 2;

// Parses the arguments and runs the body. Returns the exit code: the body's; ExitFailed if an exception ended
// it; ExitBadInput if an option or a configuration (ConfigError) is wrong. The error is written to standard
// error, that of a configuration in one line.
int RunProgram(CLI::App &app, int argc, char **argv, const std::function<int()> &body);

}  // namespace Rabit
