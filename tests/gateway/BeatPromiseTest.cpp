// Beats of a node with a budget come as promised, whatever else it sends: whole nodes on the simulated
// network.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <string>
#include <vector>

#include "HandNode.h"
#include "SimulatedFleet.h"

namespace Rabit
{
namespace
{

using namespace std::chrono_literals;
using Duration = std::chrono::nanoseconds;

// Listens to the beats of one node, and compares the pauses between them with what the beats promised.
class BeatEar
{
public:
    BeatEar(SimulatedNetwork &network, std::string of)
        : _of(std::move(of)),
          _node(network, "ear", 1, [this](SampleBytes bytes, const SampleInfo &info) { Hear(bytes, info); })
    {
    }

    // Forgets all beats but the newest.
    void Begin()
    {
        _beats = 0;
        _latest = -1h;
        _longest = 0s;
    }
    std::size_t Beats() const { return _beats; }
    // Returns how much later than promised the latest beat came; negative if all came earlier.
    Duration LatestAgainstPromise() const { return _latest; }
    Duration LongestPause() const { return _longest; }

private:
    void Hear(SampleBytes bytes, const SampleInfo &info)
    {
        if (info.Node != _of || !BeatFormat::IsPresent(bytes))
        {
            return;
        }
        std::uint16_t nextMs = 0;
        std::int64_t source = 0;
        std::memcpy(&nextMs, bytes.data() + 6, sizeof nextMs);
        std::memcpy(&source, bytes.data() + 12, sizeof source);
        const Duration at(source);
        if (_last != 0s)
        {
            _longest = std::max(_longest, at - _last);
            _latest = std::max(_latest, at - _last - _promised);
        }
        ++_beats;
        _last = at;
        _promised = std::chrono::milliseconds(nextMs);
    }

    const std::string _of;
    std::size_t _beats = 0;
    Duration _last{0};
    Duration _promised{0};
    Duration _latest = -1h;
    Duration _longest{0};
    HandNode _node;
};

double Seconds(Duration time)
{
    return std::chrono::duration<double>(time).count();
}

class BeatPromiseTest : public ::testing::TestWithParam<int>
{
};

INSTANTIATE_TEST_SUITE_P(Peers, BeatPromiseTest, ::testing::Values(20, 50));

// When a DDS announcement is due, once in 30 s, the budget begins at that moment to keep room for it: some
// 560 bytes with the heads, 112 ms of 5000 B/s.
constexpr Duration Slack = 115ms;

// A ground station that acknowledges the reports of all aircraft, and answers them with commands.
TEST_P(BeatPromiseTest, IsKeptBesideAcknowledgementsForAll)
{
    SimulatedFleet fleet;
    GatewayConfig station = GroundConfig();
    station.Radio.Budget = 5000;
    SimulatedNode &ground = fleet.Add(station);
    IdleManager &commands = ground.AddIdleManager("Commands");
    std::vector<SimulatedNode *> aircraft;
    for (int i = 0; i < GetParam(); ++i)
    {
        aircraft.push_back(&fleet.Add(AircraftConfig("uav" + std::to_string(10 + i))));
        aircraft.back()->AddIdleManager("MissionControl");
        fleet.RunFor(100ms);
    }
    BeatEar ear(fleet.Network, "ground");
    const auto work = [&](Duration duration)
    {
        for (Duration passed = 0s; passed < duration; passed += 100ms)
        {
            for (SimulatedNode *node : aircraft)
            {
                auto report = std::make_shared<Uav::CommandAck>();
                node->Workspace.AddMessageToQueue("ground/Commands", report);
            }
            ground.Workspace.AddMessageToQueue("*/MissionControl", std::make_shared<Uav::Goto>());
            fleet.RunFor(100ms);
            std::shared_ptr<RabitMessage> message;
            while (commands.GetManagerMessageQueue()->GetMessage(message))
            {
            }
        }
    };
    work(20s);
    ear.Begin();
    work(30s);
    EXPECT_GE(ear.Beats(), 30u);
    EXPECT_LE(Seconds(ear.LatestAgainstPromise()), Seconds(Slack));
}

// A State that takes four seconds of the budget. Beats and commands go between its datagrams.
TEST(BeatPromiseBesideALargeState, IsKeptAndCommandsDoNotWait)
{
    SimulatedFleet fleet;
    GatewayConfig config = AircraftConfig("uav1");
    config.Radio.Budget = 5000;
    config.Publish.push_back({.Message = "Picture", .Type = "Uav::Picture"});
    SimulatedNode &uav = fleet.Add(config);
    const auto picture = uav.Register<Uav::Picture>("Picture");
    GatewayConfig station = GroundConfig();
    station.Subscribe.push_back({.Message = "Picture", .Type = "Uav::Picture", .From = {"uav*"}});
    SimulatedNode &ground = fleet.Add(station);
    IdleManager &commands = ground.AddIdleManager("Commands");
    const auto seen = ground.Register<Uav::Picture>("uav1/Picture");
    fleet.RunFor(20s);
    BeatEar ear(fleet.Network, "uav1");
    fleet.RunFor(10s);
    ear.Begin();
    const std::uint64_t before = fleet.Network.Sent("uav1").Bytes;
    Duration longestWait = 0s;
    int came = 0;
    std::vector<Duration> arrived;
    for (int i = 1; i <= 3; ++i)
    {
        picture->jpeg.assign(20'000, static_cast<std::uint8_t>(i));
        picture->PostMessage();
        Duration sentAt = 0s;
        for (Duration passed = 0s; passed < 10s; passed += 5ms)
        {
            if (passed % 1s == 300ms)
            {
                sentAt = passed;
                uav.Workspace.AddMessageToQueue("ground/Commands", std::make_shared<Uav::CommandAck>());
            }
            fleet.RunFor(5ms);
            std::shared_ptr<RabitMessage> message;
            while (commands.GetManagerMessageQueue()->GetMessage(message))
            {
                ++came;
                longestWait = std::max(longestWait, passed - sentAt);
            }
            if (seen->FetchMessage())
            {
                arrived.push_back(passed);
                EXPECT_EQ(seen->jpeg, picture->jpeg);
            }
            EXPECT_EQ(ground.StateOf("uav1"), "UP");
        }
    }
    EXPECT_NE(
        uav.Problems().find("publish Picture: one value takes more than a second of the budget of 5000"),
        std::string::npos)
        << uav.Problems();
    EXPECT_LE(Seconds(ear.LatestAgainstPromise()), Seconds(Slack));
    EXPECT_EQ(came, 30);
    EXPECT_LE(Seconds(longestWait), 0.5);
    ASSERT_EQ(arrived.size(), 3u);
    // The State takes 15 datagrams, of which three fit into a second beside beats and commands.
    EXPECT_LE(Seconds(*std::max_element(arrived.begin(), arrived.end())), 7.5);
    // Each datagram went once: no node requested one that was still under way.
    EXPECT_LE(fleet.Network.Sent("uav1").Bytes - before, 3 * 22'000u + 30 * 600u);
}

}  // namespace
}  // namespace Rabit
