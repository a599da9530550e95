// The same two aircraft as four nodes with the real configuration files, and a ground station, on a simulated
// network: nothing that they do may depend on where their managers live.
#include <rabit/testing/SimulatedFleet.h>
#include "AircraftConfig.h"
#include "Swarm.h"
#include "mission/TargetBook.h"

#include <rabit/gateway/LoadGatewayConfig.h>

#include <gtest/gtest.h>

#include <chrono>
#include <map>
#include <memory>
#include <string>
#include <vector>

namespace Paths
{
extern const char *const SwarmFolder;
}

namespace
{
using namespace std::chrono_literals;
using SwarmTest::Latest;

class SwarmOverNetwork : public testing::Test
{
protected:
    Rabit::SimulatedFleet _fleet;
    std::map<std::string, Rabit::SimulatedNode *> _nodes;
    Rabit::SimulatedNode *_ground = nullptr;
    std::shared_ptr<Rabit::RabitManager::RabitQueue> _answers;
    std::shared_ptr<Rabit::RabitManager::RabitQueue> _pictures;
    std::shared_ptr<Uav::SearchArea> _area;

    void SetUp() override
    {
        AddGround();
        AddAircraft("uav1", -70, 1);
        AddAircraft("uav2", 60, 2);
        _fleet.RunFor(3s);  // they hear each other
    }
    void AddGround()
    {
        Rabit::GatewayConfig config;
        config.Node = "ground";
        config.Domain = 7;  // of the files
        config.Publish.push_back({.Message = "Geofence", .Type = "Uav::Geofence"});
        config.Publish.push_back({.Message = "SearchArea", .Type = "Uav::SearchArea"});
        config.Subscribe.push_back({.Message = "CameraView", .Type = "Uav::CameraView"});
        config.Accept.push_back({.Queue = "Commands", .Types = {"Uav::CommandAck"}});
        config.Accept.push_back({.Queue = "Pictures", .Types = {"Uav::Picture"}});
        _ground = &_fleet.Add(config);
        _answers = std::make_shared<Rabit::RabitManager::RabitQueue>(100, "Commands");
        _pictures = std::make_shared<Rabit::RabitManager::RabitQueue>(100, "Pictures");
        _ground->Workspace.AddManagerMessageQueue("Commands", _answers);
        _ground->Workspace.AddManagerMessageQueue("Pictures", _pictures);
        _ground->Register<Uav::Geofence>("Geofence")->PostMessage();  // none
        _area = _ground->Register<Uav::SearchArea>("SearchArea");
    }
    void AddAircraft(const std::string &aircraft, double eastM, std::uint64_t seed)
    {
        const std::string folder = Paths::SwarmFolder;
        Rabit::GatewayConfig flying = Rabit::LoadGatewayConfig(folder + "/uav.yaml", aircraft);
        Swarm::CompleteAircraftConfig(flying, "ground");
        Rabit::SimulatedNode &uav = _fleet.Add(flying);
        SwarmTest::AddFlyingManagers(uav.Reactor, uav.Workspace, {aircraft, aircraft}, eastM);
        _nodes[aircraft] = &uav;

        const std::string visionNode = Swarm::Names::VisionOf(aircraft);
        Rabit::SimulatedNode &vision =
            _fleet.Add(Rabit::LoadGatewayConfig(folder + "/vision.yaml", visionNode));
        SwarmTest::AddSeeingManagers(vision.Reactor, vision.Workspace, {aircraft, visionNode}, seed);
        _nodes[visionNode] = &vision;
    }
    template <typename Message>
    Message Of(const std::string &node, const std::string &name)
    {
        return Latest<Message>(_nodes.at(node)->Workspace, name);
    }
    Uav::MissionMode ModeOf(const std::string &aircraft)
    {
        return Of<Uav::MissionState>(aircraft, "MissionState").mode;
    }
    bool ComesTo(const std::string &aircraft, Uav::MissionMode mode, std::chrono::nanoseconds limit)
    {
        return _fleet.RunUntil([&] { return ModeOf(aircraft) == mode; }, limit);
    }
    void StartSearch()
    {
        Uav::SearchArea area = SwarmTest::Area();
        _area->CopyMessage(&area);
        _area->PostMessage();
        _fleet.RunFor(1s);
        std::uint32_t id = 0;
        for (const char *aircraft : {"uav1", "uav2"})
        {
            auto search = std::make_shared<Uav::Search>();
            search->id = ++id;
            search->reply_to = "ground/Commands";
            ASSERT_TRUE(
                _ground->Workspace.AddMessageToQueue(std::string(aircraft) + "/MissionControl", search));
        }
    }
    // Returns the stages that uav1 or uav2 reported of its command, in order.
    std::vector<Uav::CommandStage> StagesOf(std::uint32_t id, std::vector<Uav::CommandAck> &all)
    {
        std::shared_ptr<Rabit::RabitMessage> message;
        while (_answers->GetMessage(message))
            all.push_back(dynamic_cast<const Uav::CommandAck &>(*message));
        std::vector<Uav::CommandStage> stages;
        for (const Uav::CommandAck &ack : all)
            if (ack.id == id)
                stages.push_back(ack.stage);
        return stages;
    }
};

TEST_F(SwarmOverNetwork, FindsValidatesAndTracksATarget)
{
    StartSearch();
    ASSERT_TRUE(ComesTo("uav1", Uav::MissionMode::MISSION_CONFIRM, 60s)) << "uav1 finds it";
    EXPECT_EQ(Of<Uav::MissionState>("uav1", "MissionState").partner, "uav2");
    ASSERT_TRUE(ComesTo("uav2", Uav::MissionMode::MISSION_VALIDATE, 2s));
    ASSERT_TRUE(ComesTo("uav1", Uav::MissionMode::MISSION_TRACK, 45s)) << "uav2 sees it";
    _fleet.RunFor(5s);
    const auto findings = Of<Uav::Findings>("uav1", "Findings").items;
    ASSERT_EQ(findings.size(), 1u);
    EXPECT_EQ(findings[0].stage, Uav::TargetStage::TARGET_TRACKED);
    EXPECT_EQ(findings[0].validated_by, "uav2");
    EXPECT_TRUE(Of<Uav::Findings>("uav2", "Findings").items.empty());

    const auto targets = Of<Uav::Targets>("uav1.vision", "Targets").items;
    ASSERT_EQ(targets.size(), 1u);
    EXPECT_EQ(targets[0].found_by, "uav1");
    EXPECT_EQ(targets[0].seen_by.size(), 2u) << "detections cross between the aircraft";
    EXPECT_LT(targets[0].sigma_major_m, 2);
    EXPECT_LT(
        Swarm::LevelDistanceM(Swarm::PlaceOf(targets[0]), SwarmTest::WorldOfOneTarget().Targets[0].Start),
        3 * targets[0].sigma_major_m);
}

TEST_F(SwarmOverNetwork, AnswersTheGroundStationAndShowsItPictures)
{
    StartSearch();
    ASSERT_TRUE(ComesTo("uav1", Uav::MissionMode::MISSION_SEARCH, 60s));
    _fleet.RunFor(1s);
    std::vector<Uav::CommandAck> all;
    EXPECT_EQ(StagesOf(1, all),
              (std::vector{Uav::CommandStage::COMMAND_ACCEPTED, Uav::CommandStage::COMMAND_DONE}));
    EXPECT_GT(Latest<Uav::CameraView>(_ground->Workspace, "uav1.vision/CameraView").frame, 10u);
    std::shared_ptr<Rabit::RabitMessage> message;
    ASSERT_TRUE(_pictures->GetMessage(message));
    EXPECT_GT(dynamic_cast<const Uav::Picture &>(*message).jpeg.size(), 10'000u);
}

TEST_F(SwarmOverNetwork, GoesHomeWhenTheGroundStationIsGoneAndStaysThere)
{
    StartSearch();
    _fleet.RunFor(5s);
    ASSERT_NE(ModeOf("uav1"), Uav::MissionMode::MISSION_HOME);
    _fleet.Kill("ground");
    _fleet.RunFor(8s);
    EXPECT_NE(ModeOf("uav1"), Uav::MissionMode::MISSION_HOME);
    EXPECT_TRUE(ComesTo("uav1", Uav::MissionMode::MISSION_HOME, 8s));
    EXPECT_TRUE(ComesTo("uav2", Uav::MissionMode::MISSION_HOME, 2s));
    EXPECT_EQ(Of<Uav::MissionState>("uav1", "MissionState").text.substr(0, 29),
              "the ground station was silent");
    _fleet.RunFor(120s);
    EXPECT_EQ(ModeOf("uav1"), Uav::MissionMode::MISSION_HOME);
}

TEST_F(SwarmOverNetwork, HasNothingToComplainAbout)
{
    StartSearch();
    _fleet.RunFor(10s);
    for (auto &[name, node] : _nodes)
        EXPECT_EQ(node->Problems(), "") << name;
}

}  // namespace
