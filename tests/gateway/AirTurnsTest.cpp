// Streams of a node with a budget ride in each other's datagrams: whole nodes on the simulated network.
#include <gtest/gtest.h>

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <functional>
#include <memory>
#include <vector>

#include "HandNode.h"
#include "PlainProgram.h"
#include "SimulatedFleet.h"

namespace Rabit
{
namespace
{

using namespace std::chrono_literals;
using Duration = std::chrono::nanoseconds;

constexpr Duration TurnStep = 5ms;
constexpr Duration TurnPosePeriod = 100ms;

// An aircraft that posts its pose ten times a second, a ground station, and a node that counts the aircraft's
// beats.
class AirTurnsTest : public ::testing::Test
{
protected:
    void AddBoth(const GatewayConfig &config)
    {
        aircraft = &fleet.Add(config);
        pose = aircraft->Register<Uav::Pose>("Pose");
        state = aircraft->Register<Uav::MissionState>("MissionState");
        ground = &fleet.Add(GroundConfig());
        ear = std::make_unique<HandNode>(
            fleet.Network, "ear", 1,
            [this](SampleBytes bytes, const SampleInfo &info)
            { beats += info.Node == "uav1" && BeatFormat::IsPresent(bytes) ? 1 : 0; });
        Fly(10s);
    }

    static GatewayConfig WithBudget(double budget)
    {
        GatewayConfig config = AircraftConfig("uav1");
        config.Radio.Budget = budget;
        return config;
    }

    void Fly(
        Duration duration, const std::function<void(Duration)> &each = [](Duration) {})
    {
        for (Duration passed = 0s; passed < duration; passed += TurnStep)
        {
            if (passed % TurnPosePeriod == 0s)
            {
                ++pose->number;
                pose->PostMessage();
            }
            each(passed);
            fleet.RunFor(TurnStep);
        }
    }

    // Datagrams of samples, which are all that are no announcements.
    struct Count
    {
        std::uint64_t Datagrams = 0;
        std::uint64_t Bytes = 0;
        std::uint64_t Beats = 0;
        std::uint64_t Poses = 0;
    };
    Count CountIn(Duration duration)
    {
        const SimulatedSent before = fleet.Network.Sent("uav1");
        const std::uint64_t beatsBefore = beats;
        Fly(duration);
        const SimulatedSent after = fleet.Network.Sent("uav1");
        return {after.Datagrams - before.Datagrams,
                after.Bytes - before.Bytes - (after.DiscoveryBytes - before.DiscoveryBytes),
                beats - beatsBefore, static_cast<std::uint64_t>(duration / TurnPosePeriod)};
    }

    SimulatedFleet fleet;
    SimulatedNode *aircraft = nullptr;
    SimulatedNode *ground = nullptr;
    std::unique_ptr<HandNode> ear;
    std::shared_ptr<Uav::Pose> pose;
    std::shared_ptr<Uav::MissionState> state;
    std::uint64_t beats = 0;
};

TEST_F(AirTurnsTest, ABeatRidesInTheDatagramOfAPose)
{
    AddBoth(WithBudget(3000));
    const Count count = CountIn(60s);
    EXPECT_GE(count.Beats, 50u);
    // Announcements of DDS are datagrams, too.
    EXPECT_LE(count.Datagrams, count.Poses + count.Beats / 4) << count.Beats << " beats";
}

TEST_F(AirTurnsTest, WithoutABudgetEachSampleHasADatagramOfItsOwn)
{
    AddBoth(AircraftConfig("uav1"));
    const Count count = CountIn(60s);
    EXPECT_GE(count.Beats, 100u);
    EXPECT_GE(count.Datagrams, count.Poses + count.Beats);
}

// Beats have a twentieth of the budget as if each went alone. The bytes that riding saves are for the others.
TEST_F(AirTurnsTest, ABeatThatRidesSavesItsHeaders)
{
    AddBoth(WithBudget(3000));
    const Count count = CountIn(60s);
    const std::uint64_t ofBeats = count.Bytes - count.Poses * 148;
    EXPECT_GE(count.Beats, 50u);
    EXPECT_LE(static_cast<double>(ofBeats), 0.04 * 3000 * 60) << count.Beats << " beats";
}

TEST_F(AirTurnsTest, WhatAStreamWritesComesInItsOrderAndOnce)
{
    AddBoth(WithBudget(3000));
    PlainProgram poses(fleet.Network, "Pose", "Uav::Pose", Reliability::BestEffort);
    IdleManager &commands = ground->AddIdleManager("Commands");
    Fly(10s);
    poses.Samples.clear();
    std::uint32_t sent = 0;
    std::uint32_t got = 0;
    Fly(20s,
        [&](Duration passed)
        {
            if (passed % 200ms == 0s)
            {
                ++state->commands;
                state->PostMessage();
                auto report = std::make_shared<Uav::CommandAck>();
                report->id = ++sent;
                ASSERT_TRUE(aircraft->Workspace.AddMessageToQueue("ground/Commands", report));
            }
            std::shared_ptr<RabitMessage> message;
            while (commands.GetManagerMessageQueue()->GetMessage(message))
            {
                EXPECT_EQ(std::dynamic_pointer_cast<Uav::CommandAck>(message)->id, ++got);
            }
        });
    EXPECT_GE(got, sent - 10);
    ASSERT_GE(poses.Samples.size(), 100u);
    std::uint32_t last = 0;
    for (const std::vector<std::uint8_t> &sample : poses.Samples)
    {
        constexpr std::size_t numberAt =
            4 + 3 * 8 + 6 * 4 + 8;  // of Uav::Pose in CDR, with its encapsulation
        std::uint32_t number = 0;
        ASSERT_GE(sample.size(), numberAt + sizeof number);
        std::memcpy(&number, sample.data() + numberAt, sizeof number);
        EXPECT_GT(number, last);
        last = number;
    }
}

// The rate of a message counts the headers that its datagrams have.
TEST_F(AirTurnsTest, TheRatesOfStreamsAddUpToWhatIsSent)
{
    AddBoth(WithBudget(3000));
    Fly(20s,
        [&](Duration passed)
        {
            if (passed % 50ms == 0s)
            {
                ++state->commands;
                state->PostMessage();
            }
        });
    const Gateway::Fleet told = aircraft->Fleet();
    double publications = 0.0;
    for (const auto &publication : told.publications)
    {
        publications += publication.bytes_per_s;
    }
    EXPECT_GT(publications, 0.0);
    EXPECT_LE(publications, told.air.used);
    EXPECT_NEAR(
        told.air.used,
        told.air.discovery + told.air.presence + told.air.command + told.air.state + told.air.telemetry, 1.0);
}

}  // namespace
}  // namespace Rabit
