// Nodes with two radios: a mesh that is fast, and a modem that is slow.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <random>
#include <string>
#include <tuple>
#include <vector>

#include "SimulatedFleet.h"
#include "paths/PathChoice.h"

namespace Rabit
{
namespace
{

using namespace std::chrono_literals;
using Duration = std::chrono::nanoseconds;

constexpr Duration Start = 100s;  // of the nodes' clocks
constexpr Duration Step = 5ms;
constexpr Duration CommandPeriod = 20ms;

GatewayConfig OverBoth(GatewayConfig config, std::optional<double> modemBudget = {})
{
    config.Paths.push_back({.Name = "mesh", .Interfaces = {"wlan0"}});
    config.Paths.push_back({.Name = "modem", .Interfaces = {"ppp0"}, .Radio = {.Budget = modemBudget}});
    return config;
}

class PathsTest : public ::testing::Test
{
protected:
    struct Process
    {
        Process(const std::shared_ptr<ManualClock> &clock) : Workspace(clock), Reactor(Workspace) {}
        RabitWorkspace Workspace;
        RabitSteppedReactor Reactor;
    };

    PathsTest() { modem.SetFaults("*", "*", {.Delay = 40ms}); }

    void Add(const std::string &name, const GatewayConfig &config, const std::string &queue)
    {
        auto process = std::make_unique<Process>(clock);
        auto manager = std::make_unique<IdleManager>(queue, process->Workspace);
        managers[name] = manager.get();
        process->Reactor.AddManager(std::move(manager));
        std::vector<std::shared_ptr<Transport>> transports;
        for (const PathRule &path : config.Paths)
        {
            transports.push_back(std::make_shared<SimulatedTransport>(path.Name == "mesh" ? mesh : modem));
        }
        process->Reactor.AddManager(std::make_unique<GatewayManager>(
            config, transports, process->Workspace,
            [engine = std::mt19937_64(processes.size() + 1)]() mutable { return engine(); }));
        if (!config.Publish.empty())
        {
            auto &message = poses[name];
            message = std::make_shared<Uav::Pose>();
            process->Workspace.AddPublishSubscribeMessage("Pose", message);
            auto &mission = missions[name];
            mission = std::make_shared<Uav::MissionState>();
            process->Workspace.AddPublishSubscribeMessage("MissionState", mission);
        }
        process->Reactor.Start();
        if (missions.count(name) > 0)
        {
            missions[name]->PostMessage();
        }
        processes[name] = std::move(process);
    }

    // A ground station, and an aircraft that posts its pose ten times a second.
    void AddBoth(std::optional<double> modemBudget = {})
    {
        Add("ground", OverBoth(GroundConfig(), modemBudget), "Commands");
        Add("uav1", OverBoth(AircraftConfig("uav1"), modemBudget), "MissionControl");
    }

    void RunFor(Duration duration)
    {
        for (Duration run = 0s; run < duration; run += Step)
        {
            clock->AdvanceTo(clock->Monotonic() + Step);
            for (SimulatedNetwork *network : {&mesh, &modem})
            {
                network->AdvanceTo(clock->Monotonic() - Start);
            }
            passed += Step;
            if (picturesEach != 0s && passed % picturesEach == 0s)
            {
                // The queue to the ground station may be full.
                static_cast<void>(processes["uav1"]->Workspace.AddMessageToQueue(
                    "ground/Commands", std::make_shared<Uav::CommandAck>()));
            }
            if (passed % 100ms == 0s)
            {
                for (auto &[name, pose] : poses)
                {
                    ++pose->number;
                    pose->PostMessage();
                    posedAt[pose->number] = passed;
                }
            }
            for (auto &[name, process] : processes)
            {
                process->Reactor.RunDue();
            }
            TakeCommands();
            if (watchesPose)
            {
                WatchPose();
            }
        }
    }

