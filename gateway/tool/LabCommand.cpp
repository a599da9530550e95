// rabit lab: runs the modules of ../lab, which are Python.
#include <rabit/gateway/ConfigError.h>

#include <CLI/CLI.hpp>

#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstdlib>
#include <filesystem>
#include <map>
#include <memory>
#include <string>
#include <system_error>
#include <vector>

#include "Command.h"
#include "CommonOptions.h"
#include "Output.h"

namespace Rabit::Tool
{
namespace LabParts
{
namespace
{

struct Options
{
    std::string File;
    std::string To;
    bool Check = false;
    bool Docker = false;
};

// Replaces this program. Returns only if that fails.
int Become(std::vector<std::string> words)
{
    std::error_code failed;
    const std::filesystem::path program = std::filesystem::read_symlink("/proc/self/exe", failed);
    const std::filesystem::path folder = program.parent_path();
    // Both are relative to the folder of this program, in the installed package as in the build tree.
    const std::filesystem::path modules = (folder / RABIT_LAB_MODULES).lexically_normal();
    if (failed || !std::filesystem::exists(modules / "rabit_lab", failed))
    {
        Output::Talk("there is no " + (modules / "rabit_lab").string() +
                     "; the package rabit-tools brings it");
        return ProblemFound;
    }
    const std::filesystem::path programs = (folder / RABIT_LAB_PROGRAMS).lexically_normal();
    setenv("RABIT_LAB_RABIT", program.c_str(), 1);
    setenv("RABIT_LAB_PROGRAMS", programs.c_str(), 1);
    words.insert(words.begin(), {"python3", "-B", (modules / "rabit_lab").string()});
    std::vector<char *> arguments;
    for (std::string &word : words)
    {
        arguments.push_back(word.data());
    }
    arguments.push_back(nullptr);
    execvp("python3", arguments.data());
    Output::Talk("python3 cannot be run: " + std::generic_category().message(errno) +
                 "; install python3 and python3-yaml");
    return ProblemFound;
}

std::vector<std::string> WordsOf(const char *command, const Options &options)
{
    std::vector<std::string> words = {command, options.File};
    if (!options.To.empty())
    {
        words.insert(words.end(), {"--to", options.To});
    }
    if (options.Check)
    {
        words.emplace_back("--check");
    }
    if (options.Docker)
    {
        words.emplace_back("--docker");
    }
    return words;
}

// Of `rabit lab replay`: the name, the word for its value, and the text.
constexpr std::array<std::array<const char *, 3>, 11> RadioOptions = {{
    {"--radio", "RATE", "Rate of the channel, which all share, as 57.6kbit/s (default: unlimited)"},
    {"--loss", "SHARE", "Share of the datagrams that each receiver loses, as 10% (default: 0%)"},
    {"--burst", "NUMBER", "Datagrams that are lost in a row, on average (default: 1)"},
    {"--delay", "TIME", "Time that each datagram takes after the air, as 20ms (default: 0s)"},
    {"--jitter", "TIME", "Largest difference from the delay, and no more than it, as 5ms (default: 0s)"},
    {"--queue", "SIZE", "Bytes that wait at each node's radio at most (default: 16kB)"},
    {"--overhead", "SIZE", "Bytes that each frame takes in addition (default: 0B)"},
    {"--budget", "RATE", "Budget of each node, as 1500B/s, or auto (default: as each node was configured)"},
    {"--after", "TIME", "Time from which values are counted (default: 0s)"},
    {"--before", "TIME", "Time up to which values are counted (default: the end of the flight)"},
    {"--seed", "NUMBER", "Start of the random numbers, a whole number (default: 1)"},
}};

void AddReplay(CLI::App &lab, Chosen &chosen)
{
    struct Replayed
    {
        std::vector<std::string> Files;
        std::map<std::string, std::string> Values;
        bool RealTime = false;
    };
    const auto options = std::make_shared<Replayed>();
    CLI::App *command = lab.add_subcommand("replay", "Flies a recorded flight over another radio");
    command->add_option("FILE", options->Files, "Recordings on one time line, as the flight.mcap of a run")
        ->required();
    for (const auto &[name, word, what] : RadioOptions)
    {
        command->add_option(name, options->Values[name], what)->option_text(word);
    }
    command->add_option("--to", options->Values["--to"],
                        "Folder of the results, which is made (default: lab/NAME_TIME)");
    command->add_flag("--real-time", options->RealTime,
                      "Real gateways over an emulated radio, in real time: needs root or namespaces");
    command->callback(
        [options, &chosen]
        {
            chosen.RunToEnd = [options]
            {
                std::vector<std::string> words = {"replay"};
                words.insert(words.end(), options->Files.begin(), options->Files.end());
                for (const auto &[name, value] : options->Values)
                {
                    if (!value.empty())
                    {
                        words.insert(words.end(), {name, value});
                    }
                }
                if (options->RealTime)
                {
                    words.emplace_back("--real-time");
                }
                return Become(std::move(words));
            };
        });
    AddExamples(*command, {"rabit lab replay lab/flight/flight.mcap --radio 57.6kbit/s",
                           "rabit lab replay flight.mcap --radio 250kbit/s --loss 10% --budget 5kB/s",
                           "rabit lab replay flight.mcap --radio 1Mbit/s --real-time --to results"});
}

}  // namespace
}  // namespace LabParts

void AddLabCommand(CLI::App &app, Chosen &chosen)
{
    using namespace LabParts;
    CLI::App *lab = app.add_subcommand("lab", "Flies a fleet of one's own through a scenario with faults");
    lab->require_subcommand(1);
    const auto add = [&chosen, lab](const char *name, const char *what, const char *argument,
                                    const char *file, const char *to)
    {
        auto options = std::make_shared<Options>();
        CLI::App *command = lab->add_subcommand(name, what);
        command->add_option(argument, options->File, file)->required();
        command->add_option("--to", options->To, to);
        command->callback([options, name, &chosen]
                          { chosen.RunToEnd = [options, name] { return Become(WordsOf(name, *options)); }; });
        return std::pair(command, options);
    };
    const auto [run, options] = add("run", "Runs a scenario, and judges it", "SCENARIO", "A file of YAML",
                                    "Folder of the results, which is made (default: lab/NAME_TIME)");
    run->add_flag("--check", options->Check, "Only check the scenario; nothing starts");
    run->add_flag("--docker", options->Docker, "Each node in a container");
    AddExamples(*run, {"rabit lab run flight.yaml", "rabit lab run flight.yaml --to results",
                       "rabit lab run flight.yaml --check"});
    const auto [made, ofNew] =
        add("new", "Writes a scenario for the configurations in a folder", "FOLDER",
            "The folder with NODE.yaml files", "The file, which is made (default: FOLDER/scenario.yaml)");
    static_cast<void>(ofNew);
    AddExamples(*made, {"rabit lab new .", "rabit lab new fleet", "rabit lab new fleet --to radio.yaml"});
    AddReplay(*lab, chosen);
}

}  // namespace Rabit::Tool
