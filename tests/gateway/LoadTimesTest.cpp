// Times of whole nodes whose queues, budgets or links are full, under simulated time. The same with real
// programs, judged by outcomes alone: tests/integration/scenarios.
#include <gmock/gmock.h>

#include <map>
#include <string>
#include <vector>

#include "WatchedFleet.h"
#include "keyed.idl.h"

namespace Rabit
{
namespace
{

using namespace std::chrono_literals;
using ::testing::ElementsAre;
using Duration = std::chrono::nanoseconds;

TEST(AQueueThatNobodyEmpties, RefusesWhenItAndTheOutboxAreFullAndDelaysNoOtherLink)
{
    WatchedFleet fleet({"ground", "uav1", "uav2"});
    fleet.StartAll();
    fleet.RunFor(3s);
    fleet.Close("ground");
    fleet.Send("uav1", "ground", 200);
    for (const auto &[from, to] :
         {std::pair("ground", "uav1"), std::pair("uav1", "uav2"), std::pair("uav2", "uav1")})
    {
        fleet.Send(from, to, 50);
    }
    fleet.RunFor(60s);
    // The queue of a manager has 1000 places, and so has an outbox.
    EXPECT_EQ(fleet.Of("uav1", "ground").Accepted, 2000u);
    EXPECT_EQ(fleet["uav1"].LinkTo("ground", "Notes").delivered, 1000u);
    EXPECT_GT(fleet["uav1"].LinkTo("ground", "Notes").refused_full, 0u);
    fleet.Send("uav1", "ground", 0);
    fleet.Close("ground", false);
    fleet.RunFor(5s);
    for (const auto &[from, to] :
         {std::pair("ground", "uav1"), std::pair("uav1", "uav2"), std::pair("uav2", "uav1")})
    {
        EXPECT_LE(WatchedFleet::P99(fleet.Of(from, to).Notes), 200ms) << from << " to " << to;
        fleet.Send(from, to, 0);
    }
    fleet.RunFor(1s);
    fleet.ExpectAllNotes();
    EXPECT_THAT(fleet.StatesSince("uav1", "ground"), ElementsAre("UP"));
    EXPECT_THAT(fleet.StatesSince("uav1", "uav2"), ElementsAre("UP"));
}

TEST(ASecondLiveNodeOfOneName, DelaysNoOtherLink)
{
    WatchedFleet fleet({"ground", "uav1", "uav2"});
    fleet.StartAll();
    GatewayConfig twin;
    twin.Node = "uav1";
    fleet.Send("ground", "uav2", 20);
    fleet.Send("uav2", "ground", 20);
    fleet.RunFor(3s);
    fleet.Nodes.Add(twin, 1.5e9, "twin");
    fleet.RunFor(20s);
    EXPECT_NE(fleet["ground"].Problems().find("two live nodes have this name"), std::string::npos);
    EXPECT_LE(WatchedFleet::P99(fleet.Of("ground", "uav2").Notes, 2s), 200ms);
    EXPECT_LE(WatchedFleet::P99(fleet.Of("uav2", "ground").Notes, 2s), 200ms);
    EXPECT_THAT(fleet.StatesSince("ground", "uav2"), ElementsAre("UP"));
    EXPECT_THAT(fleet.StatesSince("uav2", "ground"), ElementsAre("UP"));
}

// Three nodes send to one queue of 20 places, which is emptied five times a second. Their messages have 8 kB,
// 200 kB and 2 MB. The medium of 200 Mbit/s loses and doubles 5 %.
TEST(MessagesOfAllSizesForOneQueue, HaveTheirTurnsWithinFiveSeconds)
{
    struct Sender
    {
        std::size_t Size;
        Duration Period;
        std::uint32_t Left;
        Duration Next{0};
        std::vector<Duration> AcceptedAt;
        Duration LastTaken{0};
        std::size_t Taken = 0;
        SimulatedNode *Node = nullptr;
    };
    std::map<std::string, Sender> senders;
    senders["large"] = {2'000'000, 500ms, 10, {}, {}, {}, 0, nullptr};
    senders["middle"] = {200'000, 40ms, 100, {}, {}, {}, 0, nullptr};
    senders["small"] = {8'000, 16ms, 400, {}, {}, {}, 0, nullptr};
    SimulatedFleet fleet;
    fleet.Network.SetMedium("*", {.BytesPerSecond = 25'000'000, .QueueBytes = 400'000});
    fleet.Network.SetFaults("*", "*", {.Loss = 0.05, .Duplicate = 0.05});
    for (auto &[name, sender] : senders)
    {
        GatewayConfig config;
        config.Node = name;
        sender.Node = &fleet.Add(config);
    }
    GatewayConfig config;
    config.Node = "ground";
    config.Accept.push_back({.Queue = "Notes", .Types = {"GatewayTest::Contact"}});
    SimulatedNode &ground = fleet.Add(config);
    const auto queue = std::make_shared<RabitMessageQueue<std::shared_ptr<RabitMessage>>>(20, "Notes");
    ground.Workspace.AddManagerMessageQueue("Notes", queue);
    fleet.RunFor(3s);
    const Duration begin = fleet.Network.Now();
    const auto isOpen = [&senders](const auto &entry)
    { return entry.second.Left > 0 || entry.second.Taken < entry.second.AcceptedAt.size(); };
    while (std::any_of(senders.begin(), senders.end(), isOpen))
    {
        const Duration now = fleet.Network.Now();
        ASSERT_LT(now - begin, 120s);
        for (auto &[name, sender] : senders)
        {
            if (sender.Left > 0 && now >= sender.Next)
            {
                auto message = std::make_shared<GatewayTest::Contact>();
                message->number = static_cast<std::uint32_t>(sender.Size);
                message->text.assign(sender.Size, 'x');
                if (sender.Node->Workspace.AddMessageToQueue("ground/Notes", message))
                {
                    sender.AcceptedAt.push_back(now);
                    --sender.Left;
                }
                sender.Next = now + sender.Period;
            }
        }
        fleet.RunFor(4ms);
        if ((now - begin) / 200ms == (fleet.Network.Now() - begin) / 200ms)
        {
            continue;
        }
        std::shared_ptr<RabitMessage> message;
        while (queue->GetMessage(message))
        {
            const std::size_t size = dynamic_cast<const GatewayTest::Contact &>(*message).text.size();
            for (auto &[name, sender] : senders)
            {
                if (sender.Size == size)
                {
                    const Duration since = std::max(sender.LastTaken, sender.AcceptedAt.at(sender.Taken));
                    EXPECT_LE(fleet.Network.Now() - since, 5s) << name << ", message " << sender.Taken;
                    sender.LastTaken = fleet.Network.Now();
                    ++sender.Taken;
                }
            }
        }
    }
}

// A ground station with 5 kB/s and a State of 20 kB comes to aircraft with budgets of their own. All are on
// one radio of 250 kbit/s.
struct ThinFleet
{
    std::size_t Aircraft;
    double Budget;
    Duration ReportPeriod;
    Duration P99;
};

class TimesOfAThinFleet : public ::testing::TestWithParam<ThinFleet>
{
};

TEST_P(TimesOfAThinFleet, ReportsCommandsAndALargeStateComeInTime)
{
    const ThinFleet &thin = GetParam();
    std::vector<std::string> names = {"ground"};
    for (std::size_t i = 1; i <= thin.Aircraft; ++i)
    {
        names.push_back(std::string("uav").append(std::to_string(i)));
    }
    const auto aircraft = [&thin](GatewayConfig &config)
    {
        config.Radio.Budget = thin.Budget;
        config.Publish.clear();
        config.Subscribe = {{.Message = "Map", .Type = "Uav::Picture", .From = {"ground"}}};
    };
    WatchedFleet fleet(names);
    std::vector<std::shared_ptr<Uav::Picture>> shown;
    for (std::size_t i = 1; i <= thin.Aircraft; ++i)
    {
        shown.push_back(fleet.Start(names[i], aircraft).Register<Uav::Picture>("ground/Map"));
    }
    fleet.RunFor(3s);
    fleet.Nodes.Network.SetMedium("*", {.BytesPerSecond = 31'250});
    SimulatedNode &ground = fleet.Start("ground",
                                        [](GatewayConfig &config)
                                        {
                                            config.Radio.Budget = 5000;
                                            config.Publish = {{.Message = "Map", .Type = "Uav::Picture"}};
                                            config.Subscribe.clear();
                                        });
    const auto map = ground.Register<Uav::Picture>("Map");
    map->jpeg.resize(20'000);
    const Duration begin = fleet.Now();
    fleet.RunFor(1s);
    for (std::size_t i = 1; i <= thin.Aircraft; ++i)
    {
        fleet.SendEach(names[i], "ground", thin.ReportPeriod);
        fleet.SendEach("ground", names[i], 2 * thin.ReportPeriod + 1s);
    }
    for (std::uint32_t post = 1; post <= 2; ++post)
    {
        map->number = post;
        map->PostMessage();
        fleet.RunFor(15s);
        for (std::size_t i = 0; i < thin.Aircraft; ++i)
        {
            shown[i]->FetchMessage();
            EXPECT_EQ(shown[i]->number, post) << names[i + 1];
        }
    }
    for (std::size_t i = 1; i <= thin.Aircraft; ++i)
    {
        fleet.Send(names[i], "ground", 0);
        fleet.Send("ground", names[i], 0);
    }
    fleet.RunFor(15s);
    fleet.ExpectAllNotes();
    for (std::size_t i = 1; i <= thin.Aircraft; ++i)
    {
        EXPECT_LE(WatchedFleet::P99(fleet.Of(names[i], "ground").Notes, begin + 3s), thin.P99) << names[i];
        EXPECT_LE(WatchedFleet::P99(fleet.Of("ground", names[i]).Notes, begin + 3s), thin.P99) << names[i];
        EXPECT_THAT(fleet.StatesSince("ground", names[i]), ElementsAre("UP"));
        EXPECT_THAT(fleet.StatesSince(names[i], "ground"), ElementsAre("UP"));
    }
}

INSTANTIATE_TEST_SUITE_P(Sizes, TimesOfAThinFleet,
                         ::testing::Values(ThinFleet{10, 1500, 1s, 1500ms}, ThinFleet{20, 1000, 4s, 5s}),
                         [](const auto &thin)
                         { return std::to_string(thin.param.Aircraft).append("Aircraft"); });

// An aircraft sends more telemetry than its link of 500 kbit/s takes, and a picture. The queue of the link
// drops nothing.
TEST(AFullLink, MakesNoNodeStaleAndDelaysNoCommandToOthers)
{
    const std::vector<std::string> names = {"ground", "uav1", "uav2"};
    WatchedFleet fleet(names);
    const auto picture = [](GatewayConfig &config)
    {
        config.Accept.push_back({.Queue = "Pictures", .Types = {"GatewayTest::Contact"}});
        config.Send.push_back({.To = "*", .Queue = "Pictures", .Class = TrafficClass::Bulk});
        config.Publish.push_back({.Message = "View", .Type = "Uav::Picture", .Qos = QosProfile::Telemetry});
        config.Subscribe.push_back({.Message = "View", .Type = "Uav::Picture", .From = {"uav1"}});
    };
    fleet.StartAll(picture);
    IdleManager &pictures = fleet["ground"].AddIdleManager("Pictures");
    const auto view = fleet["uav1"].Register<Uav::Picture>("View");
    view->jpeg.resize(4000);
    fleet.Nodes.Network.SetMedium("uav1", {.BytesPerSecond = 62'500, .QueueBytes = 100'000'000});
    for (const char *uav : {"uav1", "uav2"})
    {
        fleet.Send("ground", uav, 4);
        fleet.Send(uav, "ground", 4);
    }
    fleet.RunFor(3s);
    auto large = std::make_shared<GatewayTest::Contact>();
    large->text.assign(200'000, 'x');
    ASSERT_TRUE(fleet["uav1"].Workspace.AddMessageToQueue("ground/Pictures", large));
    for (Duration passed = 0s; passed < 60s; passed += 50ms)
    {
        view->PostMessage();
        fleet.RunFor(50ms);
    }
    std::shared_ptr<RabitMessage> arrived;
    EXPECT_TRUE(pictures.GetManagerMessageQueue()->GetMessage(arrived));
    for (const char *uav : {"uav1", "uav2"})
    {
        fleet.Send("ground", uav, 0);
        fleet.Send(uav, "ground", 0);
    }
    fleet.RunFor(10s);
    fleet.ExpectAllNotes();
    EXPECT_LE(WatchedFleet::P99(fleet.Of("uav2", "ground").Notes), 100ms);
    EXPECT_LE(WatchedFleet::P99(fleet.Of("ground", "uav2").Notes), 100ms);
    for (const std::string &node : names)
    {
        for (const std::string &other : names)
        {
            if (node != other)
            {
                EXPECT_THAT(fleet.StatesSince(node, other), ElementsAre("UP")) << node << " of " << other;
            }
        }
    }
}

// Four nodes post four States each. One comes late, one is killed and comes back, and then a fifth is lost.
TEST(StatesOfNodesThatComeAndGo, AreShownWithinTenSecondsAndNotWrittenOftenerThanTwice)
{
    constexpr int States = 4;
    std::map<std::string, std::vector<std::shared_ptr<Uav::MissionState>>> own;
    const std::vector<std::string> names = {"ground", "late", "uav1", "uav2"};
    WatchedFleet fleet(names);
    std::uint32_t posts = 0;
    const auto nameOf = [](int state) { return std::string("State").append(std::to_string(state)); };
    const auto start = [&](const std::string &name)
    {
        SimulatedNode &node = fleet.Start(
            name,
            [&](GatewayConfig &config)
            {
                for (int i = 0; i < States; ++i)
                {
                    config.Publish.push_back({.Message = nameOf(i), .Type = "Uav::MissionState"});
                    config.Subscribe.push_back({.Message = nameOf(i), .Type = "Uav::MissionState"});
                }
            });
        own[name].clear();
        for (int i = 0; i < States; ++i)
        {
            own[name].push_back(node.Register<Uav::MissionState>(nameOf(i)));
        }
    };
    const auto post = [&](Duration duration)
    {
        for (const Duration end = fleet.Now() + duration; fleet.Now() < end; fleet.RunFor(500ms))
        {
            ++posts;
            for (const auto &[name, states] : own)
            {
                for (const auto &state : states)
                {
                    state->commands = posts;
                    state->PostMessage();
                }
            }
        }
    };
    for (const char *name : {"ground", "uav1", "uav2"})
    {
        start(name);
    }
    post(2s);
    start("late");
    post(2s);
    fleet.Kill("uav2");
    start("uav2");
    post(6s);
    fleet.Nodes.Network.SetFaults("*", "*", {.Loss = 0.2});
    post(25s);
    fleet.RunFor(10s);
    for (const std::string &node : names)
    {
        for (const std::string &origin : names)
        {
            for (int i = 0; i < States && node != origin; ++i)
            {
                EXPECT_EQ(fleet[node].Newest<Uav::MissionState>(origin + "/" + nameOf(i)).commands, posts)
                    << node << " of " << origin;
            }
        }
        for (const Gateway::PublicationStatus &publication : fleet[node].Fleet().publications)
        {
            if (publication.message.starts_with("State"))
            {
                EXPECT_LE(publication.written, 2 * posts + 10) << node << "/" << publication.message;
            }
        }
    }
}

}  // namespace
}  // namespace Rabit
