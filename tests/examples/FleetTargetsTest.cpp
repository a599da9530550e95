#include "FleetTargets.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace
{
using Ground::ListedTarget;
using Ground::ListTargets;

Uav::TargetName Name(const std::string &aircraft, std::uint32_t number, double since)
{
    Uav::TargetName name;
    name.aircraft = aircraft;
    name.number = number;
    name.since_gps_time_s = since;
    return name;
}

const Uav::TargetName Old = Name("uav2", 1, 10);
const Uav::TargetName Young = Name("uav1", 3, 20);

Uav::Target TargetOf(const Uav::TargetName &name, double seenS = 100)
{
    Uav::Target target;
    target.name = name;
    target.seen_gps_time_s = seenS;
    return target;
}

Uav::Finding FindingOf(const Uav::TargetName &name, Uav::TargetStage stage)
{
    Uav::Finding finding;
    finding.name = name;
    finding.stage = stage;
    return finding;
}

class FleetTargets : public testing::Test
{
protected:
    Uav::Targets _of1;
    Uav::Targets _of2;
    std::vector<Uav::Finding> _findings1;
    std::vector<Uav::Finding> _findings2;

    std::vector<ListedTarget> List(double age1 = 0, double age2 = 0) const
    {
        return ListTargets({{"uav1", &_of1, age1, &_findings1}, {"uav2", &_of2, age2, &_findings2}});
    }
};

TEST_F(FleetTargets, AreListedOnceAsWhoeverSawThemLastKnowsThem)
{
    _of1.items = {TargetOf(Old, 100)};
    _of2.items = {TargetOf(Old, 105)};
    const auto list = List();
    ASSERT_EQ(list.size(), 1u);
    EXPECT_EQ(list[0].ToldBy, "uav2");
    EXPECT_FALSE(list[0].Found);
}

TEST_F(FleetTargets, AreFoundUnderTheFormerNameThatAnAircraftThatIsGoneGoesOnUsing)
{
    _of1.items = {TargetOf(Young)};
    _findings1 = {FindingOf(Young, Uav::TargetStage::TARGET_TRACKED)};
    _of2.items = {TargetOf(Old)};
    _of2.items[0].formerly = {Young};
    _findings2 = {FindingOf(Old, Uav::TargetStage::TARGET_FOUND)};
    const auto list = List(60, 0);
    ASSERT_EQ(list.size(), 1u);
    EXPECT_EQ(list[0].Name, Old);
    EXPECT_THAT(list[0].Formerly, testing::ElementsAre(Young));
    ASSERT_TRUE(list[0].Found);
    EXPECT_EQ(list[0].Found->Aircraft, "uav1") << "it got farther";
    EXPECT_EQ(list[0].Found->Finding.name, Old);
}

TEST_F(FleetTargets, AreTwoIfAnAircraftHasSeenThemSideBySide)
{
    _of1.items = {TargetOf(Young)};
    _of1.items[0].beside = {Old};
    _of2.items = {TargetOf(Old)};
    _of2.items[0].formerly = {Young};
    EXPECT_EQ(List().size(), 2u);
}

TEST_F(FleetTargets, AreTwoIfAnAircraftKnowsTheFormerNameForAnotherOneLater)
{
    _of1.items = {TargetOf(Young)};
    _of2.items = {TargetOf(Old)};
    _of2.items[0].formerly = {Young};
    EXPECT_EQ(List(0, 60).size(), 2u);
}

TEST_F(FleetTargets, AreKnownByTheirFindingsAlone)
{
    _findings2 = {FindingOf(Old, Uav::TargetStage::TARGET_REJECTED)};
    const auto list = ListTargets({{"uav2", nullptr, 0, &_findings2}});
    ASSERT_EQ(list.size(), 1u);
    EXPECT_FALSE(list[0].Target);
    EXPECT_TRUE(list[0].Found);
}

}  // namespace
