// Two whole aircraft as managers of one process and one workspace: no gateway, no network.
#include "Swarm.h"
#include "mission/TargetBook.h"

#include <rabit/ManualClock.h>

#include <gtest/gtest.h>

#include <chrono>
#include <memory>
#include <vector>

namespace
{
using namespace std::chrono_literals;
using SwarmTest::Latest;

class SwarmInOneProcess : public testing::Test
{
protected:
    std::shared_ptr<Rabit::ManualClock> _clock = std::make_shared<Rabit::ManualClock>(1.4e9);
    Rabit::RabitWorkspace _workspace{_clock};
    std::shared_ptr<Rabit::RabitMessageQueue<std::shared_ptr<Rabit::RabitMessage>>> _answers =
        std::make_shared<Rabit::RabitMessageQueue<std::shared_ptr<Rabit::RabitMessage>>>(100, "Commands");
    std::shared_ptr<Uav::SearchArea> _area = std::make_shared<Uav::SearchArea>();
    Rabit::RabitSteppedReactor _reactor{_workspace};

    void SetUp() override
    {
        int number = 1;
        for (const char *aircraft : {"uav1", "uav2"})
        {
            const Swarm::Names names(aircraft, "");
            SwarmTest::AddFlyingManagers(_reactor, _workspace, names, number * 130.0 - 200);
            SwarmTest::AddSeeingManagers(_reactor, _workspace, names, static_cast<std::uint64_t>(number));
            ++number;
        }
        _workspace.AddManagerMessageQueue("ground/Commands", _answers);
        _workspace.AddPublishSubscribeMessage("ground/SearchArea", _area);
        _reactor.Start();
        Run(2s);
    }
    void Run(std::chrono::nanoseconds duration) { _reactor.RunFor(*_clock, duration); }
    // True if the mission of this aircraft came to this mode within the time.
    bool ComesTo(const std::string &aircraft, Uav::MissionMode mode, std::chrono::seconds limit)
    {
        for (auto t = 0ms; t < limit; t += 100ms)
        {
            if (State(aircraft).mode == mode)
                return true;
            Run(100ms);
        }
        return false;
    }
    void CommandSearch(const std::string &aircraft, std::uint32_t id)
    {
        auto search = std::make_shared<Uav::Search>();
        search->id = id;
        search->reply_to = "ground/Commands";
        ASSERT_TRUE(_workspace.AddMessageToQueue(aircraft + "/MissionControl", search));
    }
    void PostArea()
    {
        Uav::SearchArea area = SwarmTest::Area();
        _area->CopyMessage(&area);
        _area->PostMessage();
    }
    Uav::MissionState State(const std::string &aircraft)
    {
        return Latest<Uav::MissionState>(_workspace, aircraft + "/MissionState");
    }
    std::vector<Uav::Finding> Findings(const std::string &aircraft)
    {
        return Latest<Uav::Findings>(_workspace, aircraft + "/Findings").items;
    }
};

TEST_F(SwarmInOneProcess, StaysWhereItIsUntilItIsTold)
{
    PostArea();
    Run(60s);
    EXPECT_EQ(State("uav1").mode, Uav::MissionMode::MISSION_IDLE);
    EXPECT_EQ(State("uav1").search_area, 3u);
    EXPECT_EQ(Latest<Uav::FlightMode>(_workspace, "uav1/FlightMode").phase, Uav::FlightPhase::FLIGHT_PATTERN);
}

TEST_F(SwarmInOneProcess, FindsValidatesAndTracksATarget)
{
    PostArea();
    CommandSearch("uav1", 1);
    CommandSearch("uav2", 2);
    ASSERT_TRUE(ComesTo("uav1", Uav::MissionMode::MISSION_CONFIRM, 60s)) << "uav1 finds it";
    EXPECT_EQ(State("uav1").partner, "uav2");
    ASSERT_TRUE(ComesTo("uav2", Uav::MissionMode::MISSION_VALIDATE, 2s));
    ASSERT_TRUE(ComesTo("uav1", Uav::MissionMode::MISSION_TRACK, 45s)) << "uav2 sees it";
    Run(5s);
    EXPECT_NE(State("uav2").mode, Uav::MissionMode::MISSION_VALIDATE) << "searches on";
    ASSERT_EQ(Findings("uav1").size(), 1u);
    EXPECT_TRUE(Findings("uav2").empty());
    const Uav::Finding finding = Findings("uav1")[0];
    EXPECT_EQ(finding.stage, Uav::TargetStage::TARGET_TRACKED);
    EXPECT_EQ(finding.validated_by, "uav2");
    EXPECT_NEAR(finding.tracked_s, 5, 1.5);

    const auto targets = Latest<Uav::Targets>(_workspace, "uav1.vision/Targets").items;
    ASSERT_EQ(targets.size(), 1u);
    EXPECT_LT(
        Swarm::LevelDistanceM(Swarm::PlaceOf(targets[0]), SwarmTest::WorldOfOneTarget().Targets[0].Start),
        3 * targets[0].sigma_major_m);
    EXPECT_LT(targets[0].sigma_major_m, 2);

    Run(60s);
    EXPECT_NE(State("uav1").mode, Uav::MissionMode::MISSION_TRACK) << "searches on";
    EXPECT_NEAR(Findings("uav1")[0].tracked_s, 60, 2);
    Run(120s);
    EXPECT_EQ(Findings("uav1").size(), 1u) << "and knows the target again";
    EXPECT_TRUE(Findings("uav2").empty());
}

}  // namespace
