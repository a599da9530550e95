// The traffic that a gateway sends, and its order: whole nodes on the simulated network.
#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <vector>

#include "PlainProgram.h"
#include "SimulatedFleet.h"
#include "keyed.idl.h"

namespace Rabit
{
namespace
{

using namespace std::chrono_literals;
using Duration = std::chrono::nanoseconds;

constexpr double Budget = 3000;
constexpr Duration Step = 5ms;

class AirTrafficTest : public ::testing::Test
{
protected:
    SimulatedNode &AddAircraft(const GatewayConfig &config)
    {
        SimulatedNode &node = fleet.Add(config);
        aircraft = &node;
        pose = node.Register<Uav::Pose>("Pose");
        state = node.Register<Uav::MissionState>("MissionState");
        return node;
    }

    static GatewayConfig WithBudget(GatewayConfig config, double budget = Budget)
    {
        config.Radio.Budget = budget;
        return config;
    }

    // Lets the aircraft post with these periods for `duration`, and calls `each` after each step.
    void Fly(
        Duration duration, Duration posePeriod, Duration statePeriod,
        const std::function<void(Duration)> &each = [](Duration) {})
    {
        for (Duration passed = 0s; passed < duration; passed += Step)
        {
            if (passed % posePeriod == 0s)
            {
                ++pose->number;
                pose->PostMessage();
            }
            if (passed % statePeriod == 0s)
            {
                ++state->commands;
                state->PostMessage();
            }
            fleet.RunFor(Step);
            each(passed);
        }
    }

    bool SendReport(std::uint32_t number)
    {
        auto report = std::make_shared<Uav::CommandAck>();
        report->id = number;
        return aircraft->Workspace.AddMessageToQueue("ground/Commands", report);
    }

    std::uint64_t Bytes(const std::string &node) { return fleet.Network.Sent(node).Bytes; }

