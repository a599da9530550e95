// A shared radio channel between network namespaces: each node has a TAP device there. Medium.h describes
// the channel and its limits, Console.h the commands.
#include "RadioProgram.h"

#include <CLI/CLI.hpp>

#include <exception>
#include <iostream>
#include <stdexcept>
#include <string>
#include <vector>

namespace
{

Rabit::Radio::RadioOptions Parse(int argc, char **argv)
{
    CLI::App app("A shared half-duplex radio channel between network namespaces.");
    Rabit::Radio::RadioOptions options;
    std::vector<std::string> nodes;
    std::int64_t rate = 0;
    app.add_option("--node", nodes, "NAME=NAMESPACE, a name below /run/netns or a path; once for each node")
        ->required();
    app.add_option("--rate", rate, "bit/s of the whole medium; 0: unlimited")
        ->check(CLI::Range(std::int64_t{0}, Rabit::Radio::Medium::MostBitsPerSecond));
    app.add_option("--queue", options.Medium.QueueBytes, "Bytes that the queue of each node holds");
    app.add_option("--overhead", options.Medium.Overhead, "Bytes that each frame takes beyond its own")
        ->check(CLI::Range(0, 100'000));
    app.add_option("--seed", options.Medium.Seed, "Of losses, duplicates and jitter");
    app.add_option("--device", options.Device, "Its name in each namespace");
    app.add_option("--pcap", options.Pcap, "Records all that was on the air");
    app.add_option("--control", options.Control, "Unix socket for commands, in place of the standard input");
    try
    {
        app.parse(argc, argv);
        for (const std::string &node : nodes)
        {
            const std::size_t equals = node.find('=');
            if (equals == std::string::npos || equals == 0 || node.find_first_of(" *") != std::string::npos)
            {
                throw CLI::ValidationError("--node", "NAME=NAMESPACE, not " + node);
            }
            options.Nodes.emplace_back(node.substr(0, equals), node.substr(equals + 1));
        }
    }
    catch (const CLI::ParseError &error)
    {
        std::exit(app.exit(error) == 0 ? 0 : 2);
    }
    if (rate > 0)
    {
        options.Medium.BitsPerSecond = rate;
    }
    return options;
}

}  // namespace

int main(int argc, char **argv)
{
    try
    {
        Rabit::Radio::RadioProgram(Parse(argc, argv)).Run();
        return 0;
    }
    catch (const std::exception &error)
    {
        std::cerr << "radio: " << error.what() << '\n';
        return 1;
    }
}
