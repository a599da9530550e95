// The formation: its rules, and six whole aircraft with the real configuration files on a simulated network.
#include <rabit/testing/SimulatedFleet.h>
#include "Aircraft.h"
#include "Director.h"

#include <rabit/gateway/Claims.h>
#include <rabit/gateway/LoadGatewayConfig.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <complex>
#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <sstream>
#include <string>
#include <vector>

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
    leader.Node = node;
    leader.Goal = goal;
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

TEST(FormationRules, WithoutALeaderAllHoldTheirPositions)
{
    const std::map<std::string, Other> others{{"uav2", {At({-20, -20}, {5, 0}), 0.1}}};
    EXPECT_EQ(Formation::Decide("uav1", At({0, 0}), LedBy("", {100, 0}), others, Defaults), Vector());
}

TEST(FormationRules, AGoalIsReadFromItsTextAndOtherTextsAreNone)
{
    EXPECT_EQ(Formation::GoalOf(Formation::TextOf({-120.5, 60})), Vector(-120.5, 60));
    EXPECT_FALSE(Formation::GoalOf(""));
    EXPECT_FALSE(Formation::GoalOf("north"));
}

TEST(FormationRules, GivesWayToOneThatIsTooClose)
{
    const std::map<std::string, Other> others{{"uav2", {At({4, 0}), 0.1}}};
    EXPECT_LT(Formation::Decide("uav1", At({0, 0}), LedBy("uav1", {100, 0}), others, Defaults).real(), 0);
}

class FormationFleet : public testing::Test
{
protected:
    using Names = std::vector<std::string>;

    Rabit::SimulatedFleet _fleet{7};
    std::map<std::string, Rabit::SimulatedNode *> _nodes;  // the aircraft
    std::map<std::string, Rabit::Claims> _claims;          // of the aircraft
    std::ostringstream _said;
    double _closestM = 1e9;
    std::uint64_t _fence = 0;  // the highest one of a leader so far
    std::size_t _fewestLeaders = 1;

    void SetUp() override
    {
        const std::string folder = Paths::FormationFolder;
        for (int i = 1; i <= 6; ++i)
        {
            const std::string name = "uav" + std::to_string(i);
            _nodes[name] = &_fleet.Add(
                Rabit::LoadGatewayConfig(folder + "/formation_uav.yaml", name), 1.4e9, "",
                [this](Rabit::SimulatedNode &node, Rabit::GatewayConfig &config)
                {
                    _claims.emplace(config.Node, Rabit::Claims(config));
                    node.Reactor.AddManager(
                        std::make_unique<Formation::Dynamics>(config.Node, Defaults, node.Workspace));
                    node.Reactor.AddManager(
                        std::make_unique<Formation::Keeper>(Defaults, config, node.Workspace));
                    node.Reactor.AddManager(std::make_unique<Formation::Leadership>(config, node.Workspace));
                });
        }
        AddGround();
    }
    void AddGround()
    {
        _fleet.Add(
            Rabit::LoadGatewayConfig(std::string(Paths::FormationFolder) + "/formation_ground.yaml"), 1.4e9,
            "",
            [this](Rabit::SimulatedNode &node, Rabit::GatewayConfig &config)
            {
                node.Reactor.AddManager(std::make_unique<Formation::Director>(
                    static_cast<int>(_nodes.size()), 60, Defaults.SpacingM, config, node.Workspace, _said));
            });
    }
    Pose PoseOf(const std::string &name)
    {
        Pose pose;
        _nodes.at(name)->Workspace.FetchMessage("Pose", &pose);
        return pose;
    }
    double SpeedOf(const std::string &name)
    {
        const Pose pose = PoseOf(name);
        return std::hypot(pose.north_mps, pose.east_mps);
    }
    Names Leaders() const
    {
        Names leaders;
        for (const auto &[name, claims] : _claims)
            if (claims.IsLeader())
                leaders.push_back(name);
        return leaders;
    }
    // The leader, once it has accepted a goal; empty: none within a minute.
    std::string LeaderOnItsWay()
    {
        const bool isOnItsWay = FliesUntil("/Leadership: accepted", 60s);
        return isOnItsWay && Leaders().size() == 1 ? Leaders().front() : "";
    }
    // Aircraft that do not lead.
    Names Followers() const
    {
        Names followers;
        for (const auto &[name, claims] : _claims)
            if (!claims.IsLeader())
                followers.push_back(name);
        return followers;
    }
    void Kill(const std::string &name)
    {
        _claims.erase(name);
        _nodes.erase(name);
        _fleet.Kill(name);
    }
    // Cuts these aircraft off from all other nodes; they hear each other.
    void CutOff(const Names &names)
    {
        for (const std::string &name : names)
        {
            _fleet.Network.SetFaults(name, "*", {.Cut = true});
            _fleet.Network.SetFaults("*", name, {.Cut = true});
        }
        for (const std::string &one : names)
            for (const std::string &other : names)
                _fleet.Network.SetFaults(one, other, {});
    }
    // The oracle: it knows the true places, and which aircraft holds the lead.
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
            const Names leaders = Leaders();
            _fewestLeaders = std::min(_fewestLeaders, leaders.size());
            ASSERT_LE(leaders.size(), 1u) << leaders.front() << " and " << leaders.back();
            if (!leaders.empty())
            {
                const std::uint64_t fence = _claims.at(leaders.front()).FenceOf("leader").value_or(0);
                ASSERT_GE(fence, _fence) << leaders.front();
                _fence = fence;
            }
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
    EXPECT_GT(_closestM, 10);
}

