// The deciding managers of an aircraft, recorded while two aircraft find, validate and follow a target, and
// run again.
#include "Swarm.h"

#include <rabit/ManualClock.h>
#include <rabit/recording/ManagerRerun.h>
#include <rabit/recording/RecorderManager.h>

#include <gtest/gtest.h>

#include <unistd.h>

#include <chrono>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

namespace
{
using namespace std::chrono_literals;

class Rerun : public testing::Test
{
protected:
    // The flight is the same for all tests.
    static void SetUpTestSuite()
    {
        Folder = std::filesystem::temp_directory_path() / ("rabit_swarm_rerun_" + std::to_string(::getpid()));
        std::filesystem::remove_all(Folder);
        const auto clock = std::make_shared<Rabit::ManualClock>(1.4e9);
        Rabit::RabitWorkspace workspace(clock);
        Rabit::RabitSteppedReactor reactor(workspace);
        Rabit::GatewayConfig config;
        config.Node = "fleet";
        config.Record.emplace();
        config.Record->Folder = Folder.string();
        config.Record->Free = 0;
        config.Record->Except = {"*"};
        config.Record->Steps = {"*/MissionControl", "*/HealthMonitor"};
        reactor.AddManager(std::make_unique<Rabit::RecorderManager>(config, workspace));
        int number = 1;
        for (const char *aircraft : {"uav1", "uav2"})
        {
            const Swarm::Names names(aircraft, "");
            SwarmTest::AddFlyingManagers(reactor, workspace, names, number * 130.0 - 200);
            SwarmTest::AddSeeingManagers(reactor, workspace, names, static_cast<std::uint64_t>(number));
            ++number;
        }
        workspace.AddManagerMessageQueue("ground/Commands",
                                         std::make_shared<Rabit::RabitManager::RabitQueue>(100, "Commands"));
        const auto area = std::make_shared<Uav::SearchArea>(SwarmTest::Area());
        workspace.AddPublishSubscribeMessage("ground/SearchArea", area);
        reactor.Start();
        reactor.RunFor(*clock, 2s);
        area->PostMessage();
        std::uint32_t id = 0;
        for (const char *aircraft : {"uav1", "uav2"})
        {
            auto search = std::make_shared<Uav::Search>();
            search->id = ++id;
            search->reply_to = "ground/Commands";
            workspace.AddMessageToQueue(std::string(aircraft) + "/MissionControl", search);
        }
        reactor.RunFor(*clock, 110s);
        Found = SwarmTest::Latest<Uav::Findings>(workspace, "uav1/Findings").items;
        reactor.Stop();
    }
    static void TearDownTestSuite() { std::filesystem::remove_all(Folder); }

    static Rabit::ManagerRecording Recording(const std::string &manager)
    {
        std::vector<std::string> files;
        for (const auto &entry : std::filesystem::directory_iterator(Folder))
            files.push_back(entry.path());
        std::vector<std::string> problems;
        const auto all = Rabit::ManagerRecording::Read(files, manager, "", problems);
        EXPECT_TRUE(problems.empty()) << problems.front();
        EXPECT_EQ(all.size(), 1u);
        EXPECT_EQ(all.at(0).Problem(), "");
        return all.at(0);
    }
    static Rabit::RerunResult RunMission(const Rabit::ManagerRecording &recording,
                                         const std::string &aircraft,
                                         const Swarm::Floor &floor = Swarm::Floor())
    {
        return Rabit::ManagerRerun::Run(recording,
                                        [&](Rabit::RabitWorkspace &workspace) {
                                            return std::make_unique<Swarm::MissionControl>(
                                                Swarm::Names(aircraft, ""), "ground", floor, workspace);
                                        });
    }
    static Rabit::RerunResult RunHealth(const Rabit::ManagerRecording &recording, const std::string &aircraft,
                                        double enduranceS)
    {
        return Rabit::ManagerRerun::Run(recording,
                                        [&](Rabit::RabitWorkspace &workspace)
                                        {
                                            return std::make_unique<Swarm::HealthMonitor>(
                                                Swarm::Names(aircraft, ""),
                                                Swarm::HealthMonitor::Options{.EnduranceS = enduranceS},
                                                workspace);
                                        });
    }
    static std::string WhatIsWrong(const Rabit::RerunResult &result)
    {
        return result.Problem + (result.Difference ? result.Difference->ToString() : "");
    }

