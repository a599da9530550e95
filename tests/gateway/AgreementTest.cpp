// Nodes that agree on claims, with cuts and restarts, under simulated time.
#include <gmock/gmock.h>
#include <rabit/gateway/ConfigError.h>

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>

#include "AgreementFleet.h"

namespace Rabit
{
namespace
{

using namespace std::chrono_literals;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;
using ::testing::SizeIs;

class ClaimsOfNodes : public AgreementFleet
{
};

TEST_F(ClaimsOfNodes, OfFiveThatAskAtOnceOneGetsTheClaimAndTheOthersLearnWhichOne)
{
    StartFive();
    for (const std::string &name : FiveMembers)
    {
        EXPECT_TRUE(ClaimsOf(name).Claim("cell 17"));
    }
    const std::string holder = UntilHeld("cell 17", 15s);
    ASSERT_NE(holder, "");
    RunFor(30s);
    EXPECT_THAT(HoldersOf("cell 17"), ElementsAre(holder));
    for (const std::string &name : FiveMembers)
    {
        const Claims::Status status = ClaimsOf(name).StatusOf("cell 17");
        EXPECT_TRUE(status.IsWanted);
        EXPECT_EQ(status.Holder, holder) << name;
        EXPECT_EQ(status.Reason.empty(), name == holder) << status.Reason;
    }
    EXPECT_THAT(ClaimsOf(holder).Mine(), ElementsAre("cell 17"));
}

TEST_F(ClaimsOfNodes, AClaimThatIsReleasedGoesToTheNextOneThatAsks)
{
    StartFive();
    RunFor(FirstLease);
    ClaimsOf("uav1").BeLeader();
    ASSERT_EQ(UntilHeld("leader", 1s), "uav1");
    ClaimsOf("uav2").BeLeader();
    RunFor(3s);
    EXPECT_FALSE(ClaimsOf("uav2").IsLeader());
    EXPECT_EQ(ClaimsOf("uav3").Leader(), "uav1");
    ClaimsOf("uav1").Release(Claims::Leadership);
    EXPECT_FALSE(ClaimsOf("uav1").IsLeader()) << "from the call on";
    EXPECT_EQ(UntilHeld("leader", 4s), "uav2");
    EXPECT_FALSE(ClaimsOf("uav1").StatusOf("leader").IsWanted);
}

TEST_F(ClaimsOfNodes, AClaimThatIsReleasedAndClaimedAtOnceIsWonAnewUnderAHigherFence)
{
    StartFive();
    RunFor(FirstLease);
    ClaimsOf("uav1").Claim("cell 17");
    ASSERT_EQ(UntilHeld("cell 17", 1s), "uav1");
    RunFor(1s);
    int changes = 0;
    const RabitScopedConnection connection = ClaimsOf("uav1").ConnectChanged([&changes] { ++changes; });
    const std::optional<std::uint64_t> before = ClaimsOf("uav1").FenceOf("cell 17");
    ClaimsOf("uav1").Release("cell 17");
    ClaimsOf("uav1").Claim("cell 17");
    EXPECT_FALSE(ClaimsOf("uav1").StillMine("cell 17"));
    EXPECT_EQ(UntilHeld("cell 17", 1s), "uav1");
    EXPECT_GT(ClaimsOf("uav1").FenceOf("cell 17"), before);
    EXPECT_GE(changes, 1);
}

TEST_F(ClaimsOfNodes, OfSeveralWishesInOneMomentTheLastOneHolds)
{
    StartFive();
    RunFor(FirstLease);
    ClaimsOf("uav1").Claim("cell 17");
    ASSERT_EQ(UntilHeld("cell 17", 1s), "uav1");
    ClaimsOf("uav1").Release("cell 17");
    ClaimsOf("uav1").Try("cell 17");
    ASSERT_EQ(UntilHeld("cell 17", 1s), "uav1");
    Cut("uav1");
    RunFor(5s);
    EXPECT_FALSE(ClaimsOf("uav1").StatusOf("cell 17").IsWanted) << "it was asked for once, and lost";
    fleet.Network.ClearFaults();
    RunFor(10s);
    ClaimsOf("uav2").Try("cell 17");
    EXPECT_EQ(UntilHeld("cell 17", 1s), "uav2") << "nobody else asks for it";
}

TEST_F(ClaimsOfNodes, AClaimOfANodeThatEndsInOrderIsFreeBeforeItsLeaseHasPassed)
{
    StartFive();
    RunFor(FirstLease);
    ClaimsOf("uav1").Claim("cell 17");
    ASSERT_EQ(UntilHeld("cell 17", 1s), "uav1");
    fleet.Stop("uav1");
    EXPECT_THAT(HoldersOf("cell 17"), IsEmpty());
    ClaimsOf("uav2").Claim("cell 17");
    EXPECT_EQ(UntilHeld("cell 17", 1s), "uav2");
}

TEST_F(ClaimsOfNodes, AHolderThatIsCutOffLosesItsClaimBeforeAnotherOneGetsItAndSaysSo)
{
    StartFive();
    RunFor(FirstLease);
    ClaimsOf("uav1").Claim("cell 17");
    ASSERT_EQ(UntilHeld("cell 17", 1s), "uav1");
    for (const std::string &name : FiveMembers)
    {
        ClaimsOf(name).Claim("cell 17");
    }
    RunFor(3s);
    int changes = 0;
    const RabitScopedConnection connection = ClaimsOf("uav1").ConnectChanged([&changes] { ++changes; });
    Cut("uav1");
    RunFor(2100ms);
    EXPECT_FALSE(ClaimsOf("uav1").StillMine("cell 17"));
    EXPECT_GE(changes, 1);
    EXPECT_THAT(ClaimsOf("uav1").StatusOf("cell 17").Reason, HasSubstr("its lease has ended"));
    EXPECT_NE(UntilHeld("cell 17", 15s), "");
    EXPECT_FALSE(ClaimsOf("uav1").StillMine("cell 17"));
    RunFor(3s);
    EXPECT_THAT(fleet["uav1"].Problems(),
                HasSubstr("agreement: 1 of 5 members are there with the same list, and a majority is 3"));
    fleet.Network.ClearFaults();
    RunFor(10s);
    EXPECT_THAT(HoldersOf("cell 17"), SizeIs(1));
    EXPECT_FALSE(ClaimsOf("uav1").StillMine("cell 17"));
    EXPECT_THAT(fleet["uav1"].Problems(), Not(HasSubstr("agreement")));
}

TEST_F(ClaimsOfNodes, ALostLeaseIsAProblemForSomeSeconds)
{
    StartFive();
    RunFor(FirstLease);
    ClaimsOf("uav1").Try("cell 17");
    ASSERT_EQ(UntilHeld("cell 17", 1s), "uav1");
    Cut("uav1");
    RunFor(4s);
    EXPECT_THAT(fleet["uav1"].Problems(), HasSubstr("claim cell 17: lost under fence"));
    EXPECT_FALSE(ClaimsOf("uav1").StatusOf("cell 17").IsWanted) << "it was asked for once";
    RunFor(15s);
    EXPECT_THAT(fleet["uav1"].Problems(), Not(HasSubstr("claim cell 17")));
}

TEST_F(ClaimsOfNodes, AClaimOfAKilledNodeIsTakenOverAndARestartedOneHoldsNothing)
{
    StartFive();
    RunFor(FirstLease);
    ClaimsOf("uav1").BeLeader();
    ASSERT_EQ(UntilHeld("leader", 1s), "uav1");
    RunFor(1s);
    ClaimsOf("uav2").BeLeader();
    RunFor(1s);
    Kill("uav1");
    EXPECT_EQ(UntilHeld("leader", 15s), "uav2");
    Start(MemberConfig("uav1"));
    ClaimsOf("uav1").BeLeader();
    RunFor(10s);
    EXPECT_THAT(HoldersOf("leader"), ElementsAre("uav2"));
    EXPECT_EQ(ClaimsOf("uav1").Leader(), "uav2");
}

TEST_F(ClaimsOfNodes, FencesRiseOverARestartOfAllMembersWithoutStorage)
{
    StartFive();
    RunFor(FirstLease);
    ClaimsOf("uav1").BeLeader();
    ASSERT_EQ(UntilHeld("leader", 1s), "uav1");
    RunFor(1s);
    for (const std::string &name : FiveMembers)
    {
        Kill(name);
    }
    for (const std::string &name : FiveMembers)
    {
        fleet.Add(MemberConfig(name), 1.4e9 + 60, "",
                  [this](SimulatedNode &, GatewayConfig &config)
                  { programs[config.Node] = std::make_unique<Program>(config); });
    }
    ClaimsOf("uav2").BeLeader();
    EXPECT_EQ(UntilHeld("leader", 15s), "uav2");  // RunFor compares the fences
}

TEST_F(ClaimsOfNodes, FencesAreStoredAndAFolderThatCannotBeWrittenIsAProblem)
{
    const std::filesystem::path folder =
        std::filesystem::path(::testing::TempDir()) / ("rabit-fences-" + std::to_string(::getpid()));
    GatewayConfig alone = MemberConfig("uav1", {"uav1"});
    alone.StateDir = folder.string();
    Start(alone);
    ClaimsOf("uav1").BeLeader();
    ASSERT_EQ(UntilHeld("leader", 15s), "uav1");
    EXPECT_TRUE(std::filesystem::exists(folder / "uav1.fence"));
    EXPECT_THAT(fleet["uav1"].Problems(), Not(HasSubstr("fences")));
    Kill("uav1");

    // A folder in place of the file.
    std::filesystem::remove(folder / "uav1.fence");
    std::filesystem::create_directories(folder / "uav1.fence" / "in the way");
    Start(alone);
    ClaimsOf("uav1").BeLeader();
    EXPECT_EQ(UntilHeld("leader", 10s), "");
    EXPECT_THAT(fleet["uav1"].Problems(), HasSubstr("agreement: the fences are not stored: "));
    Kill("uav1");
    std::filesystem::remove_all(folder);
}

TEST_F(ClaimsOfNodes, AnotherListIsNamedOnBothSidesAndDoesNotVote)
{
    for (const char *const name : {"ground", "uav1", "uav2"})
    {
        Start(MemberConfig(name, {"ground", "uav1", "uav2"}));
    }
    Start(MemberConfig("uav4", {"ground", "uav4", "uav1"}));
    RunFor(FirstLease);
    ClaimsOf("uav4").BeLeader();
    RunFor(10s);
    EXPECT_THAT(HoldersOf("leader"), IsEmpty());
    EXPECT_THAT(fleet["uav4"].Problems(),
                HasSubstr("agreement uav1: its `members` or its `lease` are others"));
    EXPECT_THAT(fleet["uav1"].Problems(),
                HasSubstr("agreement uav4: its `members` or its `lease` are others"));
    ClaimsOf("uav2").BeLeader();
    EXPECT_EQ(UntilHeld("leader", 5s), "uav2") << "the others go on";
}

TEST_F(ClaimsOfNodes, AnotherLeaseIsNamedOnBothSidesAndDoesNotVote)
{
    Start(MemberConfig("uav1", {"uav1", "uav2"}));
    GatewayConfig other = MemberConfig("uav2", {"uav1", "uav2"});
    other.Agreement->Lease = 3s;
    Start(other);
    ClaimsOf("uav1").BeLeader();
    RunFor(10s);
    EXPECT_THAT(HoldersOf("leader"), IsEmpty());
    for (const auto &[name, peer] : {std::pair("uav1", "uav2"), std::pair("uav2", "uav1")})
    {
        EXPECT_THAT(fleet[name].Problems(), HasSubstr("agreement " + std::string(peer) + ": its `members`"));
    }
}

TEST_F(ClaimsOfNodes, AMemberWithoutAnAgreementIsNamed)
{
    Start(MemberConfig("uav1", {"uav1", "uav2", "uav3"}));
    Start(MemberConfig("uav2", {"uav1", "uav2", "uav3"}));
    GatewayConfig without;
    without.Node = "uav3";
    fleet.Add(without);
    RunFor(FirstLease);
    ClaimsOf("uav1").BeLeader();
    EXPECT_EQ(UntilHeld("leader", 1s), "uav1");
    RunFor(2s);
    EXPECT_THAT(fleet["uav1"].Problems(), HasSubstr("agreement uav3: it is one of the `members` here"));
    EXPECT_THAT(fleet["uav3"].Problems(), Not(HasSubstr("links"))) << "it got a frame that it does not know";
}

TEST_F(ClaimsOfNodes, AClockThatStoodStillEndsTheClaims)
{
    StartFive();
    RunFor(FirstLease);
    ClaimsOf("uav1").Claim("cell 17");
    ASSERT_EQ(UntilHeld("cell 17", 1s), "uav1");
    RunFor(3s);
    const std::optional<std::uint64_t> before = ClaimsOf("uav1").FenceOf("cell 17");
    ASSERT_TRUE(before);
    fleet.StandStill("uav1", 1200ms);
    RunFor(1s);
    EXPECT_NE(ClaimsOf("uav1").FenceOf("cell 17"), before);
    EXPECT_EQ(UntilHeld("cell 17", 15s), "uav1");
}

TEST_F(ClaimsOfNodes, NodesThatAreSilentDoNotHideThatAClockStoodStill)
{
    const Names others = {"radio1", "radio2", "radio3", "radio4"};
    for (const std::string &name : others)
    {
        Start(MemberConfig(name, others));
    }
    for (const char *const name : {"ground", "uav1", "uav2"})
    {
        Start(MemberConfig(name, {"ground", "uav1", "uav2"}));
    }
    RunFor(FirstLease);
    ClaimsOf("uav1").Claim("cell 17");
    ASSERT_EQ(UntilHeld("cell 17", 1s), "uav1");
    RunFor(3s);
    for (const std::string &name : others)
    {
        Kill(name);
    }
    RunFor(2s);
    ASSERT_EQ(fleet["uav1"].StateOf("radio1"), "STALE");
    const std::optional<std::uint64_t> before = ClaimsOf("uav1").FenceOf("cell 17");
    ASSERT_TRUE(before);
    fleet.StandStill("uav1", 1200ms);
    RunFor(1s);
    EXPECT_NE(ClaimsOf("uav1").FenceOf("cell 17"), before);
}

TEST_F(ClaimsOfNodes, ALeaseIsNotLostThoughAFifthOfAllDatagramsIs)
{
    StartFive();
    fleet.Network.SetFaults("*", "*", {.Loss = 0.2});
    RunFor(FirstLease);
    ClaimsOf("uav1").Claim("cell 17");
    ASSERT_EQ(UntilHeld("cell 17", 10s), "uav1");
    const std::optional<std::uint64_t> before = ClaimsOf("uav1").FenceOf("cell 17");
    RunFor(120s);
    EXPECT_EQ(ClaimsOf("uav1").FenceOf("cell 17"), before);
}

// A beat has 24 bytes more with an agreement, 8 more with a claim of its sender, and 28 more with an answer
// to one claimant.
TEST_F(ClaimsOfNodes, AHeldClaimCostsSomeBytesOfEachBeat)
{
    StartFive();
    RunFor(10s);
    const auto idle = [this](const std::string &node)
    {
        const std::uint64_t before = BytesOf(node);
        RunFor(60s);
        return BytesOf(node) - before;
    };
    const std::uint64_t ownBefore = idle("uav1");
    const std::uint64_t otherBefore = idle("uav2");
    ClaimsOf("uav1").Claim("cell 17");
    ASSERT_EQ(UntilHeld("cell 17", 1s), "uav1");
    RunFor(3s);
    // In a minute; and some announcements of DDS, which are not as many in each. Datagrams of renewals would
    // be 70 kB.
    constexpr std::uint64_t beats = 121;
    constexpr std::uint64_t others = 1500;
    EXPECT_LE(idle("uav1"), ownBefore + beats * 8 + others);
    EXPECT_LE(idle("uav2"), otherBefore + beats * 28 + others);
}

TEST_F(ClaimsOfNodes, TooManyClaimsAndBadNamesAreRefused)
{
    StartFive();
    EXPECT_FALSE(ClaimsOf("uav1").Claim(""));
    EXPECT_FALSE(ClaimsOf("uav1").Claim(std::string(Claims::LongestName + 1, 'x')));
    for (std::size_t i = 0; i < Claims::Most; ++i)
    {
        EXPECT_TRUE(ClaimsOf("uav1").Try("cell " + std::to_string(i)));
    }
    EXPECT_FALSE(ClaimsOf("uav1").Try("one more"));
    ClaimsOf("uav1").Release("cell 0");
    EXPECT_TRUE(ClaimsOf("uav1").Try("one more"));
}

TEST_F(ClaimsOfNodes, NothingIsHeldWithoutAGateway)
{
    GatewayConfig config = MemberConfig("uav1");
    Program program(config);
    EXPECT_TRUE(program.Own.Claim("leader")) << "it waits for the gateway";
    EXPECT_FALSE(program.Own.StillMine("leader"));
    EXPECT_TRUE(program.Own.StatusOf("leader").IsWanted);
    EXPECT_EQ(program.Own.StatusOf("leader").Reason, "no gateway runs with this configuration");
    EXPECT_THAT(program.Own.Mine(), IsEmpty());
    EXPECT_EQ(program.Table.Write("wind", "12 m/s"), "no gateway runs with this configuration");
    EXPECT_FALSE(program.Table.Text("wind"));
    GatewayConfig without;
    without.Node = "uav1";
    EXPECT_THROW(Claims{without}, ConfigError);
    EXPECT_THROW(SharedTable{without}, ConfigError);
}

TEST_F(ClaimsOfNodes, TwoGatewaysDoNotServeTheSameClaims)
{
    GatewayConfig config = MemberConfig("uav1");
    const Claims claims(config);
    fleet.Add(config);
    EXPECT_THROW(fleet.Add(config, 1.4e9, "twin"), ConfigError);
}

}  // namespace
}  // namespace Rabit
