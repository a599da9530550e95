// Runs the deciding parts of an aircraft again with their recorded inputs: mission control, with the
// mission and its book of targets, and the health monitor.
#include "AircraftOptions.h"
#include "HealthMonitor.h"
#include "MissionControl.h"
#include "Names.h"

#include <rabit/RabitLog.h>
#include <rabit/node/RunProgram.h>
#include <rabit/recording/ManagerRerun.h>

#include <CLI/CLI.hpp>

#include <iostream>
#include <memory>
#include <string>
#include <vector>

namespace
{
struct Options
{
    std::vector<std::string> Files;
    std::string Node;
    int Times = 1;
    bool IsReal = false;
    Swarm::AircraftOptions Aircraft;
};

// True if all runs matched the recording.
bool RunAgain(const Rabit::ManagerRecording &recording, const Rabit::ManagerRerun::MakeManager &make,
              int times)
{
    const std::string name = recording.Node() + " " + recording.Manager() + ": ";
    Rabit::RerunResult first;
    for (int i = 0; i < times; ++i)
    {
        const Rabit::RerunResult result = Rabit::ManagerRerun::Run(recording, make);
        if (i > 0 && (result.Digest != first.Digest || result.Steps != first.Steps))
        {
            std::cout << name << "run " << i + 1 << " did something else than the first\n";
            return false;
        }
        first = result;
    }
    if (first.Difference)
        std::cout << name << first.Difference->ToString() << '\n';
    else
        std::cout << name << first.Steps << " steps, " << first.Outputs << " messages, as recorded"
                  << (times > 1 ? ", " + std::to_string(times) + " times" : "") << '\n';
    if (!first.Problem.empty())
        std::cout << name << first.Problem << '\n';
    return first.IsAlike();
}

int Run(const Options &options)
{
    Rabit::RabitLog::SetLevel(Rabit::RabitLogLevel::Error);  // they repeat the warnings of the flight
    const Swarm::Floor floor = options.Aircraft.MissionFloor();
    std::vector<std::string> problems;
    bool alike = true;
    const auto run = [&](const std::string &manager, const auto &make)
    {
        for (const auto &recording :
             Rabit::ManagerRecording::Read(options.Files, manager, options.Node, problems))
        {
            const Swarm::Names names(recording.Node(), recording.Node());
            alike = RunAgain(
                        recording, [&](Rabit::RabitWorkspace &workspace) { return make(names, workspace); },
                        options.Times) &&
                    alike;
        }
    };
    run("MissionControl",
        [&](const Swarm::Names &names, Rabit::RabitWorkspace &workspace) {
            return std::make_unique<Swarm::MissionControl>(names, options.Aircraft.Ground, floor, workspace);
        });
    run("HealthMonitor",
        [&](const Swarm::Names &names, Rabit::RabitWorkspace &workspace)
        {
            return std::make_unique<Swarm::HealthMonitor>(names, options.Aircraft.Health(!options.IsReal),
                                                          workspace);
        });
    for (const std::string &problem : problems)
        std::cerr << problem << '\n';
    return alike && problems.empty() ? 0 : Rabit::ExitFailed;
}
}  // namespace

int main(int argc, char **argv)
{
    CLI::App app(
        "Runs what decides in an aircraft again, with what it read in flight, and names the first thing "
        "that it does otherwise. The configuration then had `record: steps: [MissionControl, "
        "HealthMonitor]`; the options are those of the flight.");
    Options options;
    app.add_option("files", options.Files, "Recordings of aircraft, or one merged file")->required();
    app.add_option("--node", options.Node, "Only this aircraft (default: all)");
    app.add_option("--times", options.Times, "Run it so often, and alike each time (default: 1)")
        ->check(CLI::Range(1, 1'000'000));
    app.add_flag("--real", options.IsReal, "The aircraft was a real one, whose battery was not simulated");
    options.Aircraft.AddTo(app);
    return Rabit::RunProgram(app, argc, argv, [&] { return Run(options); });
}
