#include "FleetTable.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

namespace
{
using Ground::Emphasis;
using Ground::FleetLogLines;
using Ground::FleetRow;
using Ground::FleetTableLines;
using Ground::RowState;

FleetRow Fresh()
{
    FleetRow row;
    row.Node = "uav1";
    row.State = RowState::Up;
    row.AgeS = 0.052;
    row.LatitudeDeg = 49.2574181;
    row.LongitudeDeg = -123.2432101;
    row.AltitudeM = 91.23;
    row.SpeedMps = 3.44;
    row.Mission = "GOTO 3";
    row.Sent = 3;
    row.Acknowledged = 2;
    return row;
}

FleetRow WithState(RowState state, double age)
{
    FleetRow row = Fresh();
    row.State = state;
    row.AgeS = age;
    return row;
}

TEST(FleetTable, ShowsAFreshRow)
{
    const auto lines = FleetTableLines({Fresh()}, 12.4);
    ASSERT_EQ(lines.size(), 3u);
    EXPECT_EQ(lines[0].Text, "Fleet after 12 s: 1 UP, 0 STALE, 0 LOST, 0 WAITING");
    EXPECT_EQ(lines[1].Text,
              "NODE     STATE   AGE s   LATITUDE  LONGITUDE  ALT m   m/s MISSION     SENT ACKED");
    EXPECT_EQ(lines[2].Text,
              "uav1     UP       0.05   49.25742 -123.24321   91.2   3.4 GOTO 3         3     2");
    EXPECT_EQ(lines[2].Shown, Emphasis::None);
}

TEST(FleetTable, ShowsNoNumbersOfABadPositionAndPutsTheAircraftFirst)
{
    FleetRow bad = Fresh();
    bad.Node = "uav2";
    bad.LatitudeDeg = 95;
    bad.AltitudeM = 1e300;
    bad.BadPosition = "latitude must be from -90 to 90, not 95";
    const auto lines = FleetTableLines({Fresh(), bad}, 0);
    EXPECT_EQ(lines[2].Text,
              "uav2     UP       0.05          bad position      -     - GOTO 3         3     2");
    EXPECT_EQ(lines[2].Shown, Emphasis::Warning);
}

TEST(FleetTable, MarksALostRowAndPutsItsOldValuesInParentheses)
{
    const auto lines = FleetTableLines({WithState(RowState::Lost, 6.31)}, 0);
    EXPECT_EQ(lines[2].Text,
              "uav1     LOST   ! 6.31 ( 49.25742 -123.24321   91.2   3.4 GOTO 3)        3     2");
    EXPECT_EQ(lines[2].Shown, Emphasis::Alarm);
}

TEST(FleetTable, PutsFirstWhatNeedsAttention)
{
    std::vector<FleetRow> rows;
    for (const RowState state :
         {RowState::Up, RowState::Stale, RowState::Lost, RowState::Waiting, RowState::Lost})
    {
        rows.push_back(WithState(state, 0.1));
        rows.back().Node = "uav" + std::to_string(rows.size());
    }
    const auto lines = FleetTableLines(rows, 0);
    std::vector<std::string> nodes;
    for (std::size_t i = 2; i < 7; ++i)
        nodes.push_back(lines[i].Text.substr(0, 4));
    EXPECT_THAT(nodes, testing::ElementsAre("uav3", "uav5", "uav2", "uav4", "uav1"));
}

TEST(FleetTable, MarksALowBatteryAndPutsItBeforeWhatIsWell)
{
    std::vector<FleetRow> rows{Fresh(), Fresh(), Fresh(), WithState(RowState::Stale, 0.1)};
    for (std::size_t i = 0; i < rows.size(); ++i)
        rows[i].Node = "uav" + std::to_string(i + 1);
    rows[0].BatteryPercent = 25;
    rows[1].BatteryPercent = 24;
    rows[2].BatteryPercent = 9;
    const auto lines = FleetTableLines(rows, 0);
    std::vector<std::string> nodes;
    std::vector<Emphasis> shown;
    for (std::size_t i = 2; i < 6; ++i)
    {
        nodes.push_back(lines[i].Text.substr(0, 4));
        shown.push_back(lines[i].Shown);
    }
    EXPECT_THAT(nodes, testing::ElementsAre("uav4", "uav3", "uav2", "uav1"));
    EXPECT_THAT(shown,
                testing::ElementsAre(Emphasis::Warning, Emphasis::Alarm, Emphasis::Warning, Emphasis::None));
}

TEST(FleetTable, SaysWhatIsMissing)
{
    EXPECT_EQ(Ground::WhatIsMissing(WithState(RowState::Up, 0.08)), "");
    EXPECT_EQ(Ground::WhatIsMissing(WithState(RowState::Stale, 0.08)), "only its positions come");
    EXPECT_EQ(Ground::WhatIsMissing(WithState(RowState::Lost, 0.08)), "only its positions come");
    EXPECT_EQ(Ground::WhatIsMissing(WithState(RowState::Up, 4)), "no position comes");
    EXPECT_EQ(Ground::WhatIsMissing(WithState(RowState::Lost, 4)), "") << "nothing arrives";
    FleetRow silent = Fresh();
    silent.AgeS.reset();
    EXPECT_EQ(Ground::WhatIsMissing(silent), "");
}

TEST(FleetTable, MarksAStaleRow)
{
    const auto lines = FleetTableLines({WithState(RowState::Stale, 1.9)}, 0);
    EXPECT_THAT(lines[2].Text, testing::HasSubstr("STALE  ! 1.90 ("));
    EXPECT_EQ(lines[2].Shown, Emphasis::Warning);
}

TEST(FleetTable, MarksAnOldPoseOfANodeThatIsUp)
{
    const auto lines = FleetTableLines({WithState(RowState::Up, 1.5)}, 0);
    EXPECT_THAT(lines[2].Text, testing::HasSubstr("UP     ! 1.50 ("));
    EXPECT_EQ(lines[2].Shown, Emphasis::Warning);
}

TEST(FleetTable, NeverTakesAnUnknownAgeForFresh)
{
    EXPECT_FALSE(WithState(RowState::Up, std::nan("")).IsFresh());
}

TEST(FleetTable, ShowsNoPositionBeforeTheFirstPose)
{
    FleetRow row = Fresh();
    row.State = RowState::Waiting;
    row.AgeS.reset();
    row.Mission.clear();
    const auto lines = FleetTableLines({row}, 0);
    EXPECT_EQ(lines[2].Text,
              "uav1     WAITING     -          -          -      -     - -              3     2");
    EXPECT_EQ(lines[2].Shown, Emphasis::Warning);
}

TEST(FleetTable, CountsTheStates)
{
    const auto lines = FleetTableLines({WithState(RowState::Up, 0), WithState(RowState::Up, 0),
                                        WithState(RowState::Stale, 0), WithState(RowState::Lost, 0)},
                                       0);
    EXPECT_THAT(lines[0].Text, testing::HasSubstr("2 UP, 1 STALE, 1 LOST, 0 WAITING"));
}

TEST(FleetTable, FitsATerminalOf80Columns)
{
    FleetRow row = WithState(RowState::Stale, 86400);
    row.Mission = "GOTO 12345";
    row.AltitudeM = -12.3;
    for (const auto &line : FleetTableLines({row}, 86400))
        EXPECT_LE(line.Text.size(), 80u) << line.Text;
}

TEST(FleetTable, ShowsTheWayToEachAircraftInColumnsOfAWideTerminal)
{
    FleetRow known = Fresh();
    known.RoundTripS = 0.0124;
    known.DeliveryRate = 3210;
    const auto lines = FleetTableLines({known, Fresh()}, 0, 97);
    ASSERT_EQ(lines.size(), 4u);
    EXPECT_THAT(lines[1].Text, testing::EndsWith("ACKED  RTT ms     kB/s"));
    EXPECT_THAT(lines[2].Text, testing::EndsWith("    2      12     3.21"));
    EXPECT_THAT(lines[3].Text, testing::EndsWith("    2       -        -"));
    EXPECT_LE(lines[1].Text.size(), 97u);
}

TEST(FleetTable, ShowsTheWayToEachAircraftBelowANarrowTable)
{
    FleetRow known = Fresh();
    known.RoundTripS = 0.0124;
    known.DeliveryRate = 3210;
    const auto lines = FleetTableLines({known, Fresh()}, 0, 96);
    ASSERT_EQ(lines.size(), 5u);
    EXPECT_THAT(lines[1].Text, testing::EndsWith("ACKED"));
    EXPECT_EQ(lines[4].Text, "Round trips: uav1 12 ms 3.2 kB/s");
}

TEST(FleetTable, KeepsItsColumnsWithLongNamesAndAges)
{
    FleetRow row = WithState(RowState::Lost, 86400);
    row.Node = "a.very.long.name.of.a.node";
    row.Mission = "a mission with a long name";
    const auto lines = FleetTableLines({Fresh(), row}, 0);
    EXPECT_EQ(lines[2].Text.size(), lines[3].Text.size());
}

TEST(FleetTable, NeverPrintsControlCharactersFromTheNetwork)
{
    FleetRow row = Fresh();
    row.Mission = "\x1b[2J\n\xff";
    EXPECT_THAT(FleetTableLines({row}, 0)[2].Text, testing::HasSubstr("?[2J??"));
    EXPECT_THAT(FleetLogLines({row}, 0)[0], testing::HasSubstr("?[2J??"));
}

TEST(FleetLog, ShowsOneLineForEachRow)
{
    const auto lines = FleetLogLines({Fresh(), WithState(RowState::Lost, 6.31)}, 12.4);
    EXPECT_THAT(lines,
                testing::ElementsAre(
                    "   12.4 s  uav1   UP      pose (age 0.05 s) 49.2574181 -123.2432101 91.2 m 3.4 m/s, "
                    "mission GOTO 3, commands 3 sent 2 acknowledged",
                    "   12.4 s  uav1   LOST    OLD pose (age 6.31 s) 49.2574181 -123.2432101 91.2 m 3.4 m/s, "
                    "mission GOTO 3, commands 3 sent 2 acknowledged"));
}

TEST(FleetLog, TellsNodesApartThatBeginAlike)
{
    FleetRow row = Fresh();
    row.Node = "replay.uav12";
    EXPECT_THAT(FleetLogLines({row}, 0)[0], testing::HasSubstr("replay.uav12 UP"));
}

TEST(FleetLog, TellsOfTheWayThere)
{
    FleetRow row = Fresh();
    row.RoundTripS = 0.0124;
    row.DeliveryRate = 3210;
    EXPECT_THAT(FleetLogLines({row}, 0)[0],
                testing::HasSubstr("mission GOTO 3, round trip 12 ms, delivers 3.2 kB/s, commands 3 sent"));
}

TEST(FleetLog, SaysThatThereIsNoPoseYet)
{
    FleetRow row;
    row.Node = "uav2";
    EXPECT_THAT(FleetLogLines({row}, 0),
                testing::ElementsAre("    0.0 s  uav2   WAITING no pose yet, mission "
                                     "unknown, commands 0 sent 0 acknowledged"));
}

}  // namespace