    // No pose comes after a later one.
    void WatchPose()
    {
        Uav::Pose pose;
        processes["ground"]->Workspace.ForceFetchMessage("uav1/Pose", &pose);
        if (posedAt.count(pose.number) == 0)
        {
            return;
        }
        const double age = std::chrono::duration<double>(passed - posedAt[pose.number]).count();
        ages.push_back(age);
        EXPECT_GE(pose.number, lastPose);
        worstAge = std::max(worstAge, std::abs(pose.GetAgeSeconds(*clock) - age));
        lastPose = pose.number;
    }

    // Share of the moments at which the newest pose at the ground station was older than that.
    double ShareOlderThan(Duration limit) const
    {
        const auto old =
            std::count_if(ages.begin(), ages.end(),
                          [limit](double age) { return age > std::chrono::duration<double>(limit).count(); });
        return static_cast<double>(old) / static_cast<double>(ages.size());
    }

    // The ground station sends a command each 20 ms.
    void Command(Duration duration)
    {
        for (Duration run = 0s; run < duration; run += CommandPeriod)
        {
            auto command = std::make_shared<Uav::Goto>();
            command->id = static_cast<std::uint32_t>(++sent);
            EXPECT_TRUE(processes["ground"]->Workspace.AddMessageToQueue("uav1/MissionControl", command));
            RunFor(CommandPeriod);
        }
    }

    // The mesh no longer carries what `from` sends to `to`. Each command comes once, in order, and none late.
    void ExpectCommandsInTimeWithout(const std::string &from, const std::string &to)
    {
        Command(1s);
        mesh.SetFaults(from, to, {.Cut = true});
        Command(5s);
        RunFor(1s);
        EXPECT_EQ(got, sent);
        EXPECT_LE(longestGap, 250ms);
    }

    void TakeCommands()
    {
        if (managers.count("uav1") == 0)
        {
            return;
        }
        std::shared_ptr<RabitMessage> message;
        while (takesPictures && managers["ground"]->GetManagerMessageQueue()->GetMessage(message))
        {
        }
        while (managers["uav1"]->GetManagerMessageQueue()->GetMessage(message))
        {
            const auto &command = dynamic_cast<const Uav::Goto &>(*message);
            ASSERT_EQ(command.id, static_cast<std::uint32_t>(got + 1)) << "lost, twice or out of order";
            ++got;
            if (lastCommandAt != 0s)
            {
                longestGap = std::max(longestGap, passed - lastCommandAt);
            }
            lastCommandAt = passed;
        }
    }

    Gateway::Fleet FleetOf(const std::string &name)
    {
        Gateway::Fleet fleet;
        processes[name]->Workspace.ForceFetchMessage("Gateway/Fleet", &fleet);
        return fleet;
    }

    std::string StateAtGround()
    {
        const Gateway::Fleet fleet = FleetOf("ground");
        const Gateway::NodeStatus *status = Gateway::FindNode(fleet, "uav1");
        return status == nullptr ? "" : ToString(status->state);
    }

    // Seconds since the post of the newest pose that the ground station has.
    double AgeAtGround()
    {
        Uav::Pose pose;
        processes["ground"]->Workspace.ForceFetchMessage("uav1/Pose", &pose);
        return pose.GetAgeSeconds(*clock);
    }

    void Cut(SimulatedNetwork &network, bool cut)
    {
        network.SetFaults("*", "*",
                          {.Delay = &network == &modem ? Duration(40ms) : Duration(1ms), .Cut = cut});
    }

