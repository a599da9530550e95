// The cost of the gateways of a fleet: whole nodes in one process, over a wire that counts, under a clock
// that the program advances.
//
// Usage: bench_fleet NODES [idle | flying]. Prints, for one node and second, the samples and bytes that it
// writes and that arrive. `idle`: all subscribe to the `Note` of `ground` alone, and nobody posts one.
// `flying`: all post a `Note` twice a second, and `ground` follows all nodes. The others follow ten
// neighbours and `ground`. A manager of each node fetches the notes and `Gateway/Fleet`. With `valgrind
// --tool=callgrind --instr-atstart=no` the instructions of the measured seconds are counted.
#include "WiredTransport.h"

#include <rabit/ManualClock.h>
#include <rabit/RabitManager.h>
#include <rabit/RabitSteppedReactor.h>
#include <rabit/RabitWorkspace.h>
#include <rabit/gateway/GatewayManager.h>

#include <valgrind/callgrind.h>

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <cstdlib>
#include <iostream>
#include <memory>
#include <string>
#include <vector>

#include "bench.idl.h"
#include "gateway.idl.h"

// A function with a plain name, for callgrind: the work of `ground`.
extern "C" [[gnu::noinline]] void RunGround(Rabit::RabitSteppedReactor &reactor)
{
    reactor.RunDue();
}

namespace Rabit::Bench
{
namespace
{

using namespace std::chrono_literals;

constexpr auto Settle = 5s;
constexpr auto Measured = 10s;
constexpr auto MeasuredInFlight = 2s;
constexpr int Neighbours = 10;
constexpr auto PosePeriod = 500ms;

std::string NameOf(int number)
{
    return number == 0 ? "ground" : "uav" + std::to_string(number);
}

// The nodes that a node of a flying fleet follows: ground all others, the others their neighbours in a ring.
std::vector<std::string> FollowedBy(int number, int nodes)
{
    std::vector<std::string> names;
    for (int other = 0; other < nodes; ++other)
    {
        const int distance = std::min((other - number + nodes) % nodes, (number - other + nodes) % nodes);
        if (other != number && (number == 0 || other == 0 || distance <= Neighbours / 2))
        {
            names.push_back(NameOf(other));
        }
    }
    return names;
}

// Posts a `Note` each half second, and fetches what comes.
class Pilot final : public RabitManager
{
public:
    Pilot(const std::vector<std::string> &followed, RabitWorkspace &workspace)
        : RabitManager("Pilot", workspace)
    {
        AddPublishSubscribeMessage("Note", _note);
        _note->padding.assign(80, 0x5a);
        Follow(FleetMessageName, std::make_shared<Gateway::Fleet>());
        for (const std::string &node : followed)
        {
            Follow(node + "/Note", std::make_shared<::Bench::Sample>());
        }
        SetWakeupTimeDelayMSec(static_cast<int>(std::chrono::milliseconds(PosePeriod).count()));
    }

    void ExecuteUnitOfWork() override
    {
        for (const auto &message : _followed)
        {
            message->FetchMessage();
        }
        const auto now = GetWorkspace().GetClock().Monotonic();
        if (now >= _due)
        {
            _due = now + PosePeriod;
            _note->PostMessage();
        }
    }

private:
    void Follow(const std::string &name, const std::shared_ptr<RabitMessage> &message)
    {
        AddPublishSubscribeMessage(name, message);
        WakeUpManagerOnMessagePost(message);
        _followed.push_back(message);
    }

    std::shared_ptr<::Bench::Sample> _note = std::make_shared<::Bench::Sample>();
    std::vector<std::shared_ptr<RabitMessage>> _followed;
    std::chrono::nanoseconds _due{0};
};

struct Node
{
    Node(const GatewayConfig &config, Wire &wire, const std::shared_ptr<ManualClock> &clock)
        : Workspace(clock), Reactor(Workspace)
    {
        Reactor.AddManager(
            std::make_unique<GatewayManager>(config, std::make_shared<WiredTransport>(wire), Workspace,
                                             [state = std::uint64_t{42}]() mutable { return ++state; }));
    }

    RabitWorkspace Workspace;
    RabitSteppedReactor Reactor;
};

GatewayConfig ConfigOf(int number, std::vector<std::string> from)
{
    GatewayConfig config;
    config.Node = NameOf(number);
    config.Publish.push_back({.Message = "Note", .Type = "Bench::Sample", .Qos = QosProfile::Telemetry});
    config.Subscribe.push_back({.Message = "Note", .Type = "Bench::Sample", .From = std::move(from)});
    config.Accept.push_back({.Queue = "Orders", .Types = {"Bench::Sample"}});
    return config;
}

class Fleet
{
public:
    Fleet(int nodes, bool isFlying)
    {
        for (int i = 0; i < nodes; ++i)
        {
            const auto followed = isFlying ? FollowedBy(i, nodes) : std::vector<std::string>{"ground"};
            const auto from = isFlying && i == 0 ? std::vector<std::string>{"*"} : followed;
            _nodes.push_back(std::make_unique<Node>(ConfigOf(i, from), _wire, _clock));
            if (isFlying)
            {
                _nodes.back()->Reactor.AddManager(
                    std::make_unique<Pilot>(followed, _nodes.back()->Workspace));
            }
            _nodes.back()->Reactor.Start();
            // Nodes beat and post at different times.
            RunFor(std::chrono::nanoseconds(Settle) / nodes);
        }
    }

    void RunFor(std::chrono::nanoseconds duration)
    {
        const auto end = _clock->Monotonic() + duration;
        while (_clock->Monotonic() < end)
        {
            auto next = end;
            RunGround(_nodes.front()->Reactor);
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
    const int nodes = argc == 2 || argc == 3 ? std::atoi(argv[1]) : 0;
    const std::string what = argc == 3 ? argv[2] : "idle";
    if (nodes < 1 || (what != "idle" && what != "flying"))
    {
        std::cerr << "usage: bench_fleet NODES [idle | flying]\n";
        return 2;
    }
    const bool isFlying = what == "flying";
    const std::chrono::nanoseconds measured =
        isFlying ? Rabit::Bench::MeasuredInFlight : Rabit::Bench::Measured;
    Rabit::Bench::Fleet fleet(nodes, isFlying);
    fleet.RunFor(Rabit::Bench::Settle);
    const Rabit::Bench::Wire::Traffic before = fleet.Traffic();
    CALLGRIND_START_INSTRUMENTATION;
    fleet.RunFor(measured);
    CALLGRIND_STOP_INSTRUMENTATION;
    const Rabit::Bench::Wire::Traffic after = fleet.Traffic();
    const double share = std::chrono::duration<double>(measured).count() * nodes;
    const auto rate = [share](std::uint64_t from, std::uint64_t to)
    { return static_cast<double>(to - from) / share; };
    std::cout << "{\"nodes\": " << nodes << ", \"writes_per_s\": " << rate(before.Writes, after.Writes)
              << ", \"written_bytes_per_s\": " << rate(before.WrittenBytes, after.WrittenBytes)
              << ", \"arrivals_per_s\": " << rate(before.Arrivals, after.Arrivals)
              << ", \"arrived_bytes_per_s\": " << rate(before.ArrivedBytes, after.ArrivedBytes) << "}"
              << std::endl;
    return 0;
}