TEST_F(FormationFleet, AnotherOneLeadsOnWhenTheLeaderIsKilled)
{
    const std::string former = LeaderOnItsWay();
    ASSERT_NE(former, "") << _said.str();
    Fly(4s);
    _said.str("");
    Kill(former);
    Fly(1500ms);
    for (const auto &[name, node] : _nodes)
        EXPECT_LT(SpeedOf(name), 2) << name << " holds back";
    EXPECT_TRUE(FliesUntil("leader uav", 30s)) << _said.str();
    EXPECT_TRUE(FliesUntil("reached 60 m", 120s)) << _said.str();
    EXPECT_GT(_closestM, 10);
}

TEST_F(FormationFleet, AMinorityHasNoLeaderAndHoldsItsPositionWhileTheOthersAreLedOn)
{
    const std::string leader = LeaderOnItsWay();
    ASSERT_NE(leader, "") << _said.str();
    const Names minority = {Followers().at(0), Followers().at(1)};
    CutOff(minority);
    _fewestLeaders = 1;
    Fly(15s);
    std::map<std::string, Vector> held;
    for (const std::string &name : minority)
    {
        EXPECT_EQ(_claims.at(name).Leader(), "") << name;
        held[name] = Formation::PlaceOf(PoseOf(name));
    }
    Fly(30s);
    for (const auto &[name, place] : held)
        EXPECT_LT(std::abs(Formation::PlaceOf(PoseOf(name)) - place), 0.1) << name;
    EXPECT_EQ(_fewestLeaders, 1u) << "one leader at each instant";
    EXPECT_EQ(Leaders(), Names{leader});
    EXPECT_NE(_said.str().find("reached 60 m"), std::string::npos) << _said.str();
}

TEST_F(FormationFleet, ALeaderThatIsCutOffWithAMinorityLeadsNoMoreAndTheFleetHasOneLeaderAfterwards)
{
    const std::string former = LeaderOnItsWay();
    ASSERT_NE(former, "") << _said.str();
    const Names minority = {former, Followers().at(0), Followers().at(1)};
    CutOff(minority);
    Fly(2s);
    EXPECT_FALSE(_claims.at(former).IsLeader()) << "its lease has ended";
    Fly(43s);
    ASSERT_EQ(Leaders().size(), 1u);
    const std::string leader = Leaders().front();
    EXPECT_EQ(std::count(minority.begin(), minority.end(), leader), 0) << leader;
    _fleet.Network.ClearFaults();
    Fly(30s);
    ASSERT_EQ(Leaders().size(), 1u);
    for (const auto &[name, claims] : _claims)
        EXPECT_EQ(claims.Leader(), Leaders().front()) << name;
    _said.str("");
    EXPECT_TRUE(FliesUntil("reached", 120s)) << _said.str();
    EXPECT_GT(_closestM, 10);
}

TEST_F(FormationFleet, OneThatIsCutOffForAMinuteComesToItsPlaceWithoutACollision)
{
    const std::string leader = LeaderOnItsWay();
    ASSERT_NE(leader, "") << _said.str();
    Fly(3s);
    const std::string lone = Followers().at(0);
    CutOff({lone});
    Fly(60s);
    _fleet.Network.ClearFaults();
    Fly(45s);
    ASSERT_TRUE(FliesUntil("reached", 120s)) << _said.str();
    EXPECT_GT(_closestM, 10);
    const Vector apart = Formation::PlaceOf(PoseOf(lone)) - Formation::PlaceOf(PoseOf(leader));
    EXPECT_LT(std::abs(apart - Formation::SlotOf(lone, Defaults.SpacingM) +
                       Formation::SlotOf(leader, Defaults.SpacingM)),
              6);
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