    std::shared_ptr<ManualClock> clock = std::make_shared<ManualClock>(1.0e9, Start);
    SimulatedNetwork mesh{1};
    SimulatedNetwork modem{2};
    std::map<std::string, IdleManager *> managers;
    std::map<std::string, std::shared_ptr<Uav::Pose>> poses;
    std::map<std::string, std::shared_ptr<Uav::MissionState>> missions;
    std::map<std::string, std::unique_ptr<Process>> processes;
    Duration passed{0};
    bool watchesPose = false;
    std::map<std::uint64_t, Duration> posedAt;
    std::uint64_t lastPose = 0;
    std::vector<double> ages;
    double worstAge = 0;       // largest error of a pose's age
    Duration picturesEach{0};  // messages from the aircraft to the queue of the ground station; 0: none
    bool takesPictures = false;
    int sent = 0;
    int got = 0;
    Duration lastCommandAt{0};
    Duration longestGap{0};
};

TEST_F(PathsTest, ANodeOverTwoPathsIsOneNode)
{
    AddBoth();
    RunFor(3s);
    const Gateway::Fleet fleet = FleetOf("ground");
    EXPECT_EQ(fleet.nodes.size(), 1U);
    EXPECT_EQ(StateAtGround(), "UP");
    EXPECT_TRUE(fleet.problems.empty()) << fleet.problems.front().reason;
}

TEST_F(PathsTest, AnAnnouncementThatCameByTheSecondPathCountsForBoth)
{
    mesh.SetFaults("*", "*", {.Delay = 40ms});
    modem.SetFaults("*", "*", {.Delay = 1ms});
    AddBoth();
    RunFor(1s);
    Command(1s);
    RunFor(1s);
    EXPECT_EQ(got, sent);
    EXPECT_GT(got, 0);
}

TEST_F(PathsTest, WhileTheFirstPathIsSoundEachCommandComesOnceAndTheSecondCarriesLittle)
{
    AddBoth();
    RunFor(3s);
    const std::uint64_t meshBefore = mesh.Sent("ground").Bytes;
    const std::uint64_t modemBefore = modem.Sent("ground").Bytes;
    Command(10s);
    RunFor(500ms);
    EXPECT_EQ(got, sent);
    EXPECT_LE(modem.Sent("ground").Bytes - modemBefore, (mesh.Sent("ground").Bytes - meshBefore) / 10);
}

TEST_F(PathsTest, IfThePathInUseDiesCommandsComeByTheOtherWithinAQuarterOfASecond)
{
    AddBoth();
    RunFor(3s);
    Command(2s);
    Cut(mesh, true);
    Command(5s);
    RunFor(1s);
    EXPECT_EQ(got, sent);
    EXPECT_LE(longestGap, 250ms);
}

TEST_F(PathsTest, IfThePathInUseDiesTheNodeStaysUpAndItsPoseStaysFresh)
{
    AddBoth();
    RunFor(3s);
    Cut(mesh, true);
    double oldest = 0;
    for (int i = 0; i < 100; ++i)
    {
        RunFor(50ms);
        EXPECT_EQ(StateAtGround(), "UP");
        oldest = std::max(oldest, AgeAtGround());
    }
    EXPECT_LT(AgeAtGround(), 0.2);
    EXPECT_LT(oldest, 2.0);
}

TEST_F(PathsTest, AStateThatIsPostedWhileTheFirstPathIsDeadComes)
{
    AddBoth();
    RunFor(3s);
    Cut(mesh, true);
    RunFor(500ms);
    missions["uav1"]->commands = 7;
    missions["uav1"]->PostMessage();
    RunFor(2s);
    Uav::MissionState state;
    processes["ground"]->Workspace.ForceFetchMessage("uav1/MissionState", &state);
    EXPECT_EQ(state.commands, 7U);
}

TEST_F(PathsTest, ThePathThatReturnsIsTakenAgain)
{
    AddBoth();
    RunFor(3s);
    Cut(mesh, true);
    Command(3s);
    Cut(mesh, false);
    RunFor(12s);
    const std::uint64_t before = modem.Sent("ground").Bytes;
    Command(5s);
    RunFor(500ms);
    EXPECT_EQ(got, sent);
    EXPECT_LE(modem.Sent("ground").Bytes - before, 5000U);
}

TEST_F(PathsTest, IfOnlyTheWayOutIsDeadCommandsComeByTheOtherPath)
{
    AddBoth();
    RunFor(3s);
    ExpectCommandsInTimeWithout("ground", "uav1");
}

// The commands come, and their acknowledgements are lost.
TEST_F(PathsTest, IfOnlyTheWayBackIsDeadCommandsGoOn)
{
    AddBoth();
    RunFor(3s);
    ExpectCommandsInTimeWithout("uav1", "ground");
}

// The acknowledgements would fit into the frames with pictures, which never go by the modem.
TEST_F(PathsTest, IfOnlyTheWayBackIsDeadAndFullOfPicturesCommandsGoOn)
{
    GatewayConfig aircraft = OverBoth(AircraftConfig("uav1"));
    aircraft.Send.push_back({.To = "ground", .Class = TrafficClass::Bulk});
    Add("ground", OverBoth(GroundConfig()), "Commands");
    Add("uav1", aircraft, "MissionControl");
    RunFor(3s);
    picturesEach = Step;
    ExpectCommandsInTimeWithout("uav1", "ground");
}

TEST_F(PathsTest, AnswersByASecondPathEndSoonAfterTheDoubt)
{
    AddBoth();
    RunFor(3s);
    Command(1s);
    mesh.SetFaults("uav1", "ground", {.Cut = true});
    Command(500ms);
    mesh.SetFaults("uav1", "ground", {.Delay = 1ms});
    Command(5s);
    const std::uint64_t before = modem.Sent("uav1").Bytes + modem.Sent("ground").Bytes;
    Command(5s);
    RunFor(500ms);
    EXPECT_EQ(got, sent);
    EXPECT_LE(modem.Sent("uav1").Bytes + modem.Sent("ground").Bytes - before, 6000U);  // beats
}

// Once the other end knows a link, its frames do not name the queue any more. They are messages nevertheless,
// and no answers, which would keep the doubt of the other end alive for ever.
TEST_F(PathsTest, ADoubtEndsAlsoIfBothEndsSendMessages)
{
    AddBoth();
    RunFor(3s);
    picturesEach = CommandPeriod;
    takesPictures = true;
    Command(2s);
    mesh.SetFaults("uav1", "ground", {.Cut = true});
    Command(500ms);
    mesh.SetFaults("uav1", "ground", {.Delay = 1ms});
    Command(15s);
    const std::uint64_t before = modem.Sent("uav1").Bytes + modem.Sent("ground").Bytes;
    Command(10s);
    RunFor(500ms);
    EXPECT_EQ(got, sent);
    EXPECT_LE(modem.Sent("uav1").Bytes + modem.Sent("ground").Bytes - before, 12000U);  // beats
}

TEST_F(PathsTest, BulkIsNotCopiedToTheModemInADoubt)
{
    GatewayConfig aircraft = OverBoth(AircraftConfig("uav1"));
    aircraft.Send.push_back({.To = "ground", .Class = TrafficClass::Bulk});
    Add("ground", OverBoth(GroundConfig()), "Commands");
    Add("uav1", aircraft, "MissionControl");
    RunFor(3s);
    takesPictures = true;
    picturesEach = CommandPeriod;
    RunFor(2s);
    picturesEach = 0s;
    RunFor(3s);
    // The way to the aircraft is dead: nothing is acknowledged, and the beats tell it late.
    mesh.SetFaults("ground", "uav1", {.Cut = true});
    std::uint64_t before = modem.Sent("uav1").Bytes;
    RunFor(1500ms);
    const std::uint64_t without = modem.Sent("uav1").Bytes - before;
    mesh.SetFaults("ground", "uav1", {.Delay = 1ms});
    RunFor(15s);
    mesh.SetFaults("ground", "uav1", {.Cut = true});
    before = modem.Sent("uav1").Bytes;
    picturesEach = CommandPeriod;
    RunFor(1500ms);
    EXPECT_LE(modem.Sent("uav1").Bytes - before, without + 6000U) << "the pose may be copied sooner";
}

TEST_F(PathsTest, IfOnlyTheWayToTheGroundIsDeadThePoseComesByTheOtherPath)
{
    AddBoth();
    RunFor(3s);
    mesh.SetFaults("uav1", "ground", {.Cut = true});
    RunFor(5s);
    EXPECT_EQ(StateAtGround(), "UP");
    EXPECT_LT(AgeAtGround(), 0.3);
}

TEST_F(PathsTest, IfOnlyOneWayIsDeadThePoseGoesOnWithoutCommands)
{
    AddBoth();
    RunFor(5s);
    watchesPose = true;
    mesh.SetFaults("ground", "uav1", {.Cut = true});
    RunFor(5s);
    EXPECT_LE(*std::max_element(ages.begin(), ages.end()), 0.2);
    Cut(mesh, false);
    RunFor(12s);
    ages.clear();
    mesh.SetFaults("uav1", "ground", {.Cut = true});
    RunFor(5s);
    // The aircraft hears the ground station in time. It learns of the cut when the ground station holds it
    // STALE there, by the next beat over the modem.
    EXPECT_LE(*std::max_element(ages.begin(), ages.end()), 2.2);
}

TEST_F(PathsTest, APathThatComesAndGoesLosesNothing)
{
    AddBoth();
    RunFor(3s);
    for (int i = 0; i < 10; ++i)
    {
        Cut(mesh, i % 2 == 0);
        Command(2s);
    }
    RunFor(2s);
    EXPECT_EQ(got, sent);
    EXPECT_LE(longestGap, 250ms);
}

TEST_F(PathsTest, TheBudgetOfTheModemHoldsWhileItCarriesEverything)
{
    constexpr double budget = 3000;
    AddBoth(budget);
    RunFor(10s);
    Cut(mesh, true);
    RunFor(3s);
    std::uint64_t before = modem.Sent("uav1").Bytes;
    std::uint64_t worst = 0;
    for (int i = 0; i < 20; ++i)
    {
        RunFor(1s);
        worst = std::max(worst, modem.Sent("uav1").Bytes - before);
        before = modem.Sent("uav1").Bytes;
    }
    EXPECT_LE(worst, static_cast<std::uint64_t>(budget * 1.05));
    EXPECT_EQ(StateAtGround(), "UP");
}

// The aircraft's poses alone could fill the budget.
TEST_F(PathsTest, CopiesOfTelemetryLeaveRoomOnASmallModemForCopiesOfQueueMessages)
{
    picturesEach = 500ms;
    AddBoth(1500);
    RunFor(10s);
    std::shared_ptr<RabitMessage> message;
    while (managers["ground"]->GetManagerMessageQueue()->GetMessage(message))
    {
    }
    Duration last = passed;
    Duration longest = 0s;
    int came = 0;
    for (int i = 0; i < 60 * 200; ++i)
    {
        if (i % 200 == 0)
        {
            Cut(mesh, i % 1000 == 0);  // a second in five
        }
        RunFor(Step);
        while (managers["ground"]->GetManagerMessageQueue()->GetMessage(message))
        {
            longest = std::max(longest, passed - last);
            last = passed;
            ++came;
        }
    }
    longest = std::max(longest, passed - last);
    EXPECT_LE(longest, picturesEach + 300ms);
    EXPECT_GE(came, 60s / picturesEach - 1);
}

// The mesh brings it after 1.3 s, the modem earlier. A copy of a pose always finds room before one of the
// State does.
TEST_F(PathsTest, AStateHasItsTurnBeforeTelemetryByASmallModemToo)
{
    AddBoth(1000);
    RunFor(10s);
    mesh.SetFaults("*", "*", {.Delay = 1300ms});
    RunFor(2s);
    for (std::uint32_t i = 1; i <= 5; ++i)
    {
        // More than half of the budget.
        missions["uav1"]->target = std::string(64, 't');
        missions["uav1"]->partner = std::string(64, 'p');
        missions["uav1"]->text = std::string(128, 'x');
        missions["uav1"]->area_declined = std::string(128, 'a');
        missions["uav1"]->commands = i;
        missions["uav1"]->PostMessage();
        RunFor(1250ms);
        Uav::MissionState state;
        processes["ground"]->Workspace.ForceFetchMessage("uav1/MissionState", &state);
        EXPECT_EQ(state.commands, i);
    }
}

TEST_F(PathsTest, AMomentOfTheMeshCostsTheModemNothingAfterwards)
{
    AddBoth();
    RunFor(5s);
    Command(1s);  // until the links know how long answers take
    RunFor(1s);
    std::uint64_t before = modem.Sent("uav1").Bytes;
    RunFor(10s);
    const std::uint64_t beats = modem.Sent("uav1").Bytes - before;
    Cut(mesh, true);
    Command(CommandPeriod);
    RunFor(300ms);
    Cut(mesh, false);
    EXPECT_EQ(got, sent);
    RunFor(5s);
    before = modem.Sent("uav1").Bytes;
    RunFor(10s);
    EXPECT_LE(modem.Sent("uav1").Bytes - before, beats * 5 / 4);
}

TEST_F(PathsTest, AStateThatIsLostWhileTheEndsChoseDifferentPathsComes)
{
    AddBoth();
    RunFor(3s);
    Cut(mesh, true);
    RunFor(3s);
    Cut(mesh, false);
    RunFor(700ms);  // the aircraft is back on the mesh or about to be, the ground station rests it
    mesh.SetFaults("uav1", "ground", {.Loss = 0.9, .Delay = 1ms});
    missions["uav1"]->commands = 7;
    missions["uav1"]->PostMessage();
    RunFor(100ms);
    mesh.SetFaults("uav1", "ground", {.Delay = 1ms});
    RunFor(700ms);
    Uav::MissionState state;
    processes["ground"]->Workspace.ForceFetchMessage("uav1/MissionState", &state);
    EXPECT_EQ(state.commands, 7U);
}

TEST_F(PathsTest, AnAircraftThatStartsAgainWhileItIsHeardByTheModemAloneIsHeardAgain)
{
    AddBoth();
    RunFor(3s);
    mesh.SetFaults("uav1", "ground", {.Cut = true});
    RunFor(4s);
    processes["uav1"]->Reactor.Stop();
    processes.erase("uav1");
    Add("uav1", OverBoth(AircraftConfig("uav1")), "MissionControl");
    RunFor(5s);
    EXPECT_EQ(StateAtGround(), "UP");
    EXPECT_LT(AgeAtGround(), 0.3);
}

// A node that ends is silent on all paths. That is no fault of the mesh.
TEST_F(PathsTest, AnAircraftThatStartsAgainTenTimesIsReachedByTheMesh)
{
    AddBoth();
    RunFor(3s);
    for (int i = 0; i < 10; ++i)
    {
        if (i % 2 == 0)
        {
            processes["uav1"]->Reactor.Stop();  // with goodbyes
        }
        managers.erase("uav1");
        processes.erase("uav1");
        RunFor(i % 3 * 1s);
        Add("uav1", OverBoth(AircraftConfig("uav1")), "MissionControl");
        RunFor(3s);
        EXPECT_EQ(Gateway::FindNode(FleetOf("ground"), "uav1")->path, "mesh") << i;
    }
    int onMesh = 0;
    for (int i = 0; i < 60; ++i)
    {
        RunFor(1s);
        onMesh += Gateway::FindNode(FleetOf("ground"), "uav1")->path == "mesh" ? 1 : 0;
    }
    EXPECT_EQ(onMesh, 60);
}

TEST_F(PathsTest, AToolThatHearsOnlyTheModemIsServedThere)
{
    GatewayConfig tool = GroundConfig();
    tool.Node = "rabit.laptop";
    tool.Accept.clear();
    tool.Tool.emplace();
    tool.Paths.push_back({.Name = "modem"});
    Add("uav1", OverBoth(AircraftConfig("uav1")), "MissionControl");
    Add("rabit.laptop", tool, "Commands");
    RunFor(3s);
    Uav::Pose pose;
    processes["rabit.laptop"]->Workspace.ForceFetchMessage("uav1/Pose", &pose);
    EXPECT_LT(pose.GetAgeSeconds(*clock), 0.3);
    auto command = std::make_shared<Uav::Goto>();
    command->id = 1;
    EXPECT_TRUE(processes["rabit.laptop"]->Workspace.AddMessageToQueue("uav1/MissionControl", command));
    RunFor(1s);
    EXPECT_EQ(got, 1);
}

TEST_F(PathsTest, ForeignTopicsTellWhichPathTheyUse)
{
    GatewayConfig config = OverBoth(GroundConfig());
    config.Foreign.push_back({.Topic = "rt/chatter", .Type = "Uav::Pose", .Local = "Chatter"});
    Add("ground", config, "Commands");
    RunFor(3s);
    const Gateway::Fleet fleet = FleetOf("ground");
    ASSERT_EQ(fleet.foreign.size(), 1U);
    EXPECT_EQ(fleet.foreign.front().reason,
              "no program writes `rt/chatter` in domain 0; a program that listens on other interfaces than "
              "`wlan0`, those of path `mesh`, cannot be reached");
}

// The mesh is gone for that time and there for that time, for two minutes, with or without commands. The
// modem alone brings poses that are 140 ms old at most.
class PathsTestOfFlaps : public PathsTest, public ::testing::WithParamInterface<std::tuple<int, bool>>
{
};

TEST_P(PathsTestOfFlaps, ThePoseIsHardlyEverOld)
{
    const Duration phase = std::chrono::seconds(std::get<0>(GetParam()));
    AddBoth();
    RunFor(5s);
    watchesPose = true;
    bool cut = false;
    for (const Duration begin = passed; passed - begin < 120s;)
    {
        cut = !cut;
        Cut(mesh, cut);
        std::get<1>(GetParam()) ? Command(phase) : RunFor(phase);
    }
    Cut(mesh, false);
    RunFor(2s);
    EXPECT_LE(ShareOlderThan(150ms), 0.02);
    EXPECT_EQ(got, sent);
}

INSTANTIATE_TEST_SUITE_P(Phases, PathsTestOfFlaps,
                         ::testing::Combine(::testing::Values(1, 2, 3), ::testing::Bool()));

// A queue has filled up somewhere on the way.
TEST_F(PathsTest, IfTheMeshBeginsToHoldUpAllThePoseIsAsFreshAsByTheModem)
{
    AddBoth();
    RunFor(5s);
    mesh.SetFaults("*", "*", {.Delay = 900ms});
    RunFor(2s);
    watchesPose = true;
    RunFor(10s);
    EXPECT_LE(ShareOlderThan(150ms), 0.01);
}

TEST_F(PathsTest, APathThatLosesABeatInTenStaysInUse)
{
    AddBoth();
    RunFor(3s);
    mesh.SetFaults("*", "*", {.Loss = 0.1, .Delay = 1ms});
    for (int i = 0; i < 60; ++i)
    {
        RunFor(1s);
        EXPECT_EQ(Gateway::FindNode(FleetOf("ground"), "uav1")->path, "mesh") << i << " s";
    }
}

// Links repair what the mesh loses, and the modem cannot carry what the mesh does. At such a loss the
// aircraft is STALE on the mesh now and then.
TEST_F(PathsTest, AMeshThatLosesAThirdIsUsedForMostOfTheTimeBesideASmallModem)
{
    AddBoth(1500);
    RunFor(3s);
    mesh.SetFaults("*", "*", {.Loss = 0.3, .Delay = 1ms});
    constexpr int seconds = 300;
    int onMesh = 0;
    for (int i = 0; i < seconds; ++i)
    {
        RunFor(1s);
        onMesh += Gateway::FindNode(FleetOf("ground"), "uav1")->path == "mesh" ? 1 : 0;
    }
    EXPECT_GE(onMesh, seconds / 2);
}

// The night tries more of them.
int Seeds(int usual)
{
    const char *const more =
        std::getenv("RABIT_PATH_SEEDS");  // NOLINT(concurrency-mt-unsafe): no other threads
    return more == nullptr ? usual : std::atoi(more);
}

// Faults of both networks at random: cut in one direction or both, lossy, slow, reordering.
class PathsUnderFaults : public PathsTest, public ::testing::WithParamInterface<int>
{
protected:
    SimulatedFaults AnyFaults()
    {
        SimulatedFaults faults;
        const auto among = [this](int count)
        { return static_cast<int>(chance() % static_cast<unsigned>(count)); };
        faults.Cut = among(3) == 0;
        faults.Loss = among(2) == 0 ? 0.05 * among(10) : 0.0;
        faults.Duplicate = 0.02 * among(5);
        faults.Delay = std::chrono::milliseconds(1 + among(100));
        faults.Jitter = std::chrono::milliseconds(among(60));
        return faults;
    }

