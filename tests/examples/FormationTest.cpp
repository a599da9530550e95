// The formation: its rules, and six whole aircraft with the real configuration files on a simulated network.
#include <rabit/testing/SimulatedFleet.h>
#include "Aircraft.h"
#include "Director.h"

#include <rabit/gateway/LoadGatewayConfig.h>

#include <gtest/gtest.h>

#include <chrono>
#include <complex>
#include <map>
#include <memory>
#include <set>
#include <sstream>
#include <string>

namespace Paths
{
extern const char *const FormationFolder;
}

namespace
{
using namespace std::chrono_literals;
using Formation::Other;
using Formation::Pose;
using Formation::Vector;

const Formation::Settings Defaults;

Pose At(Vector place, Vector velocity = {})
{
    Pose pose;
    pose.north_m = place.real();
    pose.east_m = place.imag();
    pose.north_mps = velocity.real();
    pose.east_mps = velocity.imag();
    return pose;
}

Formation::Leader LedBy(const std::string &node, Vector goal)
{
    Formation::Leader leader;
    leader.node = node;
    leader.has_goal = true;
    leader.north_m = goal.real();
    leader.east_m = goal.imag();
    return leader;
}

TEST(FormationRules, EachNameHasAPlaceOfItsOwn)
{
    for (int one = 1; one <= 6; ++one)
        for (int other = 1; other < one; ++other)
            EXPECT_GE(std::abs(Formation::SlotOf("uav" + std::to_string(one), 20) -
                               Formation::SlotOf("uav" + std::to_string(other), 20)),
                      19.9)
                << one << ' ' << other;
}

TEST(FormationRules, TheLeaderFliesToItsPlaceAtTheGoalAtCruiseSpeed)
{
    const Vector wanted = Formation::Decide("uav1", At({0, 0}), LedBy("uav1", {100, 0}), {}, Defaults);
    EXPECT_NEAR(wanted.real(), Defaults.CruiseMps, 1e-9);
    EXPECT_NEAR(wanted.imag(), 0, 1e-9);
}

TEST(FormationRules, AnotherOneFliesAsTheLeaderWhereItHasItsPlace)
{
    const Vector place = Vector{50, 0} + Formation::SlotOf("uav2", Defaults.SpacingM);
    const std::map<std::string, Other> others{{"uav1", {At({50, 0}, {5, 0}), 0.1}}};
    const auto leader = LedBy("uav1", {100, 0});
    EXPECT_NEAR(std::abs(Formation::Decide("uav2", At(place), leader, others, Defaults) - Vector{5, 0}), 0,
                1e-9);
    const Vector behind = Formation::Decide("uav2", At(place - Vector{3, 0}), leader, others, Defaults);
    EXPECT_GT(behind.real(), 5);
}

TEST(FormationRules, AllHoldBackWhileAPoseIsOldUntilItsAircraftIsGone)
{
    const auto leader = LedBy("uav1", {100, 0});
    for (const auto &[age, moves] : {std::pair{0.5, true}, {0.51, false}, {9.9, false}, {10.0, true}})
    {
        const std::map<std::string, Other> others{{"uav2", {At({-20, -20}), age}}};
        EXPECT_EQ(Formation::Decide("uav1", At({0, 0}), leader, others, Defaults) != Vector(), moves) << age;
    }
}

TEST(FormationRules, GivesWayToOneThatIsTooClose)
{
    const std::map<std::string, Other> others{{"uav2", {At({4, 0}), 0.1}}};
    EXPECT_LT(Formation::Decide("uav1", At({0, 0}), LedBy("uav1", {100, 0}), others, Defaults).real(), 0);
}

class FormationFleet : public testing::Test
{
protected:
    Rabit::SimulatedFleet _fleet{7};
    std::map<std::string, Rabit::SimulatedNode *> _nodes;
    std::ostringstream _said;
    double _closestM = 1e9;

