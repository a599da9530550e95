#pragma once

#include <functional>

namespace CLI
{
class App;
}

namespace Rabit::Tool
{

class Wakeup;

// What the command line asks for: set by the command that it names.
struct Chosen
{
    std::function<int(Wakeup &)> Run;  // returns the exit code; may throw NetworkError and ConfigError
};

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

}  // namespace Rabit::Tool
