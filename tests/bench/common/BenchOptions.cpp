#include "BenchOptions.h"

#include <CLI/CLI.hpp>

#include <cstdlib>
#include <iostream>
#include <map>

namespace Rabit::Bench
{

std::size_t BenchOptions::Padding() const
{
    return Payload - SampleOverhead;
}

BenchOptions ParseOptions(int argc, char **argv, const char *description)
{
    CLI::App app(description);
    BenchOptions options;
    app.add_option("--role", options.Role, "ping, pong, source, sink, announce, join, member ...")
        ->required();
    const std::map<std::string, Carriage> names = {
        {"state", Carriage::State}, {"telemetry", Carriage::Telemetry}, {"queue", Carriage::Queue}};
    app.add_option("--carriage", options.How, "state, telemetry or queue")
        ->transform(CLI::CheckedTransformer(names));
    app.add_option("--domain", options.Domain);
    app.add_option("--payload", options.Payload, "Bytes of a message")->check(CLI::Range(20u, 60u << 20));
    app.add_option("--warm-up", options.WarmUp, "Messages before those that are measured");
    app.add_option("--count", options.Count, "Messages that are measured");
    app.add_option("--period", options.Period, "Nanoseconds between two messages; 0: as fast as it goes");
    app.add_option("--spawned-at", options.SpawnedAt, "CLOCK_MONOTONIC at the start of the process");
    app.add_option("--member", options.Member, "Which one of a fleet, from 1");
    app.add_option("--members", options.Members, "How many the fleet has")->check(CLI::Range(2u, 200u));
    app.add_flag("--in-listener", options.InListener, "Answer in the vendor's listener");
    app.add_flag("--writer-thread", options.WriterThread, "Write on a thread of its own");
    app.add_option("--transport", options.Transport);
    app.add_option("--interface", options.Interface, "Address of the network interface");
    app.add_option("--datagram", options.Datagram, "Largest datagram in bytes")
        ->check(CLI::Range(1000u, 65000u));
    try
    {
        app.parse(argc, argv);
    }
    catch (const CLI::ParseError &error)
    {
        std::exit(app.exit(error) == 0 ? 0 : 2);
    }
    if (options.Member < 1 || options.Member > options.Members ||
        (options.Role == "member" && options.Period <= 0))
    {
        std::cerr << "--member is from 1 to --members, and a member needs a --period\n";
        std::exit(2);
    }
    return options;
}

}  // namespace Rabit::Bench
