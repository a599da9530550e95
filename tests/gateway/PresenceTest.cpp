// When a gateway tells the others that it is there.
#include <rabit/simulated/SimulatedTransport.h>

#include <algorithm>
#include <chrono>
#include <memory>
#include <vector>

#include "SimulatedFleet.h"

namespace Rabit
{
namespace
{

using namespace std::chrono_literals;

// Hears the beats of all nodes, and when they came.
class BeatListener
{
public:
    explicit BeatListener(SimulatedNetwork &network) : _network(network)
    {
        TransportSettings settings;
        settings.Node = "listener";
        settings.Incarnation = 1;
        _session = SimulatedTransport(network).Open(settings, [](const PeerEvent &) {});
        TopicQos qos;
        qos.Reliability = Reliability::BestEffort;
        _reader = _session->CreateReader({"rabit/Beat", "Rabit::Gateway::Beat", {}}, qos, {},
                                         [this](SampleBytes, const SampleInfo &)
                                         { _times.push_back(_network.Now()); });
    }
    // Beats that came in [from, to).
    std::ptrdiff_t Count(std::chrono::nanoseconds from, std::chrono::nanoseconds to) const
    {
        return std::count_if(_times.begin(), _times.end(),
                             [&](std::chrono::nanoseconds time) { return time >= from && time < to; });
    }

private:
    SimulatedNetwork &_network;
    std::vector<std::chrono::nanoseconds> _times;
    std::unique_ptr<TransportSession> _session;
    std::unique_ptr<TransportReader> _reader;
};

GatewayConfig Uav1()
{
    GatewayConfig config;
    config.Node = "uav1";
    return config;
}

TEST(Presence, ANodeThatAppearsHearsSeveralBeatsBeforeAPeriodIsOver)
{
    SimulatedFleet fleet;
    fleet.Add(Uav1());
    fleet.RunFor(10s);
    const BeatListener listener(fleet.Network);
    const auto appeared = fleet.Network.Now();
    fleet.RunFor(400ms);
    EXPECT_GE(listener.Count(appeared, appeared + 400ms), 4);
}

TEST(Presence, BeatsTwiceASecondOnceAllKnowIt)
{
    SimulatedFleet fleet;
    fleet.Add(Uav1());
    const BeatListener listener(fleet.Network);
    fleet.RunFor(12s);
    EXPECT_EQ(listener.Count(2s, 12s), 20);
}

}  // namespace
}  // namespace Rabit
