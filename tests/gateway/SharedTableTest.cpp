// Nodes that share a table, with cuts and restarts, under simulated time.
#include <gmock/gmock.h>

#include <cstddef>

#include "AgreementFleet.h"

namespace Rabit
{
namespace
{

using namespace std::chrono_literals;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::Not;
using ::testing::SizeIs;

class TablesOfNodes : public AgreementFleet
{
};

TEST_F(TablesOfNodes, TablesMergeWhateverWasWrittenOnEitherSideOfACut)
{
    StartFive();
    RunFor(3s);
    EXPECT_EQ(TableOf("uav1").Add("flown", 1), "");
    RunFor(2s);
    Divide({"ground", "uav1"}, {"uav2", "uav3", "uav4"});
    RunFor(5s);
    EXPECT_EQ(TableOf("uav1").Add("flown", 2), "");
    EXPECT_EQ(TableOf("uav3").Add("flown", 500), "");
    EXPECT_EQ(TableOf("ground").Raise("sorties", 4), "");
    EXPECT_EQ(TableOf("uav2").Raise("sorties", 3), "");
    EXPECT_EQ(TableOf("ground").Write("wind", "12 m/s"), "");
    EXPECT_EQ(TableOf("uav4").Write("wind", "9 m/s"), "");
    RunFor(3s);
    EXPECT_THAT(TableOf("ground").Numbers("flown"), ElementsAre(1u, 2u));
    EXPECT_THAT(TableOf("uav4").Numbers("flown"), ElementsAre(1u, 500u));
    int changes = 0;
    const RabitScopedConnection connection = TableOf("ground").ConnectChanged([&changes] { ++changes; });
    fleet.Network.ClearFaults();
    RunFor(2500ms);  // three beats, and their answers
    for (const std::string &name : FiveMembers)
    {
        EXPECT_THAT(TableOf(name).Numbers("flown"), ElementsAre(1u, 2u, 500u)) << name;
        EXPECT_EQ(TableOf(name).Number("sorties"), 4) << name;
        EXPECT_EQ(TableOf(name).Text("wind"), TableOf("ground").Text("wind")) << name;
        EXPECT_THAT(TableOf(name).Keys(), ElementsAre("flown", "sorties", "wind")) << name;
    }
    EXPECT_GE(changes, 1);
    EXPECT_FALSE(TableOf("uav1").Text("flown")) << "it is a set";

    Kill("uav1");
    Start(MemberConfig("uav1"));
    RunFor(5s);
    EXPECT_THAT(TableOf("uav1").Numbers("flown"), ElementsAre(1u, 2u, 500u)) << "from the others";
}

TEST_F(TablesOfNodes, ATableThatIsFullRefusesAndSaysSo)
{
    StartFive();
    RunFor(3s);
    for (std::size_t i = 0; i < SharedTable::MostKeys; ++i)
    {
        EXPECT_EQ(TableOf("uav1").Write("key " + std::to_string(i), "value"), "");
    }
    EXPECT_THAT(std::string(TableOf("uav1").Write("one more", "value")), HasSubstr("256 other keys"));
    RunFor(3s);
    EXPECT_THAT(fleet["uav1"].Problems(), HasSubstr("table: it has 256 keys, and further ones are refused"));
    EXPECT_THAT(TableOf("ground").Keys(), SizeIs(SharedTable::MostKeys));
    RunFor(15s);
    EXPECT_THAT(fleet["uav1"].Problems(), Not(HasSubstr("table")));
}

TEST_F(TablesOfNodes, AKeyThatIsUsedInTwoWaysIsAProblem)
{
    StartFive();
    RunFor(3s);
    Divide({"ground", "uav1"}, {"uav2", "uav3", "uav4"});
    RunFor(1s);
    EXPECT_EQ(TableOf("uav1").Write("wind", "12 m/s"), "");
    EXPECT_EQ(TableOf("uav2").Raise("wind", 9), "");
    fleet.Network.ClearFaults();
    RunFor(3s);
    EXPECT_EQ(TableOf("uav1").Number("wind"), 9);
    EXPECT_EQ(TableOf("uav1").Write("wind", "12 m/s"), "the key has a value of another merge");
    EXPECT_THAT(fleet["uav1"].Problems() + fleet["ground"].Problems(),
                HasSubstr("table wind: nodes use this key in two ways"));
}

}  // namespace
}  // namespace Rabit
