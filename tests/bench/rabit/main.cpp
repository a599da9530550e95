// A node with a gateway and one manager that plays a role of the benchmarks, or both managers without a
// gateway.
#include "MemberManager.h"
#include "NodeManagers.h"

#include <rabit/RabitReactor.h>
#include <rabit/gateway/GatewayManager.h>
#include <rabit/transport/TransportFactory.h>

#include <exception>
#include <iostream>
#include <memory>
#include <stdexcept>

namespace
{

using namespace Rabit::Bench;

// The node that asks is `ping`, the other one `pong`. Their messages have the same names; their queues are
// `Asked` and `Told`.
bool Asks(const std::string &role)
{
    return role == "ping" || role == "source" || role == "join";
}

Names NamesOf(const BenchOptions &options)
{
    const bool asks = Asks(options.Role);
    if (options.How == Carriage::Queue)
    {
        return asks ? Names{"Told", "pong/Asked"} : Names{"Asked", "ping/Told"};
    }
    return asks ? Names{"pong/Pong", "Ping"} : Names{"ping/Ping", "Pong"};
}

Rabit::GatewayConfig ConfigOf(const BenchOptions &options)
{
    const bool asks = Asks(options.Role);
    const bool isMember = options.Role == "member";
    Rabit::GatewayConfig config;
    config.Node = isMember ? MemberNode(options.Member) : asks ? "ping" : "pong";
    config.Domain = options.Domain;
    config.Transport = options.Transport;
    config.Interfaces = {options.Interface};
    config.MaxDatagram = options.Datagram;
    const std::string type = "Bench::Sample";
    if (options.How == Carriage::Queue)
    {
        config.Accept.push_back({.Queue = asks ? "Told" : "Asked", .Types = {type}});
        return config;
    }
    const auto qos = options.How == Carriage::State ? Rabit::QosProfile::State : Rabit::QosProfile::Telemetry;
    if (isMember)
    {
        config.Publish.push_back({.Message = MemberMessage, .Type = type, .Qos = qos});
        config.Subscribe.push_back({.Message = MemberMessage, .Type = type, .From = {"*"}});
        return config;
    }
    config.Publish.push_back({.Message = asks ? "Ping" : "Pong", .Type = type, .Qos = qos});
    config.Subscribe.push_back(
        {.Message = asks ? "Pong" : "Ping", .Type = type, .From = {asks ? "pong" : "ping"}});
    return config;
}

std::unique_ptr<Rabit::RabitManager> MakeManager(const BenchOptions &options, const Names &names)
{
    if (options.Role == "ping")
    {
        return std::make_unique<PingManager>(options, names);
    }
    if (options.Role == "pong")
    {
        return std::make_unique<PongManager>(options, names);
    }
    if (options.Role == "source" && options.How == Carriage::Queue)
    {
        return std::make_unique<SourceManager>(options, names);
    }
    if (options.Role == "source" || options.Role == "announce")
    {
        return std::make_unique<PacedManager>(options, names);
    }
    if (options.Role == "sink")
    {
        return std::make_unique<SinkManager>(options, names);
    }
    if (options.Role == "join")
    {
        return std::make_unique<JoinManager>(options, names);
    }
    if (options.Role == "member")
    {
        return std::make_unique<MemberManager>(options);
    }
    throw std::invalid_argument("a node has no role " + options.Role);
}

// `local-ping` and `local-source`: both managers in this process, and no gateway.
void AddBoth(BenchOptions options, Rabit::RabitReactor &reactor)
{
    options.Role = options.Role.substr(options.Role.find('-') + 1);
    BenchOptions other = options;
    other.Role = options.Role == "ping" ? "pong" : "sink";
    reactor.AddManager(MakeManager(other, {"Ping", "Pong"}));
    reactor.AddManager(MakeManager(options, {"Pong", "Ping"}));
}

void Run(const BenchOptions &options)
{
    Rabit::RabitReactor reactor;
    if (options.Role.rfind("local-", 0) == 0)
    {
        AddBoth(options, reactor);
    }
    else
    {
        reactor.AddManager(MakeManager(options, NamesOf(options)));
        reactor.AddManager(std::make_unique<Rabit::GatewayManager>(ConfigOf(options),
                                                                   Rabit::MakeTransport(options.Transport)));
    }
    reactor.Run();
}

}  // namespace

int main(int argc, char **argv)
{
    const BenchOptions options = ParseOptions(argc, argv, "A Rabit node that is measured.");
    try
    {
        Run(options);
        return 0;
    }
    catch (const std::exception &error)
    {
        std::cerr << "bench_node: " << error.what() << '\n';
        return 1;
    }
}