    SimulatedFleet fleet;
    SimulatedNode *aircraft = nullptr;
    std::shared_ptr<Uav::Pose> pose;
    std::shared_ptr<Uav::MissionState> state;
};

// The bytes sent in each step, as the transport counts them.
class Spending
{
public:
    void Add(std::uint64_t total) { _totals.push_back(total); }
    // Returns the most bytes of any second, wherever it begins.
    std::uint64_t MostInASecond() const
    {
        constexpr std::size_t second = 1s / Step;
        std::uint64_t most = 0;
        for (std::size_t i = second; i < _totals.size(); ++i)
        {
            most = std::max(most, _totals[i] - _totals[i - second]);
        }
        return most;
    }
    double PerSecond() const
    {
        const double seconds =
            std::chrono::duration<double>(Step).count() * static_cast<double>(_totals.size() - 1);
        return static_cast<double>(_totals.back() - _totals.front()) / seconds;
    }

private:
    std::vector<std::uint64_t> _totals;
};

TEST_F(AirTrafficTest, NoSecondHasMoreThanTheBudgetHoweverMuchIsOffered)
{
    AddAircraft(WithBudget(AircraftConfig("uav1")));
    SimulatedNode &ground = fleet.Add(GroundConfig());
    ground.AddIdleManager("Commands");
    Fly(10s, 5ms, 1s);
    Spending spending;
    std::uint32_t sent = 0;
    Fly(60s, 5ms, 1s,
        [&](Duration passed)
        {
            spending.Add(Bytes("uav1"));
            if (passed % 50ms == 0s)
            {
                SendReport(++sent);
            }
        });
    EXPECT_LE(static_cast<double>(spending.MostInASecond()), 1.05 * Budget);
    // The budget keeps room for DDS's announcements only when they go, twice in that time.
    EXPECT_GE(spending.PerSecond(), 0.85 * Budget);
    EXPECT_EQ(ground.StateOf("uav1"), "UP");
}

TEST_F(AirTrafficTest, RoomForAnAnnouncementOfDdsIsNotKeptBeforeItIsDue)
{
    constexpr double budget = 1500;
    fleet.Add(GroundConfig()).AddIdleManager("Commands");
    AddAircraft(WithBudget(AircraftConfig("uav1"), budget));
    Fly(3s, 5ms, 1s);  // the nodes meet, and DDS announces them; the next announcement is due after 30 s
    Spending spending;
    Fly(10s, 5ms, 1s, [&](Duration) { spending.Add(Bytes("uav1")); });
    EXPECT_GE(spending.PerSecond(), 0.8 * budget);
}

// Samples to a node also go to the session of its earlier incarnation until the lease of that runs out.
TEST_F(AirTrafficTest, NoSecondHasMoreThanTheBudgetWhenANodeHasCrashedAndCameBack)
{
    AddAircraft(WithBudget(AircraftConfig("uav1"), 1500));
    fleet.Add(GroundConfig()).AddIdleManager("Commands");
    Fly(10s, 500ms, 1s);
    fleet.Kill("ground");
    Fly(1s, 500ms, 1s);
    IdleManager &commands = fleet.Add(GroundConfig(), 1.4e9 + 100).AddIdleManager("Commands");
    auto report = std::make_shared<Uav::CommandAck>();
    report->reason = std::string(100, 'x');
    Spending spending;
    Fly(25s, 500ms, 1s,
        [&](Duration)
        {
            const SimulatedSent all = fleet.Network.Sent("uav1");
            spending.Add(all.Bytes - all.DiscoveryBytes);
            aircraft->Workspace.AddMessageToQueue("ground/Commands", report);
            std::shared_ptr<RabitMessage> message;
            commands.GetManagerMessageQueue()->GetMessage(message);
        });
    EXPECT_LE(static_cast<double>(spending.MostInASecond()), 1.05 * 1500);
}

// Each node lacks the others' announcements, and all beats have much to carry.
TEST_F(AirTrafficTest, NoSecondHasMoreThanTheBudgetWhenBeatsHaveMuchToSay)
{
    GatewayConfig config = WithBudget(AircraftConfig("uav1"), 1500);
    for (int i = 0; i < 20; ++i)
    {
        config.Publish.push_back({.Message = "State" + std::to_string(i), .Type = "Uav::MissionState"});
    }
    AddAircraft(config);
    Fly(5s, 100ms, 1s);
    fleet.Add(GroundConfig()).AddIdleManager("Commands");
    fleet.Add(AircraftConfig("uav2"));
    Spending spending;
    std::uint32_t sent = 0;
    Fly(60s, 100ms, 1s,
        [&](Duration passed)
        {
            if (passed == 20s)
            {
                fleet.Add(AircraftConfig("uav3"));
            }
            const SimulatedSent all = fleet.Network.Sent("uav1");
            spending.Add(all.Bytes - all.DiscoveryBytes);
            if (passed % 100ms == 0s)
            {
                SendReport(++sent);
            }
        });
    EXPECT_LE(static_cast<double>(spending.MostInASecond()), 1.05 * 1500);
}

// Each of its beats goes to six nodes, a copy to each.
TEST_F(AirTrafficTest, ANodeThatSendsByUnicastIsAnnouncedThroughASmallBudgetToo)
{
    GatewayConfig config = WithBudget(AircraftConfig("uav1"), 1500);
    config.Multicast = false;
    config.Peers = {"10.0.0.2"};
    AddAircraft(config).AddIdleManager("MissionControl");
    SimulatedNode &ground = fleet.Add(GroundConfig());
    for (int i = 2; i <= 6; ++i)
    {
        fleet.Add(AircraftConfig("uav" + std::to_string(i)));
    }
    fleet.RunFor(60s);
    EXPECT_TRUE(ground.Workspace.AddMessageToQueue("uav1/MissionControl", std::make_shared<Uav::Goto>()));
}

TEST_F(AirTrafficTest, TheNewestPostIsSentAndTheOthersAreCounted)
{
    AddAircraft(WithBudget(AircraftConfig("uav1")));
    SimulatedNode &ground = fleet.Add(GroundConfig());
    auto seen = ground.Register<Uav::Pose>("uav1/Pose");
    Fly(10s, 5ms, 1s);
    seen->FetchMessage();
    Duration oldest = 0s;
    std::uint32_t heard = 0;
    Fly(20s, 5ms, 1s,
        [&](Duration)
        {
            if (seen->FetchMessage())
            {
                ++heard;
                oldest = std::max(
                    oldest, Duration(static_cast<std::int64_t>(1e9 * seen->GetAgeSeconds(*ground.Clock))));
            }
        });
    EXPECT_GT(heard, 200u);
    EXPECT_LT(oldest, 20ms);  // a post every 5 ms, a step of 5 ms, and the way
    const Gateway::PublicationStatus status = aircraft->Fleet().publications.at(0);
    EXPECT_EQ(status.message, "Pose");
    EXPECT_NEAR(static_cast<double>(status.offered), 6000.0, 201.0);  // up to the last report
    EXPECT_GT(status.replaced, 4000u);
    EXPECT_LE(status.offered - status.written - status.replaced, 1u);
}

TEST_F(AirTrafficTest, CommandsDoNotWaitForTelemetry)
{
    AddAircraft(WithBudget(AircraftConfig("uav1")));
    SimulatedNode &ground = fleet.Add(GroundConfig());
    IdleManager &commands = ground.AddIdleManager("Commands");
    Fly(10s, 5ms, 50ms);
    std::vector<Duration> waits;
    Duration sentAt = 0s;
    Fly(60s, 5ms, 50ms,
        [&](Duration passed)
        {
            std::shared_ptr<RabitMessage> message;
            while (commands.GetManagerMessageQueue()->GetMessage(message))
            {
                waits.push_back(passed - sentAt);
            }
            if (passed % 1s == 0s)
            {
                sentAt = passed;
                ASSERT_TRUE(SendReport(1));
            }
        });
    ASSERT_EQ(waits.size(), 60u);
    // The first report waits until the two nodes have exchanged hellos. Each later one waits for a datagram
    // of 70 ms, its acknowledgement, a beat, and DDS's own traffic.
    EXPECT_LE(*std::max_element(waits.begin(), waits.end()), 400ms);
    std::nth_element(waits.begin(), waits.begin() + 30, waits.end());
    EXPECT_LE(waits[30], 80ms);
}

// The station's budget is full of a large State when it meets ten aircraft, which may send no second report
// before the first acknowledgement.
TEST_F(AirTrafficTest, ReportsToAStationThatIsBusyWithALargeValueArriveSoon)
{
    constexpr std::size_t size = 10;
    std::vector<SimulatedNode *> aircraftOfFleet;
    for (std::size_t i = 0; i < size; ++i)
    {
        GatewayConfig config = WithBudget(AircraftConfig("uav" + std::to_string(i)), 1500);
        config.Subscribe.push_back({.Message = "Map", .Type = "Uav::Picture", .From = {"ground"}});
        aircraftOfFleet.push_back(&fleet.Add(config));
        static_cast<void>(aircraftOfFleet.back()->Register<Uav::Picture>("ground/Map"));
    }
    fleet.RunFor(10s);
    GatewayConfig config = WithBudget(GroundConfig(), 5000);
    config.Publish.push_back({.Message = "Map", .Type = "Uav::Picture"});
    SimulatedNode &ground = fleet.Add(config);
    IdleManager &commands = ground.AddIdleManager("Commands");
    const auto map = ground.Register<Uav::Picture>("Map");
    map->jpeg.resize(20'000);
    std::vector<Duration> sentAt;
    std::vector<Duration> waits;
    for (Duration passed = 0s; passed < 30s; passed += Step)
    {
        if (passed % 12s == 0s)
        {
            map->PostMessage();
        }
        for (std::size_t i = 0; i < size; ++i)
        {
            auto report = std::make_shared<Uav::CommandAck>();
            report->id = static_cast<std::uint32_t>(sentAt.size());
            if (passed % 1s == i * 10ms && passed > 2s &&
                aircraftOfFleet[i]->Workspace.AddMessageToQueue("ground/Commands", report))
            {
                sentAt.push_back(passed);
            }
        }
        std::shared_ptr<RabitMessage> message;
        while (commands.GetManagerMessageQueue()->GetMessage(message))
        {
            waits.push_back(passed - sentAt.at(std::dynamic_pointer_cast<Uav::CommandAck>(message)->id));
        }
        fleet.RunFor(Step);
    }
    EXPECT_GE(waits.size(), 270u);
    std::sort(waits.begin(), waits.end());
    EXPECT_LE(waits[waits.size() * 9 / 10], 100ms);
    EXPECT_LE(waits.back(), 1s);
}

TEST_F(AirTrafficTest, WeightsHoldAmongMessagesOfAClass)
{
    GatewayConfig config = WithBudget(AircraftConfig("uav1"));
    config.Publish[0].Class = TrafficClass::Telemetry;
    config.Publish[0].Weight = 3.0;
    config.Publish[1].Class = TrafficClass::Telemetry;
    AddAircraft(config);
    fleet.Add(GroundConfig());
    Fly(10s, 5ms, 5ms);
    double heavy = 0.0;
    double light = 0.0;
    Fly(60s, 5ms, 5ms,
        [&](Duration passed)
        {
            if (passed % 1s == 0s)
            {
                const auto rates = aircraft->Fleet().publications;
                heavy += rates.at(0).bytes_per_s;
                light += rates.at(1).bytes_per_s;
            }
        });
    const auto publications = aircraft->Fleet().publications;
    ASSERT_EQ(publications.size(), 2u);
    const Gateway::AirStatus air = aircraft->Fleet().air;
    EXPECT_GT(publications[0].bytes_per_s, 0.35 * Budget);
    // The long-run share is of bytes. A message that rides takes fewer than one that goes alone.
    EXPECT_NEAR(heavy / light, 3.0, 0.2);
    EXPECT_NEAR(air.telemetry, publications[0].bytes_per_s + publications[1].bytes_per_s, 1.0);
    EXPECT_EQ(air.budget, Budget);
    EXPECT_LE(air.used, 1.05 * Budget);
    EXPECT_NEAR(air.used, air.discovery + air.presence + air.command + air.state + air.telemetry + air.bulk,
                1.0);
    EXPECT_EQ(air.foreign, 0.0);
}

// Setpoints for an autopilot at 50 Hz ask for more than twice the budget.
TEST_F(AirTrafficTest, AForeignTopicTakesTurnsAndSilencesNobody)
{
    GatewayConfig config = WithBudget(AircraftConfig("uav1"));
    config.Foreign.push_back({.Way = ForeignRule::Direction::Publish,
                              .Topic = "setpoint",
                              .Type = "Uav::Pose",
                              .Local = "Setpoint",
                              .Reliability = Reliability::BestEffort});
    AddAircraft(config);
    auto setpoint = aircraft->Register<Uav::Pose>("Setpoint");
    PlainProgram autopilot(fleet.Network, "setpoint", "Uav::Pose", Reliability::BestEffort);
    SimulatedNode &ground = fleet.Add(GroundConfig());
    IdleManager &commands = ground.AddIdleManager("Commands");
    auto seen = ground.Register<Uav::Pose>("uav1/Pose");
    const auto post = [&](Duration passed)
    {
        if (passed % 20ms == 0s)
        {
            ++setpoint->number;
            setpoint->PostMessage();
        }
    };
    Fly(10s, 200ms, 1s, post);
    Spending spending;
    int poses = 0;
    std::uint32_t sent = 0;
    std::uint32_t arrived = 0;
    std::size_t before = autopilot.Samples.size();
    Fly(30s, 200ms, 1s,
        [&](Duration passed)
        {
            post(passed);
            spending.Add(Bytes("uav1"));
            sent += passed % 1s == 0s && SendReport(1) ? 1 : 0;
            poses += seen->FetchMessage() ? 1 : 0;
            std::shared_ptr<RabitMessage> message;
            arrived += commands.GetManagerMessageQueue()->GetMessage(message) ? 1 : 0;
        });
    EXPECT_LE(static_cast<double>(spending.MostInASecond()), 1.05 * Budget);
    EXPECT_EQ(ground.StateOf("uav1"), "UP");
    EXPECT_EQ(sent, 30u);
    EXPECT_GE(arrived, 29u);
    EXPECT_GE(poses, 140) << "of 150";
    EXPECT_GE(autopilot.Samples.size() - before, 200u) << "the rest of the budget";
    const Gateway::Fleet told = aircraft->Fleet();
    EXPECT_GT(told.air.foreign, 0.3 * Budget);
    EXPECT_LT(told.air.presence, 0.2 * Budget);
    EXPECT_NEAR(told.air.used,
                told.air.discovery + told.air.presence + told.air.command + told.air.state +
                    told.air.telemetry + told.air.bulk + told.air.foreign,
                1.0);
    const Gateway::ForeignTopic topic = told.foreign.at(0);
    EXPECT_GT(topic.replaced, 900u);
    EXPECT_NEAR(static_cast<double>(topic.samples + topic.replaced), 2000.0, 51.0);  // up to the last report
}

TEST_F(AirTrafficTest, AQueueForAForeignTopicWaitsForItsTurnsAndLosesNothing)
{
    GatewayConfig config = WithBudget(AircraftConfig("uav1"));
    config.Foreign.push_back({.Way = ForeignRule::Direction::Publish,
                              .Topic = "goals",
                              .Type = "Uav::Goto",
                              .Local = "Goals",
                              .Each = ForeignRule::Delivery::Queue});
    AddAircraft(config);
    PlainProgram program(fleet.Network, "goals", "Uav::Goto");
    SimulatedNode &ground = fleet.Add(GroundConfig());
    Fly(5s, 200ms, 1s);
    for (std::uint32_t number = 0; number < 200; ++number)
    {
        ASSERT_TRUE(aircraft->Workspace.AddMessageToQueue("Goals", std::make_shared<Uav::Goto>()));
    }
    Spending spending;
    Fly(60s, 200ms, 1s, [&](Duration) { spending.Add(Bytes("uav1")); });
    EXPECT_EQ(program.Samples.size(), 200u);
    EXPECT_LE(static_cast<double>(spending.MostInASecond()), 1.05 * Budget);
    EXPECT_EQ(ground.StateOf("uav1"), "UP");
}

TEST_F(AirTrafficTest, AnIdleNodeWithABudgetCostsLessThanAHundredBytesASecond)
{
    AddAircraft(WithBudget(AircraftConfig("uav1"), 1500));
    fleet.Add(WithBudget(GroundConfig(), 1500));
    fleet.RunFor(60s);
    const std::uint64_t before = Bytes("uav1");
    fleet.RunFor(60s);
    EXPECT_LE(Bytes("uav1") - before, 60u * 100u);
}

TEST_F(AirTrafficTest, AnIdleNodeAmongFiveWithABudgetCostsNoMoreThanOneOfTwo)
{
    for (const char *node : {"uav1", "uav2", "uav3", "uav4", "uav5"})
    {
        fleet.Add(WithBudget(AircraftConfig(node), 1500));
    }
    fleet.RunFor(60s);
    const std::uint64_t before = Bytes("uav1");
    fleet.RunFor(120s);
    EXPECT_LE(Bytes("uav1") - before, 120u * 92u);
}

TEST_F(AirTrafficTest, ANodeThatIsNotLimitedSendsAllThatIsPosted)
{
    AddAircraft(AircraftConfig("uav1"));
    SimulatedNode &ground = fleet.Add(GroundConfig());
    auto seen = ground.Register<Uav::Pose>("uav1/Pose");
    Fly(5s, 10ms, 1s);
    std::uint32_t heard = 0;
    Fly(10s, 10ms, 1s, [&](Duration) { heard += seen->FetchMessage() ? 1 : 0; });
    EXPECT_GE(heard, 999u);
    EXPECT_EQ(aircraft->Fleet().air.budget, 0.0);
    EXPECT_EQ(aircraft->Fleet().air.capacity, 0.0);
    EXPECT_GT(aircraft->Fleet().air.telemetry, 10000.0);
}

TEST_F(AirTrafficTest, BulkGoesInThePausesOfWhatIsMoreImportant)
{
    GatewayConfig config = WithBudget(AircraftConfig("uav1"));
    config.Send.push_back({.To = "*", .Queue = "Commands", .Class = TrafficClass::Bulk});
    AddAircraft(config);
    SimulatedNode &ground = fleet.Add(GroundConfig());
    IdleManager &commands = ground.AddIdleManager("Commands");
    auto seen = ground.Register<Uav::Pose>("uav1/Pose");
    Fly(10s, 1s, 1s);
    auto report = std::make_shared<Uav::CommandAck>();
    report->reason = std::string(128, 'x');
    for (int i = 0; i < 200; ++i)
    {
        ASSERT_TRUE(aircraft->Workspace.AddMessageToQueue("ground/Commands", report));
    }
    int poses = 0;
    std::size_t arrived = 0;
    Fly(30s, 1s, 1s,
        [&](Duration)
        {
            poses += seen->FetchMessage() ? 1 : 0;
            std::shared_ptr<RabitMessage> message;
            arrived += commands.GetManagerMessageQueue()->GetMessage(message) ? 1 : 0;
        });
    EXPECT_GE(poses, 29);
    EXPECT_EQ(arrived, 200u);
}

TEST_F(AirTrafficTest, APictureGoesThroughASmallBudgetBesidePosesWithinThreeMinutes)
{
    GatewayConfig config = WithBudget(AircraftConfig("uav1"), 1500);
    config.Send.push_back({.To = "*", .Queue = "Pictures", .Class = TrafficClass::Bulk});
    AddAircraft(config);
    GatewayConfig station = WithBudget(GroundConfig(), 1500);
    station.Accept.push_back({.Queue = "Pictures", .Types = {"GatewayTest::Contact"}});
    SimulatedNode &ground = fleet.Add(station);
    IdleManager &pictures = ground.AddIdleManager("Pictures");
    auto seen = ground.Register<Uav::Pose>("uav1/Pose");
    Fly(20s, 100ms, 1s);
    auto picture = std::make_shared<GatewayTest::Contact>();
    picture->text = std::string(60'000, 'x');
    ASSERT_TRUE(aircraft->Workspace.AddMessageToQueue("ground/Pictures", picture));
    Duration arrived = 0s;
    double oldest = 0.0;
    Spending spending;
    Fly(180s, 100ms, 1s,
        [&](Duration passed)
        {
            spending.Add(Bytes("uav1"));
            seen->FetchMessage();
            oldest = std::max(oldest, seen->GetAgeSeconds(*ground.Clock));
            std::shared_ptr<RabitMessage> message;
            if (pictures.GetManagerMessageQueue()->GetMessage(message))
            {
                arrived = passed;
            }
        });
    EXPECT_GT(arrived, 0s);
    EXPECT_LE(oldest, 3.0);
    EXPECT_LE(static_cast<double>(spending.MostInASecond()), 1.05 * 1500);
}

// A computer that stands still looks like a full radio, but the standstill passes at once.
TEST_F(AirTrafficTest, WhatAStandstillHasTaughtIsForgottenSoonAfter)
{
    AddAircraft(AircraftConfig("uav1"));
    SimulatedNode &ground = fleet.Add(GroundConfig());
    IdleManager &commands = ground.AddIdleManager("Commands");
    std::uint32_t number = 0;
    const auto send = [&](Duration period)
    {
        return [&, period](Duration passed)
        {
            if (passed % period == 0s)
            {
                SendReport(++number);
            }
            std::shared_ptr<RabitMessage> message;
            while (commands.GetManagerMessageQueue()->GetMessage(message))
            {
            }
        };
    };
    Fly(10s, 1s, 1s, send(500ms));
    fleet.Network.SetFaults("*", "*", {.Delay = 400ms});
    Fly(3s, 1s, 1s, send(100ms));
    EXPECT_GT(aircraft->Fleet().air.capacity, 0.0) << "or there is nothing to forget";
    fleet.Network.SetFaults("*", "*", {});
    Fly(6s, 1s, 1s, send(500ms));
    Fly(6s, 1s, 1s, send(5ms));
    const auto status = aircraft->Fleet().links;
    ASSERT_EQ(status.size(), 1u);
    EXPECT_LE(status[0].outbox, 50u);
    EXPECT_EQ(status[0].refused_full, 0u);
}

TEST_F(AirTrafficTest, AValueThatTheChannelTakesSecondsForIsNamedWithoutABudgetToo)
{
    GatewayConfig config = AircraftConfig("uav1");
    config.Publish.push_back({.Message = "Picture", .Type = "Uav::Picture", .Qos = QosProfile::Telemetry});
    AddAircraft(config);
    GatewayConfig station = GroundConfig();
    station.Subscribe.push_back({.Message = "Picture", .Type = "Uav::Picture", .From = {"uav*"}});
    fleet.Add(station).AddIdleManager("Commands");
    const auto picture = aircraft->Register<Uav::Picture>("Picture");
    const auto postPictures = [&](Duration passed)
    {
        if (passed % 100ms == 0s)
        {
            picture->PostMessage();
        }
    };
    picture->jpeg.assign(50'000, 1);
    Fly(5s, 5ms, 1s, postPictures);
    const std::string named =
        "publish Picture: one value takes more than a second of what the channel carries";
    EXPECT_EQ(aircraft->Problems().find(named), std::string::npos) << "a wide channel";
    fleet.Network.SetMedium("*", {.BytesPerSecond = 12'500});
    Fly(30s, 5ms, 1s, postPictures);
    EXPECT_NE(aircraft->Problems().find(named), std::string::npos) << aircraft->Problems();
}

class ThinAirTest : public AirTrafficTest
{
protected:
    ThinAirTest()
    {
        AddAircraft(AircraftConfig("uav1"));
        ground = &fleet.Add(GroundConfig());
        seen = ground->Register<Uav::Pose>("uav1/Pose");
        Fly(5s, 5ms, 1s);
    }

    void SetRate(std::uint64_t bytesPerSecond)
    {
        fleet.Network.SetMedium("*", {.BytesPerSecond = bytesPerSecond});
    }

    // Flies, and returns the largest age of a pose on arrival.
    Duration OldestIn(Duration duration)
    {
        Duration oldest = 0s;
        Fly(duration, 5ms, 1s,
            [&](Duration)
            {
                if (seen->FetchMessage())
                {
                    oldest = std::max(
                        oldest,
                        Duration(static_cast<std::int64_t>(1e9 * seen->GetAgeSeconds(*ground->Clock))));
                }
            });
        return oldest;
    }

    SimulatedNode *ground = nullptr;
    std::shared_ptr<Uav::Pose> seen;
};

TEST_F(ThinAirTest, ANodeWithoutABudgetFollowsWhatTheAirCarries)
{
    SetRate(12'500);
    OldestIn(15s);
    const std::uint64_t before = Bytes("uav1");
    EXPECT_LE(OldestIn(20s), 500ms);
    EXPECT_GE(Bytes("uav1") - before, 20 * 12'500 / 2);
    EXPECT_LE(Bytes("uav1") - before, 20 * 12'500);
    EXPECT_NEAR(aircraft->Fleet().air.capacity, 12'500.0, 6'000.0);
    EXPECT_EQ(ground->StateOf("uav1"), "UP");
    EXPECT_EQ(aircraft->StateOf("ground"), "UP");
}

TEST_F(ThinAirTest, WhereTheAirCarriesLittleBeatsComeSeldomAndSayIt)
{
    ground->AddIdleManager("Commands");
    SetRate(1'800);
    fleet.Network.SetFaults("*", "*", {.Loss = 0.1});
    Fly(20s, 20ms, 1s);
    int lost = 0;
    Fly(120s, 20ms, 1s,
        [&](Duration passed)
        {
            if (passed % 500ms == 0s)
            {
                SendReport(1);
            }
            lost += ground->StateOf("uav1") == "LOST" ? 1 : 0;
        });
    EXPECT_EQ(lost, 0);
}

class PresenceInThinAir final : public ThinAirTest
{
public:
    // Returns the mean bytes a second of presence in a minute.
    double MeanAt(std::uint64_t bytesPerSecond)
    {
        SetRate(bytesPerSecond);
        Fly(30s, 20ms, 1s);
        double sum = 0.0;
        Fly(60s, 20ms, 1s,
            [&](Duration passed) { sum += passed % 1s == 0s ? aircraft->Fleet().air.presence : 0.0; });
        EXPECT_GT(aircraft->Fleet().air.capacity, 0.0);
        return sum / 60;
    }

private:
    void TestBody() override {}
};

// At one rate the order of the datagrams moves the mean by a tenth.
TEST(ThinAir, WhereTheAirCarriesLittleBeatsTakeLittleOfIt)
{
    double sum = 0.0;
    int rates = 0;
    for (std::uint64_t rate = 900; rate <= 1100; rate += 10)
    {
        sum += PresenceInThinAir().MeanAt(rate);
        ++rates;
    }
    EXPECT_LE(sum / rates, 200.0);
}

// Three aircraft join on a full channel. The order of the datagrams decides how the channel looks at one
// rate, so many rates are tried.
class NewcomersInThinAir final : public ThinAirTest
{
public:
    // Returns the largest number of seconds in a row in which the capacity estimate is next to nothing.
    int LongestIn(std::uint64_t bytesPerSecond)
    {
        SetRate(bytesPerSecond);
        Fly(10s, 100ms, 1s);
        for (const char *node : {"uav2", "uav3", "uav4"})
        {
            fleet.Add(AircraftConfig(node));
        }
        int longest = 0;
        int inARow = 0;
        for (int i = 0; i < 60; ++i)
        {
            Fly(1s, 100ms, 1s);
            const double capacity = aircraft->Fleet().air.capacity;
            inARow = capacity > 0.0 && capacity < 500.0 ? inARow + 1 : 0;
            longest = std::max(longest, inARow);
        }
        return longest;
    }

private:
    void TestBody() override {}
};

TEST(ThinAir, WhatItSeemedToCarryWhileDdsHadItIsForgotten)
{
    int seconds = 0;
    int rates = 0;
    for (std::uint64_t rate = 5000; rate <= 9000; rate += 100)
    {
        seconds += NewcomersInThinAir().LongestIn(rate);
        ++rates;
    }
    EXPECT_GT(seconds, 0) << "or there is nothing to forget";
    EXPECT_LE(seconds, 10 * rates);
}

TEST_F(ThinAirTest, BeatsAreSaidAsPromisedHoweverMuchOfDdsGoesBeside)
{
    SetRate(12'500);
    OldestIn(15s);
    double longest = 0.0;
    for (int newcomer = 0; newcomer < 20; ++newcomer)
    {
        const std::string name = "uav" + std::to_string(10 + newcomer);
        fleet.Add(AircraftConfig(name));
        Fly(4s, 5ms, 1s,
            [&](Duration)
            {
                for (const auto &node : ground->Fleet().nodes)
                {
                    longest = node.node == "uav1" ? std::max(longest, node.last_heard_s) : longest;
                }
            });
        fleet.Kill(name);
    }
    // 3.5 s is three and a half times as long as the beats promise.
    EXPECT_LE(longest, 3.5);
}

TEST_F(ThinAirTest, WhatTheAirCarriesAgainIsUsedAgain)
{
    SetRate(12'500);
    OldestIn(30s);
    SetRate(125'000);
    OldestIn(15s);
    const std::uint64_t before = Bytes("uav1");
    OldestIn(5s);
    EXPECT_GE(Bytes("uav1") - before, 5 * 200 * 148 * 8 / 10);
}

TEST_F(AirTrafficTest, WhoWasNearlySilentLearnsFromABurstWhatTheAirCarriesAndNotThatItWasSilent)
{
    AddAircraft(AircraftConfig("uav1"));
    GatewayConfig station = GroundConfig();
    station.Accept.push_back({.Queue = "Pictures", .Types = {"GatewayTest::Contact"}});
    fleet.Add(station).AddIdleManager("Pictures");
    Fly(5s, 400ms, 20s);
    fleet.Network.SetMedium("*", {.BytesPerSecond = 6'250});
    Fly(20s, 400ms, 20s);
    auto picture = std::make_shared<GatewayTest::Contact>();
    picture->text = std::string(12'000, 'x');
    ASSERT_TRUE(aircraft->Workspace.AddMessageToQueue("ground/Pictures", picture));
    Fly(3s, 400ms, 20s);  // the burst takes two seconds, and Gateway/Fleet is a second old at most
    double least = 1e9;
    Fly(4s, 400ms, 20s,
        [&](Duration)
        {
            const double capacity = aircraft->Fleet().air.capacity;
            least = capacity > 0.0 ? std::min(least, capacity) : least;
        });
    EXPECT_GE(least, 6'250.0 / 2);
    EXPECT_LT(least, 1e9);
}

TEST_F(ThinAirTest, AWideWireIsNotLimited)
{
    EXPECT_LE(OldestIn(30s), 10ms);
    EXPECT_EQ(aircraft->Fleet().air.capacity, 0.0);
    EXPECT_EQ(ground->Fleet().air.capacity, 0.0);
}

TEST_F(ThinAirTest, AStepOfAWallClockIsNotTakenForThinAir)
{
    ground->AddIdleManager("Commands");
    for (const double step : {-5.0, 5.0, -0.2, 0.2})
    {
        aircraft->Clock->SetGpsTimeSeconds(aircraft->Clock->GpsTimeSeconds() + step);
        Fly(10s, 5ms, 1s,
            [&](Duration passed)
            {
                if (passed % 100ms == 0s)
                {
                    SendReport(1);
                }
            });
        EXPECT_EQ(aircraft->Fleet().air.capacity, 0.0) << step;
        EXPECT_EQ(ground->Fleet().air.capacity, 0.0) << step;
    }
}

}  // namespace
}  // namespace Rabit
