// The traffic between the gateways of an idle fleet: whole nodes in one process, over a wire that counts,
// under a clock that the program advances. All subscribe to the `Note` of `ground` alone.
//
// Usage: bench_fleet NODES. Prints, for one node and second, the samples and bytes that it writes and that
// arrive.
#include "WiredTransport.h"

#include <rabit/ManualClock.h>
#include <rabit/RabitSteppedReactor.h>
#include <rabit/RabitWorkspace.h>
#include <rabit/gateway/GatewayManager.h>

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <cstdlib>
#include <iostream>
#include <memory>
#include <string>
#include <vector>

#include "bench.idl.h"

namespace Rabit::Bench
{
namespace
{

using namespace std::chrono_literals;

constexpr auto Settle = 5s;
constexpr auto Measured = 10s;

struct Node
{
    Node(const GatewayConfig &config, Wire &wire, const std::shared_ptr<ManualClock> &clock)
        : Workspace(clock), Reactor(Workspace)
    {
        Reactor.AddManager(
            std::make_unique<GatewayManager>(config, std::make_shared<WiredTransport>(wire), Workspace,
                                             [state = std::uint64_t{42}]() mutable { return ++state; }));
        Reactor.Start();
    }

    RabitWorkspace Workspace;
    RabitSteppedReactor Reactor;
};

GatewayConfig ConfigOf(int number)
{
    GatewayConfig config;
    config.Node = number == 0 ? "ground" : "uav" + std::to_string(number);
    config.Publish.push_back({.Message = "Note", .Type = "Bench::Sample", .Qos = QosProfile::Telemetry});
    config.Subscribe.push_back({.Message = "Note", .Type = "Bench::Sample", .From = {"ground"}});
    config.Accept.push_back({.Queue = "Orders", .Types = {"Bench::Sample"}});
    return config;
}

class Fleet
{
public:
    explicit Fleet(int nodes)
    {
        for (int i = 0; i < nodes; ++i)
        {
            _nodes.push_back(std::make_unique<Node>(ConfigOf(i), _wire, _clock));
        }
    }

    void RunFor(std::chrono::nanoseconds duration)
    {
        const auto end = _clock->Monotonic() + duration;
        while (_clock->Monotonic() < end)
        {
            auto next = end;
            for (const auto &node : _nodes)
            {
                node->Reactor.RunDue();
            }
            for (const auto &node : _nodes)
            {
                next = std::min(next, node->Reactor.NextDue().value_or(end));
            }
            _clock->AdvanceTo(next);
        }
    }

    const Wire::Traffic &Traffic() const { return _wire.Total; }

private:
    Wire _wire;
    std::shared_ptr<ManualClock> _clock = std::make_shared<ManualClock>(1.4e9, 1000s);
    std::vector<std::unique_ptr<Node>> _nodes;
};

}  // namespace
}  // namespace Rabit::Bench

int main(int argc, char **argv)
{
    const int nodes = argc == 2 ? std::atoi(argv[1]) : 0;
    if (nodes < 1)
    {
        std::cerr << "usage: bench_fleet NODES\n";
        return 2;
    }
    Rabit::Bench::Fleet fleet(nodes);
    fleet.RunFor(Rabit::Bench::Settle);
    const Rabit::Bench::Wire::Traffic before = fleet.Traffic();
    fleet.RunFor(Rabit::Bench::Measured);
    const Rabit::Bench::Wire::Traffic after = fleet.Traffic();
    const double share = std::chrono::duration<double>(Rabit::Bench::Measured).count() * nodes;
    const auto rate = [share](std::uint64_t from, std::uint64_t to)
    { return static_cast<double>(to - from) / share; };
    std::cout << "{\"nodes\": " << nodes << ", \"writes_per_s\": " << rate(before.Writes, after.Writes)
              << ", \"written_bytes_per_s\": " << rate(before.WrittenBytes, after.WrittenBytes)
              << ", \"arrivals_per_s\": " << rate(before.Arrivals, after.Arrivals)
              << ", \"arrived_bytes_per_s\": " << rate(before.ArrivedBytes, after.ArrivedBytes) << "}"
              << std::endl;
    return 0;
}