    std::mt19937_64 chance{static_cast<std::uint64_t>(GetParam())};
};

TEST_P(PathsUnderFaults, EachCommandComesOnceAndInOrder)
{
    AddBoth(GetParam() % 2 == 0 ? std::optional<double>() : 4000);
    RunFor(5s);  // until the delays of both networks are known
    watchesPose = true;
    for (int step = 0; step < 12; ++step)
    {
        SimulatedNetwork &network = chance() % 3 == 0 ? modem : mesh;
        const bool both = chance() % 2 == 0;
        network.SetFaults("ground", "uav1", AnyFaults());
        if (both)
        {
            network.SetFaults("uav1", "ground", AnyFaults());
        }
        Command(std::chrono::milliseconds(200 + chance() % 2000));
    }
    Cut(mesh, false);
    Cut(modem, false);
    RunFor(20s);
    EXPECT_EQ(got, sent);
    EXPECT_EQ(StateAtGround(), "UP");
    EXPECT_LT(AgeAtGround(), 1.0);
    EXPECT_LE(worstAge, 0.2) << "the delays of the two directions cannot be told apart";
}

INSTANTIATE_TEST_SUITE_P(Seeds, PathsUnderFaults, ::testing::Range(0, Seeds(200)));

// The mesh comes and goes, in both directions or in one, with times of its own for each seed.
class PathsThatFlap : public PathsUnderFaults
{
};

TEST_P(PathsThatFlap, CommandsComeOnceAndInOrderAndThePoseIsSeldomOld)
{
    AddBoth();
    RunFor(5s);
    const auto anyTime = [this] { return std::chrono::milliseconds(300 + 20 * (chance() % 110)); };
    const Duration gone = anyTime();
    const Duration there = anyTime();
    const bool bothWays = GetParam() % 2 == 0;
    watchesPose = true;
    bool cut = false;
    for (const Duration begin = passed; passed - begin < 60s;)
    {
        cut = !cut;
        const SimulatedFaults faults{.Delay = 1ms, .Cut = cut};
        mesh.SetFaults("uav1", "ground", faults);
        if (bothWays)
        {
            mesh.SetFaults("ground", "uav1", faults);
        }
        Command(cut ? gone : there);
    }
    Cut(mesh, false);
    RunFor(2s);
    EXPECT_EQ(got, sent);
    EXPECT_LE(longestGap, 250ms);
    EXPECT_LE(worstAge, 0.1) << "the true time";
    EXPECT_LE(ShareOlderThan(250ms), 0.02)
        << "gone for " << gone.count() / 1000000 << " ms, there for " << there.count() / 1000000 << " ms";
}

INSTANTIATE_TEST_SUITE_P(Seeds, PathsThatFlap, ::testing::Range(0, Seeds(100)));

TEST_F(PathsTest, AnAircraftWithTheModemAloneAndOneWithBothAreReached)
{
    GatewayConfig far = AircraftConfig("uav1");
    far.Paths.push_back({.Name = "modem"});
    Add("ground", OverBoth(GroundConfig()), "Commands");
    Add("uav1", far, "MissionControl");
    RunFor(3s);
    Command(1s);
    RunFor(500ms);
    EXPECT_EQ(got, sent);
    EXPECT_LT(AgeAtGround(), 0.3);
}

}  // namespace
}  // namespace Rabit
