#include "PathText.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>
#include <string>

namespace
{
using Ground::FleetRow;
using Ground::PathColumns;
using Ground::PathHeading;
using Ground::PathLines;
using Ground::PathLogText;
using Ground::RowState;
using testing::ElementsAre;
using testing::IsEmpty;

constexpr double NaN = std::numeric_limits<double>::quiet_NaN();
constexpr double Infinity = std::numeric_limits<double>::infinity();
constexpr double Huge = std::numeric_limits<double>::max();

FleetRow Row(const std::string &node, double roundTripS, double deliveryRate)
{
    FleetRow row;
    row.Node = node;
    row.State = RowState::Up;
    row.RoundTripS = roundTripS;
    row.DeliveryRate = deliveryRate;
    return row;
}

FleetRow Lost(FleetRow row)
{
    row.State = RowState::Lost;
    return row;
}

TEST(PathText, HasColumns)
{
    EXPECT_EQ(PathHeading(), "  RTT ms     kB/s");
    EXPECT_EQ(PathColumns(Row("uav1", 0.0124, 3210)), "      12     3.21");
}

TEST(PathText, PutsTheWayToWhoIsNotUpInParentheses)
{
    EXPECT_EQ(PathColumns(Lost(Row("uav1", 0.0124, 3210))), "     (12    3.21)");
    EXPECT_EQ(PathColumns(Lost(Row("uav1", 0.0124, 0))), "     (12       -)");
    EXPECT_THAT(PathLines({Lost(Row("uav1", 0.0124, 3210))}, 80),
                ElementsAre("Round trips: uav1 (12 ms 3.2 kB/s)"));
    EXPECT_EQ(PathLogText(Lost(Row("uav1", 0.0124, 3210))), "OLD round trip 12 ms, delivers 3.2 kB/s");
}

TEST(PathText, TellsNothingOfWhatIsNotKnown)
{
    EXPECT_EQ(PathColumns(Row("uav1", NaN, 0)), "       -        -");
    EXPECT_EQ(PathColumns(Lost(Row("uav1", NaN, 0))), "       -        -");
    EXPECT_THAT(PathLines({Row("uav1", NaN, 0)}, 80), IsEmpty());
    EXPECT_EQ(PathLogText(Row("uav1", NaN, 0)), "");
    EXPECT_EQ(PathLogText(Row("uav1", NaN, 850)), "delivers 850 B/s");
}

TEST(PathText, ListsTheAircraftInAsManyLinesAsItTakes)
{
    EXPECT_THAT(PathLines({Row("uav1", 0.0124, 3210), Row("uav2", 0.34, 0), Row("uav3", NaN, 0),
                           Row("uav4", 0.0009, 0)},
                          40),
                ElementsAre("Round trips: uav1 12 ms 3.2 kB/s,", "    uav2 340 ms, uav4 0.9 ms"));
}

TEST(PathText, KeepsItsColumnsWhateverTheNumbersAre)
{
    for (const double value : {NaN, Infinity, -Infinity, Huge, -1.0, 0.0})
    {
        EXPECT_EQ(PathColumns(Row("uav1", value, value)).size(), Ground::PathColumnsWidth) << value;
        EXPECT_EQ(PathColumns(Lost(Row("uav1", value, value))).size(), Ground::PathColumnsWidth) << value;
    }
}

TEST(PathText, NeverPrintsControlCharactersFromTheNetwork)
{
    EXPECT_THAT(PathLines({Row("\x1b[2J\n", 0.01, 0)}, 80), ElementsAre("Round trips: ?[2J? 10 ms"));
}

}  // namespace