    void SetUp() override
    {
        const std::string folder = Paths::FormationFolder;
        for (int i = 1; i <= 6; ++i)
        {
            const std::string name = "uav" + std::to_string(i);
            _nodes[name] =
                &_fleet.Add(Rabit::LoadGatewayConfig(folder + "/formation_uav.yaml", name), 1.4e9, "",
                            [](Rabit::SimulatedNode &node, Rabit::GatewayConfig &config)
                            {
                                node.Reactor.AddManager(std::make_unique<Formation::Dynamics>(
                                    config.Node, Defaults, node.Workspace));
                                node.Reactor.AddManager(std::make_unique<Formation::Keeper>(
                                    config.Node, Defaults, node.Workspace));
                                node.Reactor.AddManager(
                                    std::make_unique<Formation::Election>(config.Node, node.Workspace));
                            });
        }
        AddGround();
    }
    void AddGround()
    {
        _fleet.Add(Rabit::LoadGatewayConfig(std::string(Paths::FormationFolder) + "/formation_ground.yaml"),
                   1.4e9, "",
                   [this](Rabit::SimulatedNode &node, Rabit::GatewayConfig &)
                   {
                       node.Reactor.AddManager(std::make_unique<Formation::Director>(
                           static_cast<int>(_nodes.size()), 60, Defaults.SpacingM, node.Workspace, _said));
                   });
    }
    Pose PoseOf(const std::string &name)
    {
        Pose pose;
        _nodes.at(name)->Workspace.FetchMessage("Pose", &pose);
        return pose;
    }
    void Kill(const std::string &name)
    {
        _fleet.Kill(name);
        _nodes.erase(name);
    }
    // The oracle: it knows the true places.
    void Fly(std::chrono::nanoseconds duration)
    {
        for (auto flown = 0ns; flown < duration; flown += 100ms)
        {
            _fleet.RunFor(100ms);
            std::map<std::string, Vector> places;
            for (const auto &[name, node] : _nodes)
                places[name] = Formation::PlaceOf(PoseOf(name));
            for (const auto &[one, place] : places)
                for (const auto &[other, there] : places)
                    if (one < other)
                        _closestM = std::min(_closestM, std::abs(place - there));
        }
    }
    bool FliesUntil(const std::string &words, std::chrono::seconds limit)
    {
        for (auto flown = 0s; flown < limit && _said.str().find(words) == std::string::npos; flown += 1s)
            Fly(1s);
        return _said.str().find(words) != std::string::npos;
    }
};

TEST_F(FormationFleet, FliesBackAndForthThoughAFifthOfAllDatagramsIsLost)
{
    _fleet.Network.SetFaults("*", "*", {.Loss = 0.2});
    EXPECT_TRUE(FliesUntil("reached 0 m", 300s)) << _said.str();
    EXPECT_EQ(_said.str().rfind("leader uav1\nuav1/Election: accepted\n", 0), 0u) << _said.str();
    EXPECT_GT(_closestM, 10);
}

TEST_F(FormationFleet, AnotherOneLeadsOnWhenTheLeaderIsKilled)
{
    ASSERT_TRUE(FliesUntil("uav1/Election: accepted", 60s)) << _said.str();
    Fly(4s);
    Kill("uav1");
    Fly(1500ms);
    for (const auto &[name, node] : _nodes)
    {
        const Pose pose = PoseOf(name);
        EXPECT_LT(std::hypot(pose.north_mps, pose.east_mps), 2) << name << " holds back";
    }
    EXPECT_TRUE(FliesUntil("leader uav2", 30s)) << _said.str();
    EXPECT_TRUE(FliesUntil("reached 60 m", 120s)) << _said.str();
    EXPECT_GT(_closestM, 10);
}

TEST_F(FormationFleet, OneThatIsCutOffForAMinuteComesToItsPlaceWithoutACollision)
{
    ASSERT_TRUE(FliesUntil("uav1/Election: accepted", 60s)) << _said.str();
    Fly(3s);
    _fleet.Network.SetFaults("uav3", "*", {.Loss = 1.0});
    _fleet.Network.SetFaults("*", "uav3", {.Loss = 1.0});
    Fly(60s);
    _fleet.Network.SetFaults("uav3", "*", {});
    _fleet.Network.SetFaults("*", "uav3", {});
    Fly(20s);
    ASSERT_TRUE(FliesUntil("reached", 120s)) << _said.str();
    EXPECT_GT(_closestM, 10);
    const Vector apart = Formation::PlaceOf(PoseOf("uav3")) - Formation::PlaceOf(PoseOf("uav1"));
    EXPECT_LT(std::abs(apart - Formation::SlotOf("uav3", Defaults.SpacingM)), 6);
}

TEST_F(FormationFleet, ARestartedGroundProgramTakesOver)
{
    ASSERT_TRUE(FliesUntil("reached 60 m", 120s)) << _said.str();
    _fleet.Kill("ground");
    _said.str("");
    AddGround();
    EXPECT_TRUE(FliesUntil("reached", 120s)) << _said.str();
    EXPECT_GT(_closestM, 10);
}

}  // namespace
