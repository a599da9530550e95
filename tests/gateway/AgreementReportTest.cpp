// The report of a node on its claims.
#include "wire/AgreementReport.h"

#include <gtest/gtest.h>

#include <chrono>
#include <string>

#include "wire/NodeReports.h"

namespace Rabit
{
namespace
{

using namespace std::chrono_literals;

AgreementReport::Contents TwoClaims()
{
    return {
        .Members = {"ground", "uav1", "uav2"},
        .Lease = 2500ms,
        .Holdings = {{.Claim = "cell 17", .Fence = 18446744073709551615U}, {.Claim = "leader", .Fence = 1}}};
}

TEST(AgreementReport, HasTheMembersTheLeaseAndEachClaimWithItsFence)
{
    const std::string text = AgreementReport::TextOf(TwoClaims());
    EXPECT_EQ(text,
              "members\t2500\tground\tuav1\tuav2\n"
              "claim\t18446744073709551615\tcell 17\n"
              "claim\t1\tleader\n");
    EXPECT_EQ(AgreementReport::ContentsOf(text), TwoClaims());
}

TEST(AgreementReport, OfANodeWithoutAnAgreementIsEmpty)
{
    EXPECT_EQ(AgreementReport::TextOf({}), "");
    EXPECT_EQ(AgreementReport::ContentsOf(""), AgreementReport::Contents());
}

TEST(AgreementReport, TheNameOfAClaimCannotBeTakenForAnotherLine)
{
    AgreementReport::Contents contents = TwoClaims();
    contents.Holdings[0].Claim = "a\nclaim\t9\tleader\x1b[2J";
    const auto read = AgreementReport::ContentsOf(AgreementReport::TextOf(contents));
    ASSERT_TRUE(read.has_value());
    ASSERT_EQ(read->Holdings.size(), 2U);
    EXPECT_EQ(read->Holdings[0].Claim, "a?claim?9?leader?[2J");
}

TEST(AgreementReport, TheLargestOneFits)
{
    AgreementReport::Contents contents = TwoClaims();
    contents.Members.assign(MostAgreementMembers, std::string(64, 'm'));
    contents.Holdings.assign(
        Claims::Most, AgreementReport::Held{.Claim = std::string(Claims::LongestName, 'c'), .Fence = 1});
    const std::string text = AgreementReport::TextOf(contents);
    EXPECT_LE(text.size(), NodeReports::Largest);
    EXPECT_EQ(AgreementReport::ContentsOf(text), contents);
    EXPECT_FALSE(AgreementReport::ContentsOf(text + "claim\t1\tone more\n").has_value());
}

TEST(AgreementReport, IsRefusedIfItMakesNoSense)
{
    const std::string good = AgreementReport::TextOf(TwoClaims());
    for (const std::string &bad :
         {std::string("\n"), std::string("members\n"), std::string("members\t2000\n"),
          std::string("members\t0\tuav1\n"), std::string("members\tlong\tuav1\n"), good.substr(1),
          std::string("members\t2000\tuav1\t\n"), good + "claim\t1\t\n", good + "\n",
          good + "claim\t1\n", good + "claim\t-1\tleader\n", good + "claim\t1\tleader\tmore\n",
          good + good, "members\t2000" + std::string(100000, '\t') + "\n"})
    {
        EXPECT_FALSE(AgreementReport::ContentsOf(bad).has_value()) << bad.substr(0, 100);
    }
}

}  // namespace
}  // namespace Rabit
