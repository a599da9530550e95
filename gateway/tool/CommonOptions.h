#pragma once

#include <rabit/gateway/GatewayConfig.h>
#include <rabit/node/NodeOptions.h>

#include <string>
#include <vector>

namespace CLI
{
class App;
class Validator;
}  // namespace CLI

namespace Rabit::Tool
{

// Exit codes.
inline constexpr int Good = 0;
inline constexpr int ProblemFound = 1;
inline constexpr int Usage = 2;
inline constexpr int NoNetwork = 3;      // it could not be joined, or nobody was heard
inline constexpr int Interrupted = 130;  // Ctrl-C came before there was a result; the shell's 128 + SIGINT

// The options of every command that looks at a network.
struct CommonOptions
{
    NodeOptions Node;
    std::vector<std::string> Interfaces;
    double Wait = 0.0;         // seconds
    bool IsWaitGiven = false;  // --wait was on the command line
    bool Json = false;
    bool Verbose = false;
};

// Adds --config, --node, --domain, --transport, --keys, --interface, --wait, --json and --verbose. `wait` is
// the default of --wait, in seconds. RABIT_DOMAIN, RABIT_INTERFACE (several with commas) and RABIT_KEYS of
// the environment stand for options that the command line lacks; a --config on it has precedence over the
// domain and the keys of the environment.
void AddCommonOptions(CLI::App &app, CommonOptions &options, double wait);

// Adds examples to the help of a command, each a line for the shell.
void AddExamples(CLI::App &command, const std::vector<std::string> &examples);

// Accepts numbers above 0.
CLI::Validator AboveZero();

// Makes every option of the program take one value at a time, so that the word after the value is an
// argument. An option of several values is repeated. To be called once all commands have their options.
void TakeOneValueEach(CLI::App &app);

// The configuration of this program as a tool. Throws ConfigError.
GatewayConfig ConfigOf(const CommonOptions &options);

}  // namespace Rabit::Tool
