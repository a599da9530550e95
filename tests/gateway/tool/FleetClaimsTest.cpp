// The claims of a fleet, from what its nodes tell.
#include "FleetClaims.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <optional>
#include <string>
#include <vector>

namespace Rabit::Tool
{
namespace
{

using ::testing::ElementsAre;
using ::testing::IsEmpty;

const std::string ThreeMembers = "members\t2000\tground\tuav1\tuav2\n";

std::vector<std::string> RowsOf(const FleetClaims &claims)
{
    std::vector<std::string> rows;
    for (const FleetClaims::Holding &holding : claims.Holdings)
    {
        rows.push_back(holding.Claim + " " + holding.Node + " " + std::to_string(holding.Fence));
    }
    return rows;
}

std::vector<std::string> ProblemsOf(const FleetClaims &claims)
{
    std::vector<std::string> problems;
    for (const Gateway::Problem &problem : claims.Problems)
    {
        problems.push_back(problem.subject + ": " + problem.reason);
    }
    return problems;
}

TEST(FleetClaims, AreOrderedByNameAndTheNewestHolderIsFirst)
{
    const FleetClaims claims = FleetClaimsOf({{"ground", ThreeMembers + "claim\t4\tcell 10\n"},
                                              {"uav1", ThreeMembers + "claim\t3\tcell 10\n"},
                                              {"uav2", ThreeMembers + "claim\t9\tcell 2\n"},
                                              {"camera", ""}});
    EXPECT_THAT(RowsOf(claims), ElementsAre("cell 2 uav2 9", "cell 10 ground 4", "cell 10 uav1 3"));
    ASSERT_EQ(claims.Lists.size(), 1U);
    EXPECT_THAT(claims.Lists[0].Nodes, ElementsAre("ground", "uav1", "uav2"));
    EXPECT_THAT(ProblemsOf(claims), IsEmpty());
}

TEST(FleetClaims, EachMemberThatDoesNotTakePartIsAProblem)
{
    const FleetClaims claims = FleetClaimsOf({{"ground", ThreeMembers}, {"uav1", std::nullopt}});
    EXPECT_THAT(claims.Silent, ElementsAre("uav1"));
    EXPECT_THAT(ProblemsOf(claims),
                ElementsAre("node uav1: it is a member of the agreement and has not told its claims",
                            "node uav2: it is a member of the agreement and is not heard",
                            "agreement of ground: 1 of 3 members told that they have this list, and a "
                            "majority is 2"));
    EXPECT_THAT(ProblemsOf(FleetClaimsOf({{"ground", ThreeMembers}, {"uav1", ""}, {"uav2", ThreeMembers}})),
                ElementsAre("node uav1: it is a member of the agreement and has no `agreement` itself"));
}

TEST(FleetClaims, ListsThatDifferAreNamedWithTheirNodes)
{
    const FleetClaims claims = FleetClaimsOf({{"ground", "members\t2000\tground\n"},
                                              {"uav1", "members\t2500\tuav1\tuav2\n"},
                                              {"uav2", "members\t2500\tuav1\tuav2\n"}});
    EXPECT_THAT(
        ProblemsOf(claims),
        ElementsAre("agreement of uav1 uav2: its members are uav1 uav2, and its lease is 2.5 s; other "
                    "nodes have another list, and claims of the two do not exclude each other",
                    "agreement of ground: its members are ground, and its lease is 2.0 s; other "
                    "nodes have another list, and claims of the two do not exclude each other"));
}

TEST(FleetClaims, AnAnswerThatMakesNoSenseIsAProblemOfItsNode)
{
    EXPECT_THAT(ProblemsOf(FleetClaimsOf({{"uav1", "claim\t1\tleader\n"}})),
                ElementsAre("node uav1: its report on its claims makes no sense"));
}

}  // namespace
}  // namespace Rabit::Tool
