// States are sent once and repaired on request: whole nodes on the simulated network.
#include <gmock/gmock.h>

#include <chrono>
#include <cstdint>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "SimulatedFleet.h"

namespace Rabit
{
namespace
{

using namespace std::chrono_literals;
using std::chrono::nanoseconds;

// A State that cannot be written has no version, which reads as "never written".
TEST(StateThatCannotBeWritten, IsAProblemUntilAnotherPostIsWritten)
{
    SimulatedFleet fleet;
    GatewayConfig config = AircraftConfig("uav1");
    config.Publish.push_back({.Message = "Order", .Type = "Uav::Goto"});
    SimulatedNode &uav = fleet.Add(config);
    fleet.Add(GroundConfig());
    const auto order = uav.Register<Uav::Goto>("Order");
    order->PostMessage();
    fleet.RunFor(3s);
    EXPECT_THAT(uav.Problems(), ::testing::Not(::testing::HasSubstr("publish Order")));
    order->reply_to = std::string(65, 'x');
    order->PostMessage();
    fleet.RunFor(3s);
    EXPECT_THAT(
        uav.Problems(),
        ::testing::HasSubstr("publish Order: the last post of `Order` cannot be written: it "
                             "does not fit `Uav::Goto` or is too large; other nodes keep the one before"));
    order->reply_to.clear();
    order->PostMessage();
    fleet.RunFor(3s);
    EXPECT_THAT(uav.Problems(), ::testing::Not(::testing::HasSubstr("publish Order")));
}

// Nodes that each publish some States `S0`, `S1` ... and want those of all others.
class StateNodesTest : public ::testing::Test
{
protected:
    struct Member
    {
        SimulatedNode *Node = nullptr;
        std::vector<std::shared_ptr<Uav::MissionState>> States;
    };

    static std::string NameOf(std::size_t state) { return std::string("S").append(std::to_string(state)); }

    Member Join(const std::string &name, std::size_t states, std::size_t wanted = 0)
    {
        GatewayConfig config;
        config.Node = name;
        for (std::size_t i = 0; i < states; ++i)
        {
            config.Publish.push_back({.Message = NameOf(i), .Type = "Uav::MissionState"});
        }
        for (std::size_t i = 0; i < std::max(states, wanted); ++i)
        {
            config.Subscribe.push_back({.Message = NameOf(i), .Type = "Uav::MissionState"});
        }
        Member member;
        member.Node = &fleet.Add(config);
        for (std::size_t i = 0; i < states; ++i)
        {
            member.States.push_back(member.Node->Register<Uav::MissionState>(NameOf(i)));
        }
        return member;
    }

    static void Post(const Member &member, std::uint32_t value)
    {
        for (const auto &state : member.States)
        {
            state->commands = value;
            state->PostMessage();
        }
    }

    // Returns the value that the node shows of another node's State; 0: none.
    static std::uint32_t Shown(const Member &member, const std::string &origin, std::size_t state)
    {
        Uav::MissionState shown;
        member.Node->Workspace.ForceFetchMessage(origin + "/" + NameOf(state), &shown);
        return shown.commands;
    }

    // True if the node shows `value` for all States of the other one.
    static bool Shows(const Member &member, const std::string &origin, std::size_t states,
                      std::uint32_t value)
    {
        for (std::size_t i = 0; i < states; ++i)
        {
            if (Shown(member, origin, i) != value)
            {
                return false;
            }
        }
        return true;
    }

    // Waits for the node's report. Returns the number of samples that it has written of all its States.
    std::uint64_t Written(const Member &member)
    {
        fleet.RunFor(1100ms);
        std::uint64_t sum = 0;
        for (const Gateway::PublicationStatus &publication : member.Node->Fleet().publications)
        {
            sum += publication.written;
        }
        return sum;
    }

    // Returns how long it takes until the condition holds; the longest time if it does not.
    template <typename Holds>
    nanoseconds Until(Holds holds, nanoseconds limit)
    {
        const nanoseconds begin = fleet.Network.Now();
        return fleet.RunUntil(holds, limit) ? fleet.Network.Now() - begin : nanoseconds::max();
    }

    void Lose(double share)
    {
        SimulatedFaults lossy;
        lossy.Loss = share;
        fleet.Network.SetFaults("*", "*", lossy);
    }

