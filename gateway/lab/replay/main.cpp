// lab_replay FILE...: flies recorded flights over a simulated radio, and writes what the nodes saw as JSON,
// one object a line (SimulatedFlight.h). With --about it only writes what was recorded (RecordedFacts.h);
// with --node it is one node of the flight, in real time (RealLife.h).
#include <rabit/RabitLog.h>
#include <rabit/StandardDescriptors.h>

#include <CLI/CLI.hpp>

#include <exception>
#include <iostream>
#include <string>
#include <vector>

#include "RealLife.h"
#include "RecordedFacts.h"
#include "Recording.h"
#include "SimulatedFlight.h"

namespace
{

std::chrono::nanoseconds OfSeconds(double seconds)
{
    return std::chrono::duration_cast<std::chrono::nanoseconds>(std::chrono::duration<double>(seconds));
}

void Write(const nlohmann::ordered_json &fact)
{
    std::cout << fact.dump(-1, ' ', true, nlohmann::json::error_handler_t::replace) << '\n';
}

void WriteAbout(const Rabit::WhatIf::Recording &recording)
{
    for (const auto &fact : FactsOfFlight(recording))
    {
        Write(fact);
    }
    for (std::size_t life = 0; life < recording.Lives().size(); ++life)
    {
        Write(FactOfLife(recording, life));
    }
    for (const auto &fact : FactsOfArrivals(recording))
    {
        Write(fact);
    }
}

}  // namespace

int main(int argc, char **argv)
{
    Rabit::OpenStandardDescriptors();
    CLI::App app("Flies a recorded flight over another radio, in simulated time.");
    std::vector<std::string> files;
    double rate = 0;
    double percent = 0;
    double delay = 0;
    double jitter = 0;
    double budget = 0;
    Rabit::WhatIf::FlightSettings settings;
    app.add_option("FILE", files, "Recordings on one time line (MCAP)")->required();
    app.add_option("--rate", rate, "Bytes a second of the radio, which all share; 0: no limit");
    app.add_option("--queue", settings.Medium.QueueBytes, "Bytes that wait at each node's radio at most");
    app.add_option("--overhead", settings.Medium.Overhead, "Bytes of each frame beyond its IP packet");
    app.add_option("--loss", percent, "Percent of the datagrams that each receiver loses");
    app.add_option("--burst", settings.Faults.Burst, "Datagrams that are lost in a row, on average");
    app.add_option("--delay", delay, "Seconds that a datagram takes after the air");
    app.add_option("--jitter", jitter, "Seconds that a datagram takes longer at most");
    CLI::Option *limit =
        app.add_option("--budget", budget, "Bytes a second of each node; 0: as the channel allows");
    app.add_option("--seed", settings.Seed, "Start of the random numbers; equal seeds give equal flights");
    Rabit::WhatIf::RealLifeSettings real;
    bool isAbout = false;
    app.add_flag("--about", isAbout, "Only write what was recorded");
    app.add_option("--node", real.Node, "Be this node of the flight, in real time, until SIGTERM");
    app.add_option("--life", real.Life, "Which life of the node, from 1");
    app.add_option("--interface", real.Interfaces, "Network interfaces of the node")
        ->delimiter(',')
        ->envname("RABIT_NODE_INTERFACE");
    app.add_option("--record", real.Record, "Folder to record the node into")->envname("RABIT_NODE_RECORD");
    CLI11_PARSE(app, argc, argv);
    settings.Medium.BytesPerSecond = static_cast<std::uint64_t>(rate);
    settings.Faults.Loss = percent / 100;
    settings.Faults.Delay += OfSeconds(delay);
    settings.Faults.Jitter = OfSeconds(jitter);
    if (!limit->empty())
    {
        real.Budget = settings.Budget = budget;
    }
    try
    {
        Rabit::WhatIf::Recording recording(files);
        if (!real.Node.empty())
        {
            FlyLife(recording, real);
            return 0;
        }
        Rabit::RabitLog::SetLevel(Rabit::RabitLogLevel::Off);
        if (isAbout)
        {
            WriteAbout(recording);
        }
        else
        {
            Rabit::WhatIf::SimulatedFlight(recording, settings, Write).Run();
        }
    }
    catch (const std::exception &error)
    {
        std::cerr << error.what() << '\n';
        return 2;
    }
    std::cout.flush();
    return std::cout ? 0 : 1;
}