    static inline std::filesystem::path Folder;
    static inline std::vector<Uav::Finding> Found;
};

TEST_F(Rerun, OfMissionsIsAlikeAHundredTimes)
{
    ASSERT_EQ(Found.size(), 1u) << "the book of targets has something in it";
    EXPECT_EQ(Found[0].stage, Uav::TargetStage::TARGET_TRACKED);
    for (const std::string aircraft : {"uav1", "uav2"})
    {
        const Rabit::ManagerRecording recording = Recording(aircraft + "/MissionControl");
        EXPECT_GT(recording.NumberOfSteps(), 500u);
        const Rabit::RerunResult first = RunMission(recording, aircraft);
        EXPECT_TRUE(first.IsAlike()) << WhatIsWrong(first);
        EXPECT_EQ(first.Steps, recording.NumberOfSteps());
        EXPECT_GT(first.Outputs, 220u);
        for (int i = 1; i < 100; ++i)
        {
            const Rabit::RerunResult again = RunMission(recording, aircraft);
            ASSERT_TRUE(again.IsAlike()) << i << WhatIsWrong(again);
            ASSERT_EQ(again.Digest, first.Digest) << i;
        }
    }
}

TEST_F(Rerun, OfHealthIsAlikeAHundredTimes)
{
    const Rabit::ManagerRecording recording = Recording("uav2/HealthMonitor");
    const Rabit::RerunResult first = RunHealth(recording, "uav2", 2400);
    EXPECT_TRUE(first.IsAlike()) << WhatIsWrong(first);
    EXPECT_GT(first.Outputs, 110u);
    for (int i = 1; i < 100; ++i)
    {
        const Rabit::RerunResult again = RunHealth(recording, "uav2", 2400);
        ASSERT_TRUE(again.IsAlike()) << i << WhatIsWrong(again);
        ASSERT_EQ(again.Digest, first.Digest) << i;
    }
}

TEST_F(Rerun, NamesWhatAnotherBatteryWouldHaveChanged)
{
    const Rabit::RerunResult result = RunHealth(Recording("uav1/HealthMonitor"), "uav1", 1200);
    ASSERT_TRUE(result.Difference) << result.Problem;
    EXPECT_EQ(result.Difference->What, "message uav1/Health");
    EXPECT_EQ(result.Difference->Field, "battery_percent");
    EXPECT_EQ(result.Difference->Step, 2u) << "at first both are full";
    EXPECT_NEAR(std::stod(result.Difference->Recorded), 100 * (1 - 1 / 2400.0), 1e-3);
    EXPECT_NEAR(std::stod(result.Difference->Computed), 100 * (1 - 1 / 1200.0), 1e-3);
}

TEST_F(Rerun, NamesWhatAnotherFloorWouldHaveChanged)
{
    const Swarm::Floor floor(Swarm::Floor::Settings{.AboveSeaM = 600});
    const Rabit::RerunResult result = RunMission(Recording("uav1/MissionControl"), "uav1", floor);
    ASSERT_TRUE(result.Difference) << result.Problem;
    EXPECT_EQ(result.Difference->What, "message uav1/MissionState");
    EXPECT_EQ(result.Difference->Step, 1u);
    EXPECT_EQ(result.Difference->Field, "has_floor");
    EXPECT_EQ(result.Difference->Recorded, "false");
    EXPECT_EQ(result.Difference->Computed, "true");
}

}  // namespace