    SimulatedFleet fleet;
};

TEST_F(StateNodesTest, AStateThatDoesNotChangeCostsNoSample)
{
    Member uav = Join("uav1", 3);
    Member ground = Join("ground", 0, 3);
    fleet.RunFor(3s);
    Post(uav, 7);
    fleet.RunFor(1h);
    EXPECT_TRUE(Shows(ground, "uav1", 3, 7));
    EXPECT_EQ(Written(uav), 3u);
}

TEST_F(StateNodesTest, ALateJoinerHasAllStatesWithinASecond)
{
    Member uav = Join("uav1", 3);
    Post(uav, 7);
    fleet.RunFor(60s);
    Member ground = Join("ground", 0, 3);
    ASSERT_TRUE(fleet.RunUntil([&] { return ground.Node->StateOf("uav1") == "UP"; }, 10s));
    EXPECT_LE(Until([&] { return Shows(ground, "uav1", 3, 7); }, 5s), 300ms);
    fleet.RunFor(60s);
    EXPECT_LE(Written(uav), 6u) << "each is said once more at most";
}

TEST_F(StateNodesTest, ALateJoinerHasMoreStatesThanABeatTells)
{
    constexpr std::size_t Many = 150;
    Member uav = Join("uav1", Many);
    Post(uav, 7);
    fleet.RunFor(60s);
    Member ground = Join("ground", 0, Many);
    EXPECT_LE(Until([&] { return Shows(ground, "uav1", Many, 7); }, 30s), 5s);
}

TEST_F(StateNodesTest, ALostSampleIsRepairedWithinThreeTenthsOfASecond)
{
    Member uav = Join("uav1", 1);
    Member ground = Join("ground", 0, 1);
    fleet.RunFor(10s);
    std::vector<nanoseconds> times;
    for (std::uint32_t value = 1; value <= 50; ++value)
    {
        fleet.RunFor(6s + value * 37ms);
        SimulatedFaults cut;
        cut.Cut = true;
        fleet.Network.SetFaults("uav1", "ground", cut);
        Post(uav, value);
        fleet.RunFor(1ms);
        fleet.Network.ClearFaults();
        times.push_back(Until([&] { return Shows(ground, "uav1", 1, value); }, 10s));
    }
    EXPECT_THAT(times, testing::Each(testing::Le(275ms)));
    EXPECT_EQ(Written(uav), 100u) << "each twice";
}

TEST_F(StateNodesTest, ASampleThatIsOvertakenByTheBeatIsNotAskedFor)
{
    SimulatedFaults far;
    far.Delay = 20ms;
    far.Jitter = 30ms;
    fleet.Network.SetFaults("*", "*", far);
    Member uav = Join("uav1", 1);
    Member ground = Join("ground", 0, 1);
    fleet.RunFor(10s);
    for (std::uint32_t value = 1; value <= 100; ++value)
    {
        fleet.RunFor(1s + value * 7ms);
        Post(uav, value);
    }
    fleet.RunFor(5s);
    EXPECT_TRUE(Shows(ground, "uav1", 1, 100));
    EXPECT_EQ(Written(uav), 100u);
}

class StateNodesUnderLossTest : public StateNodesTest, public ::testing::WithParamInterface<double>
{
};

TEST_P(StateNodesUnderLossTest, TheLastValueOfEveryStateReachesEverybody)
{
    constexpr std::size_t States = 2;
    Lose(GetParam());
    const std::vector<std::string> names = {"uav1", "uav2", "uav3", "uav4", "ground"};
    std::vector<Member> members;
    for (const std::string &name : names)
    {
        members.push_back(Join(name, States));
    }
    fleet.RunFor(20s);
    const auto all = [&](std::uint32_t value)
    {
        for (const Member &member : members)
        {
            for (const std::string &name : names)
            {
                if (member.Node->Fleet().node != name && !Shows(member, name, States, value))
                {
                    return false;
                }
            }
        }
        return true;
    };
    for (std::uint32_t value = 1; value <= 20; ++value)
    {
        for (const Member &member : members)
        {
            Post(member, value);
            fleet.RunFor(30ms);
        }
        EXPECT_LE(Until([&] { return all(value); }, 60s), 30s) << value;
    }
    std::vector<std::uint64_t> written;
    for (const Member &member : members)
    {
        written.push_back(Written(member));
    }
    fleet.RunFor(10min);
    for (std::size_t i = 0; i < members.size(); ++i)
    {
        EXPECT_EQ(Written(members[i]), written[i]) << "all have all: nothing is asked for";
    }
}

INSTANTIATE_TEST_SUITE_P(Shares, StateNodesUnderLossTest, ::testing::Values(0.0, 0.2, 0.4),
                         [](const auto &share)
                         { return std::to_string(static_cast<int>(share.param * 100)).append("Percent"); });

TEST_F(StateNodesTest, OfANodeThatComesBackTheStatesOfItsNewLifeAreShownAndNoneOfTheFormer)
{
    Member ground = Join("ground", 0, 2);
    Member uav = Join("uav1", 2);
    Post(uav, 7);
    fleet.RunFor(10s);
    ASSERT_TRUE(Shows(ground, "uav1", 2, 7));
    fleet.Kill("uav1");
    fleet.RunFor(3s);
    uav = Join("uav1", 2);
    uav.States[0]->commands = 8;
    uav.States[0]->PostMessage();
    EXPECT_LE(Until([&] { return Shown(ground, "uav1", 0) == 8; }, 10s), 1s);
    fleet.RunFor(10s);
    EXPECT_EQ(Shown(ground, "uav1", 1), 7u) << "what is not replaced stays, with its age";
    Uav::MissionState old;
    ground.Node->Workspace.ForceFetchMessage("uav1/S1", &old);
    EXPECT_GT(old.GetAgeSeconds(), 20.0);
    EXPECT_EQ(ground.Node->Workspace.FindGlobalMessage("uav1/S1")->GetNumberOfPosts(), 1u);
}

TEST_F(StateNodesTest, ARestartedSubscriberHasTheStatesAgain)
{
    Member uav = Join("uav1", 2);
    Member ground = Join("ground", 0, 2);
    Post(uav, 7);
    fleet.RunFor(10s);
    fleet.Kill("ground");
    fleet.RunFor(1s);
    ground = Join("ground", 0, 2);
    ASSERT_TRUE(fleet.RunUntil([&] { return ground.Node->StateOf("uav1") == "UP"; }, 10s));
    EXPECT_LE(Until([&] { return Shows(ground, "uav1", 2, 7); }, 10s), 300ms);
}

TEST_F(StateNodesTest, WhatWasPostedDuringAnOutageIsThereSoonAfterIt)
{
    Member uav = Join("uav1", 2);
    Member ground = Join("ground", 0, 2);
    Post(uav, 7);
    fleet.RunFor(10s);
    const std::uint64_t before = Written(uav);
    SimulatedFaults cut;
    cut.Cut = true;
    fleet.Network.SetFaults("uav1", "ground", cut);
    fleet.RunFor(1min);
    Post(uav, 8);
    fleet.RunFor(1min);
    EXPECT_EQ(Written(uav) - before, 2u) << "nobody can ask";
    fleet.Network.ClearFaults();
    EXPECT_LE(Until([&] { return ground.Node->StateOf("uav1") == "UP"; }, 20s), 15s);
    EXPECT_LE(Until([&] { return Shows(ground, "uav1", 2, 8); }, 20s), 2s);
}

// In a fleet that is there already, a newcomer costs the nodes nothing for each other.
TEST_F(StateNodesTest, ANewcomerIsToldByThoseWhomItAsksAndByNobodyElse)
{
    Member asked = Join("uav1", 1);
    Member other = Join("uav2", 0, 0);
    Post(asked, 7);
    fleet.RunFor(10s);
    GatewayConfig config;
    config.Node = "idle";
    fleet.Add(config);
    fleet.RunFor(10s);
    EXPECT_EQ(Written(asked), 1u) << "the newcomer does not want it";
}

TEST_F(StateNodesTest, AStateThatCannotBeDecodedOrPostedIsNotAskedForWithoutEnd)
{
    Member uav = Join("uav1", 1);
    Member ground = Join("ground", 0, 1);
    ground.Node->Register<Uav::Goto>("uav1/S0");
    fleet.RunFor(3s);
    Post(uav, 7);
    fleet.RunFor(1min);
    EXPECT_EQ(Written(uav), 1u);
}

}  // namespace
}  // namespace Rabit
